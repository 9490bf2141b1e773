// A field over a keyframe, to type its name.

import { make } from "../pad/dom.js";

/**
 * @param {HTMLElement} track
 * @param {string} left its place, as CSS takes it
 * @param {string} name the present one
 * @param {(name: string) => void} rename called with another name
 * @param {() => void} ended
 */
export function nameField(track, left, name, rename, ended) {
  let open = true;
  const end = (/** @type {boolean} */ keep) => {
    if (!open) return; // removing a field takes its focus
    open = false;
    const typed = field.value.trim();
    field.remove();
    ended();
    if (keep && typed && typed !== name) rename(typed);
  };
  const field = make("input", {
    className: "glid-name-field",
    type: "text",
    value: name,
    "aria-label": "Name of the pose",
    style: `left: clamp(52px, ${left}, 100% - 52px)`,
    onpointerdown: (/** @type {Event} */ e) => e.stopPropagation(), // the track would scrub
    onblur: () => end(true),
    onkeydown: (/** @type {KeyboardEvent} */ e) => {
      e.stopPropagation();
      if (e.key === "Enter" || e.key === "Escape") end(e.key === "Enter");
    },
  });
  track.append(field);
  field.focus();
  field.select();
}
