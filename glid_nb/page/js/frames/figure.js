// The sliders of a figure. Each position has its own picture.

import { frameAt, svgOf, wordsOf } from "./frames.js";

/** @import { Control, Frames } from "./data.js" */

/**
 * A slider, or a check box, with its name before it and its value after it.
 *
 * @param {Control} control
 * @param {(position: number) => void} moved
 */
function controlled({ name, values, start, check }, moved) {
  const row = document.createElement("label");
  const input = document.createElement("input");
  const value = document.createElement("output");
  const show = (/** @type {number} */ position) => {
    value.textContent = values[position];
    if (!check) input.setAttribute("aria-valuetext", values[position]);
  };
  if (check) {
    Object.assign(input, { type: "checkbox", checked: start === 1 });
  } else {
    Object.assign(input, { type: "range", min: "0", max: `${values.length - 1}` });
    input.value = `${start}`;
  }
  input.setAttribute("aria-label", name);
  input.addEventListener("input", () => {
    const position = check ? Number(input.checked) : input.valueAsNumber;
    show(position);
    moved(position);
  });
  show(start);
  row.append(name, input);
  if (!check) row.append(value);
  return row;
}

/**
 * Puts the sliders above the picture.
 *
 * @param {HTMLElement} figure
 * @param {Frames} data
 */
export function addControls(figure, data) {
  const picture = /** @type {HTMLImageElement} */ (figure.querySelector("img"));
  const positions = data.controls.map(({ start }) => start);
  const show = () => {
    const svg = svgOf(data, frameAt(data.controls, positions));
    picture.src = `data:image/svg+xml,${encodeURIComponent(svg)}`;
    picture.alt = wordsOf(data, positions);
  };
  const rows = data.controls.map((control, i) =>
    controlled(control, (position) => {
      positions[i] = position;
      show();
    }),
  );
  show();
  figure.prepend(...rows);
}
