// The form of the page "Check a proof here". A worker does the work, so the page stays usable.

/**
 * @typedef {{ checker: string, worker: string, examples: Record<string, [string, string]> }} Parts
 * @typedef {{ stage: string }} Stage
 * @typedef {{ failure: string }} Failure
 * @typedef {{ code: 0 | 1 | 2, text: string }} Verdict
 */

const form = /** @type {HTMLElement} */ (document.querySelector(".check-here"));
const data = /** @type {HTMLElement} */ (document.getElementById("check-here-parts"));
const verdict = /** @type {HTMLElement} */ (form.querySelector(".verdict"));
const output = /** @type {HTMLElement} */ (form.querySelector("pre"));
const input = /** @type {HTMLInputElement} */ (form.querySelector("input"));
const buttons = /** @type {HTMLButtonElement[]} */ ([...form.querySelectorAll("button")]);
/** @type {Parts} */
const parts = JSON.parse(data.textContent ?? "");

const WORDS = [
  "Verified. All claims of the proof about this map are true.",
  "Not verified. A claim is false, or could not be proved.",
  "These files cannot be checked.",
];
const WAITING = "Choose two files, a map and its proof, or drop them here.";

/** @type {Worker | undefined} */
let worker;

/** @param {boolean} busy */
function setBusy(busy) {
  for (const one of [...buttons, input]) one.disabled = busy;
  form.setAttribute("aria-busy", `${busy}`);
}

/**
 * @param {string} words
 * @param {string} state of the form, for its colour
 * @param {string} text what the checker printed
 */
function say(words, state, text = "") {
  verdict.textContent = words;
  form.dataset.state = state;
  output.textContent = text;
  output.hidden = !text;
}

/** @param {string} reason */
function failed(reason) {
  worker?.terminate();
  worker = undefined;
  setBusy(false);
  say("The checker could not be loaded. It needs a network.", "code-2", reason);
}

/** @param {MessageEvent<Stage | Failure | Verdict>} event */
function heard({ data: message }) {
  if ("stage" in message) return say(message.stage, "busy");
  if ("failure" in message) return failed(message.failure);
  setBusy(false);
  say(WORDS[message.code], `code-${message.code}`, message.text);
}

/**
 * @param {string} map
 * @param {string} proof
 */
function check(map, proof) {
  setBusy(true);
  if (!worker) {
    // A blob's address would not start as a module where the page is opened as a file.
    const code = `data:text/javascript,${encodeURIComponent(parts.worker)}`;
    worker = new Worker(code, { type: "module" });
    worker.addEventListener("error", (event) => failed(event.message));
    worker.addEventListener("message", heard);
  }
  worker.postMessage({ checker: parts.checker, map, proof });
}

/** @param {string} text of a file */
function isProof(text) {
  try {
    return `${JSON.parse(text).format}`.endsWith("proof");
  } catch {
    return false; // the checker says what is wrong with it
  }
}

/** @param {FileList | undefined | null} files */
async function take(files) {
  if (files?.length !== 2) return say(`There must be two files. ${WAITING}`, "code-2");
  const texts = await Promise.all([...files].map((file) => file.text()));
  const [map, proof] = isProof(texts[0]) ? texts.reverse() : texts;
  check(map, proof);
}

for (const button of buttons) {
  button.addEventListener("click", () => check(...parts.examples[`${button.dataset.example}`]));
}
input.addEventListener("change", () =>
  take(input.files).then(() => Object.assign(input, { value: "" })),
);
form.addEventListener("dragover", (event) => event.preventDefault());
form.addEventListener("drop", (event) => {
  event.preventDefault();
  if (!input.disabled) take(event.dataTransfer?.files);
});
setBusy(false);
say(WAITING, "");
