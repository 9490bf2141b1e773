// Puts text that the kernel sends into the clipboard, and saves files that it sends.

import { copied } from "../pad/clipboard.js";
import { make } from "../pad/dom.js";

const saved = new Set(); // the numbers of files that another view of the same widget may hold

function download(name, data) {
  const href = URL.createObjectURL(new Blob([data]));
  make("a", { href, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(href), 60_000);
}

function render({ model }) {
  model.on("msg:custom", async ({ number, text, name }, [data]) => {
    if (!name) model.send({ number, copied: await copied(text) });
    else if (!saved.has(number)) download(name, data);
    saved.add(number);
  });
}

export default { render };
