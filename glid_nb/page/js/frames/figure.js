// The sliders of a figure, and the point that is dragged. Each position has its own picture.

import { dragged, frameAt, svgOf, wordsOf } from "./frames.js";
import { arranged, heightOf, moved, rearranged } from "./narrow.js";

/** @import { Control, Frames, Placed } from "./data.js" */

const NARROW = matchMedia("(max-width: 600px)"); // a phone
const VISIBLE = 0.7; // of the window's height: the rest has the sliders and the browser's own bars

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
    if (check) input.checked = position === 1;
    else {
      input.value = `${position}`;
      input.setAttribute("aria-valuetext", values[position]);
    }
  };
  if (check) input.type = "checkbox";
  else Object.assign(input, { type: "range", min: "0", max: `${values.length - 1}` });
  input.setAttribute("aria-label", name);
  input.addEventListener("input", () => {
    moved(check ? Number(input.checked) : input.valueAsNumber);
  });
  show(start);
  row.append(name, input);
  if (!check) row.append(value);
  return { row, show };
}

/**
 * A ring on the picture that a hand drags. Keyboards and screen readers have the sliders.
 *
 * @param {HTMLImageElement} picture
 * @param {(hand: [x: number, y: number], size: [width: number, height: number]) => void} moved
 *   in pixels, from the picture's top left
 */
function ringOn(picture, moved) {
  const stage = document.createElement("div");
  const ring = document.createElement("div");
  stage.className = "glid-stage";
  ring.className = "glid-ring";
  ring.setAttribute("aria-hidden", "true");
  picture.replaceWith(stage);
  stage.append(picture, ring);
  /** @type {[x: number, y: number]} */
  let held = [0, 0]; // from the hand to the ring's middle
  ring.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    event.preventDefault();
    const { left, top, width, height } = ring.getBoundingClientRect();
    held = [left + width / 2 - event.clientX, top + height / 2 - event.clientY];
    ring.setPointerCapture(event.pointerId);
  });
  ring.addEventListener("pointermove", (event) => {
    if (!ring.hasPointerCapture(event.pointerId)) return;
    const { left, top, width, height } = picture.getBoundingClientRect();
    moved([event.clientX + held[0] - left, event.clientY + held[1] - top], [width, height]);
  });
  return ring;
}

/**
 * Where the parts of the picture are in a figure of this width; null as long as the whole picture
 * is shown.
 *
 * @param {Frames} data
 * @param {number} width
 */
function layout({ parts }, width) {
  if (!parts?.length || !NARROW.matches || !width) return null;
  return arranged(parts, width, VISIBLE * innerHeight);
}

/**
 * Puts the sliders above the picture, and the ring on it.
 *
 * @param {HTMLElement} figure
 * @param {Frames} data
 */
export function addControls(figure, data) {
  const { controls, points } = data;
  const picture = /** @type {HTMLImageElement} */ (figure.querySelector("img"));
  /** @type {[width: number, height: number]} */
  const size = [Number(picture.getAttribute("width")), Number(picture.getAttribute("height"))];
  let positions = controls.map(({ start }) => start);
  let width = figure.clientWidth;
  /** @type {Placed[] | null} */
  let placed = layout(data, width);
  const rows = controls.map((control, i) =>
    controlled(control, (position) => show(positions.with(i, position))),
  );
  const places = () => {
    const all = points ?? [];
    return placed ? moved(all, placed, size, width) : all;
  };
  const ring =
    points &&
    ringOn(picture, (hand, [wide, high]) => {
      /** @type {[x: number, y: number][]} */
      const now = places().map(([x, y]) => [wide * x, high * y]);
      const next = dragged(controls, now, positions, hand);
      if (next !== positions) show(next);
    });

  /** @param {number[]} next */
  function show(next) {
    positions = next;
    const at = frameAt(controls, positions);
    const whole = svgOf(data, at);
    const svg = placed ? rearranged(whole, placed, size, width) : whole;
    picture.src = `data:image/svg+xml,${encodeURIComponent(svg)}`;
    picture.alt = wordsOf(data, positions);
    [picture.width, picture.height] = placed ? [width, Math.round(heightOf(placed))] : size;
    rows.forEach((row, i) => {
      row.show(positions[i]);
    });
    if (ring) {
      const [left, top] = places()[at];
      Object.assign(ring.style, { left: `${100 * left}%`, top: `${100 * top}%` });
    }
  }
  show(positions);
  figure.prepend(...rows.map(({ row }) => row));
  new ResizeObserver(() => {
    if (figure.clientWidth === width) return;
    width = figure.clientWidth;
    placed = layout(data, width);
    show(positions);
  }).observe(figure);
}
