// Puts text that the kernel sends into the clipboard, in pages served securely and in others, and
// saves files that it sends.

import { make } from "../pad/dom.js";

const saved = new Set(); // the numbers of files that another view of the same widget may hold

async function copied(text) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    return copiedBySelection(text); // plain http has no clipboard, or there is no permission
  }
}

function copiedBySelection(text) {
  const focused = document.activeElement;
  const area = document.createElement("textarea");
  area.value = text;
  area.setAttribute("readonly", "");
  Object.assign(area.style, { position: "fixed", top: "0", left: "0", opacity: "0" });
  document.body.append(area);
  area.select();
  try {
    return document.execCommand("copy");
  } catch {
    return false;
  } finally {
    area.remove();
    focused?.focus({ preventScroll: true });
  }
}

function save(name, data) {
  const href = URL.createObjectURL(new Blob([data]));
  make("a", { href, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(href), 60_000);
}

function render({ model }) {
  const onMessage = async ({ number, text, name }, [data]) => {
    if (!name) model.send({ number, copied: await copied(text) });
    else if (!saved.has(number)) save(name, data);
    saved.add(number);
  };
  model.on("msg:custom", onMessage);
  return () => model.off("msg:custom", onMessage);
}

export default { render };
