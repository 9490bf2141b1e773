// An element with properties, attributes and listeners ("onclick"), and its children.
export function make(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  if (tag === "button") element.type = "button"; // it submits nothing
  for (const [name, value] of Object.entries(properties)) {
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (name in element && name !== "list") element[name] = value;
    else element.setAttribute(name, value);
  }
  element.append(...children);
  return element;
}

// Changes a model here and in the kernel.
export function save(model, changes) {
  for (const [name, value] of Object.entries(changes)) model.set(name, value);
  model.save_changes();
}

// The numbers in a binary trait; none before its first value came.
export function toFloats(view) {
  if (!view) return new Float32Array();
  return new Float32Array(view.buffer.slice(view.byteOffset, view.byteOffset + view.byteLength));
}

// Calls listeners now, and whenever the model tells one of their events ("change:a change:b");
// anywidget takes them off when the view is removed.
export function follow(model, listeners) {
  for (const [names, listener] of Object.entries(listeners)) {
    model.on(names, listener);
    listener();
  }
}
