// Puts text that the kernel sends into the clipboard, in pages served securely and in others.

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

function render({ model }) {
  const onText = async ({ number, text }) => model.send({ number, copied: await copied(text) });
  model.on("msg:custom", onText);
  return () => model.off("msg:custom", onText);
}

export default { render };
