// The worker of the form: Python in WebAssembly with python-flint, which runs glid_check.py.

// The versions are fixed: other ones were not tested, and a wheel fits one version of Pyodide.
const RUNTIME = "https://cdn.jsdelivr.net/npm/pyodide@314.0.7/";
const FLINT =
  "https://files.pythonhosted.org/packages/2f/6b/660e6982354b07080fc23459b0e30e02b84076dc7876c48de07e30e1da4b/python_flint-0.9.0-cp314-cp314-pyemscripten_2026_0_wasm32.whl";
const INTEGRITY = "sha256-sx9cAODjYECrWNALMCUVbiCGm5kNd25L+Q+HCx7hGtM=";

/** @type {Promise<any> | undefined} */
let python;

/** @param {string} checker the text of glid_check.py */
async function started(checker) {
  postMessage({ stage: "Loading Python (about 6 MB) …" });
  const { loadPyodide } = await import(`${RUNTIME}pyodide.mjs`);
  const found = await loadPyodide({ indexURL: RUNTIME });
  postMessage({ stage: "Loading python-flint (7 MB) …" });
  // The browser refuses a file with another hash.
  const wheel = await fetch(FLINT, { integrity: INTEGRITY });
  found.unpackArchive(await wheel.arrayBuffer(), "wheel");
  found.FS.writeFile("glid_check.py", checker);
  return found;
}

/** @param {MessageEvent<{ checker: string, map: string, proof: string }>} event */
addEventListener("message", async ({ data: { checker, map, proof } }) => {
  try {
    python ??= started(checker);
    const found = await python;
    postMessage({ stage: "Checking …" });
    /** @type {string[]} */
    const lines = [];
    found.setStdout({ batched: (/** @type {string} */ line) => lines.push(line) });
    found.setStderr({ batched: (/** @type {string} */ line) => lines.push(line) });
    found.FS.writeFile("map.json", map);
    found.FS.writeFile("proof.json", proof);
    const code = found.runPython('import glid_check\nglid_check.main(["map.json", "proof.json"])');
    postMessage({ code, text: lines.join("\n") });
  } catch (error) {
    python = undefined;
    postMessage({ failure: String(error) });
  }
});
