// The inspector's numbers of pins follow the hand. While a pin is dragged, the page writes them, and
// once the drag has ended, the kernel's count.

/** @import { Mark, Point } from "../types.js" */
/** @import { Marks } from "./traits.js" */

/**
 * The numbers of a pin as `glid_nb.widgets.pins` writes them: those of its fields, and its place in
 * the list.
 *
 * @param {Point} place
 * @param {Marks["ring"]} ring of the pin that was selected last; empty fields are free
 */
export function wordsOf([x, y], [angle = 0, scale = 1, turned, scaled]) {
  return {
    x: rounded(x),
    y: rounded(y),
    angle: turned ? significant((angle * 180) / Math.PI) : "",
    scale: scaled ? significant(scale) : "",
    detail: `${short(x)}, ${short(y)}`,
  };
}

/**
 * The numbers of the selected pins' fields. A field of several pins is empty unless all have its
 * number. What all turn or scale alike, they go on having alike.
 *
 * @param {Point[]} places
 * @param {Marks["ring"]} ring of the pin that was selected last; empty if the hand cannot turn it
 * @param {{ angle: string, scale: string }} before what these fields say
 */
export function fieldWords(places, ring, before) {
  const words = places.map((place) => wordsOf(place, ring));
  const [{ x, y, angle, scale }] = words;
  /** @param {"angle" | "scale"} name */
  const follows = (name) => ring.length && (words.length === 1 || before[name]);
  return {
    x: words.every((one) => one.x === x) ? x : "",
    y: words.every((one) => one.y === y) ? y : "",
    angle: follows("angle") ? angle : before.angle,
    scale: follows("scale") ? scale : before.scale,
  };
}

/** @param {number} number */
function rounded(number) {
  return String(Number(number.toFixed(3)) || 0); // avoids -0
}

/** @param {number} number */
function significant(number) {
  return String(Number(Number(number.toFixed(4)).toPrecision(4)) || 0);
}

/** @param {number} number */
function short(number) {
  return (Number(number.toFixed(2)) || 0).toFixed(2).replace("-", "\u2212");
}

/**
 * Whether the kernel still means what it said before the page wrote something else. Its numbers are
 * rounded on the way here, so the nearer text counts.
 *
 * @param {string} said by the kernel, before
 * @param {string} wrote
 * @param {string} now what the kernel's marks say
 */
export function meansStill(said, wrote, now) {
  if (now === wrote || said === wrote) return false;
  const apart = (/** @type {string} */ one) => Math.abs(numberIn(one) - numberIn(now));
  return now === said || apart(said) < apart(wrote);
}

/** @param {string} text a number, or two, of which the sum tells enough */
function numberIn(text) {
  const numbers = text.replaceAll("\u2212", "-").split(",").map(Number.parseFloat);
  return numbers[0] + Math.PI * (numbers[1] ?? 0);
}

/** A text of the inspector: a field, or a cell of the list. */
class Written {
  said = ""; // by the kernel
  wrote = "";

  /** @param {HTMLElement} element */
  constructor(element) {
    this.element = element;
    this.said = this.text;
    this.wrote = this.said;
  }

  get text() {
    const { element } = this;
    return element instanceof HTMLInputElement ? element.value : (element.textContent ?? "");
  }

  /** @param {string} text */
  put(text) {
    if (this.text !== this.wrote) this.said = this.text; // the kernel has told of another
    this.wrote = text;
    if (this.text === text) return;
    if (this.element instanceof HTMLInputElement) this.element.value = text;
    else this.element.textContent = text;
  }

  /** @param {string} now what the kernel's marks say */
  settle(now) {
    if (this.text === this.wrote && meansStill(this.said, this.wrote, now)) this.put(this.said);
  }
}

export class FollowedNumbers {
  /** @type {Map<HTMLElement, Written>} */
  #written = new Map();

  /** @param {HTMLElement} pad of the canvas */
  constructor(pad) {
    this.pad = pad;
  }

  /**
   * Writes the numbers of the pins that are moved.
   *
   * @param {Marks} marks
   * @param {Map<Mark, Point>} held where the pointer holds targets
   */
  follow(marks, held) {
    for (const [element, text] of this.#texts(marks, held)) {
      const written = this.#written.get(element) ?? new Written(element);
      this.#written.set(element, written);
      written.put(text);
    }
  }

  /**
   * After a drag, once the kernel has answered: what it has not told of anew, as nothing has changed
   * in the end, is shown again.
   *
   * @param {Marks} marks the kernel's
   */
  settle(marks) {
    if (!this.#written.size) return;
    for (const [element, text] of this.#texts(marks, new Map())) {
      this.#written.get(element)?.settle(text);
    }
    this.#written.clear();
  }

  /**
   * The inspector's texts of the selected pins, and of the pins that are moved.
   *
   * @param {Marks} marks
   * @param {Map<Mark, Point>} held
   * @returns {[element: HTMLElement, text: string][]}
   */
  #texts({ targets, selected, ring }, held) {
    const side = this.pad.closest(".glid-editor")?.querySelector(".glid-side .glid-bars");
    const last = selected.at(-1);
    if (!side || last === undefined || !targets[last]) return [];
    /** @param {string} name */
    const field = (name) => {
      return /** @type {HTMLInputElement | null} */ (
        side.querySelector(`.glid-number-${name} input`)
      );
    };
    const places = selected.map((i) => held.get(i) ?? targets[i]).filter(Boolean);
    const before = { angle: field("angle")?.value ?? "", scale: field("scale")?.value ?? "" };
    /** @type {[HTMLElement | null, string][]} */
    const found = Object.entries(fieldWords(places, ring, before)).map(([name, text]) => [
      field(name),
      text,
    ]);
    const cells = /** @type {NodeListOf<HTMLElement>} */ (
      side.querySelectorAll(".glid-entry-detail")
    );
    for (const [i, cell] of cells.entries()) {
      const place = held.get(i) ?? targets[i];
      if (place) found.push([cell, wordsOf(place, []).detail]);
    }
    return /** @type {[HTMLElement, string][]} */ (found.filter(([element]) => element));
  }
}
