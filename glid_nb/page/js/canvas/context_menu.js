// The menu of a pin, or of the shape at a place.

/** @import { MenuRow } from "../pad/menu.js" */
/** @import { PinMarks } from "./traits.js" */

/**
 * What the menu's rows do.
 *
 * @typedef {object} Does
 * @property {(key: string, shift?: boolean) => () => void} press what a key does
 * @property {() => void} pin adds a pin at the place
 * @property {() => void} paste
 * @property {() => void} alone shows the picture alone
 * @property {() => void} fullScreen
 * @property {() => void} showKeys
 */

/**
 * The pins that a pin's menu is about: those selected with it.
 *
 * @param {number} pin
 * @param {number[]} selected
 */
export function pinsOfMenu(pin, selected) {
  return selected.includes(pin) ? selected : [pin];
}

/**
 * @param {Does} does
 * @param {number[] | null} pins those that the rows are about; null where there is none
 * @param {boolean} covered whether the shape is there
 * @param {PinMarks} marks of all pins
 * @returns {MenuRow[]}
 */
export function menuRows(does, pins, covered, marks) {
  return [
    ...(pins === null ? shapeRows(does, covered) : pinRows(does, pins, marks)),
    ...(marks.away.length
      ? [/** @type {MenuRow} */ (["Show hidden pins", "Shift+H", does.press("h", true)])]
      : []),
    ["Copy the pose", "Ctrl+C", does.press("copy")],
    ["Paste a pose", "Ctrl+V", does.paste],
    ["Swap left and right", "M", does.press("m")],
    ["Select all pins", "A", does.press("a")],
    ["The undeformed shape", "0", does.press("0")],
    ["See everything", "F", does.press("f")],
    ["Paint stiff areas", "B", does.press("b")],
    ["The picture alone", "P", does.alone],
    ["Full screen", "W", does.fullScreen],
    ["All keys", "?", does.showKeys],
  ];
}

/**
 * @param {Does} does
 * @param {number[]} pins
 * @param {PinMarks} marks
 * @returns {MenuRow[]}
 */
function pinRows({ press }, pins, { locked }) {
  const several = pins.length > 1;
  // The kernel's rule: the key locks, unless all of them are locked.
  const lock = pins.every((i) => locked.includes(i)) ? "Unlock" : "Lock";
  return [
    [several ? `Remove ${pins.length} pins` : "Remove", "Delete", press("Delete")],
    ["Remove, keep the shape", "Shift+Delete", press("Delete", true)],
    null,
    ["Bring forward", "Page Up", press("PageUp")],
    ["Send back", "Page Down", press("PageDown")],
    ["Leave angle and scale free", "X", press("x")],
    [lock, "L", press("l")],
    ["Hide", "H", press("h")],
    ...(several ? [/** @type {MenuRow} */ (["Group", "G", press("g")])] : []),
    null,
  ];
}

/**
 * @param {Does} does
 * @param {boolean} covered
 * @returns {MenuRow[]}
 */
function shapeRows({ pin }, covered) {
  return covered ? [["Add a pin here", "Click", pin], null] : [];
}
