// The menu of a pin, or of the shape at a place.

/** @import { MenuRow } from "../pad/menu.js" */

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
 * @param {Does} does
 * @param {number | null} pins how many pins the rows are about; null where there is none
 * @param {boolean} covered whether the shape is there
 * @param {boolean} hides whether some pins are hidden
 * @returns {MenuRow[]}
 */
export function menuRows(does, pins, covered, hides) {
  return [
    ...(pins === null ? shapeRows(does, covered) : pinRows(does, pins)),
    ...(hides
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
 * @param {number} count
 * @returns {MenuRow[]}
 */
function pinRows({ press }, count) {
  const pins = count > 1 ? ` ${count} pins` : "";
  return [
    [`Remove${pins}`, "Delete", press("Delete")],
    ["Remove, keep the shape", "Shift+Delete", press("Delete", true)],
    null,
    ["Bring forward", "Page Up", press("PageUp")],
    ["Send back", "Page Down", press("PageDown")],
    ["Leave angle and scale free", "X", press("x")],
    ["Lock or unlock", "L", press("l")],
    ["Hide", "H", press("h")],
    ...(count > 1 ? [/** @type {MenuRow} */ (["Group", "G", press("g")])] : []),
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
