// Which rows of a list are selected by a click or a key.

/**
 * The keys from one row to another, which comes last, so that it counts most.
 *
 * @param {number[]} keys of all rows
 * @param {number} from a key
 * @param {number} to a key
 */
export function between(keys, from, to) {
  const [a, b] = [keys.indexOf(from), keys.indexOf(to)];
  if (a < 0 || b < 0) return [to];
  return a <= b ? keys.slice(a, b + 1) : keys.slice(b, a + 1).reverse();
}

/**
 * The index of the row to which a key goes; null if it goes nowhere.
 *
 * @param {string} key
 * @param {number} at the present row
 * @param {number} count of all rows
 */
export function rowAfter(key, at, count) {
  const to = { ArrowUp: at - 1, ArrowDown: at + 1, Home: 0, End: count - 1 }[key];
  return to === undefined || !count ? null : Math.min(Math.max(to, 0), count - 1);
}
