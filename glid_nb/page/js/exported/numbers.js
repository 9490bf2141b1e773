// Bounds in words, rounded to what is still a bound.

/** @import { MotionData } from "./data.js" */

/** @param {number} x */
export function down(x) {
  return (Math.floor(1000 * x) / 1000).toFixed(3);
}

/**
 * A positive number, of which something is seen however small it is.
 *
 * @param {number} x
 */
export function downSmall(x) {
  if (!(x > 0) || x >= 0.01) return down(x);
  const power = Math.floor(Math.log10(x));
  const digits = Math.floor((0.999999 * x) / 10 ** (power - 1)) / 10;
  return `${digits}e${power}`;
}

/** @param {number} x */
export function up(x) {
  return (Math.ceil(1000 * x) / 1000).toFixed(3);
}

/**
 * What is proved at a time.
 *
 * @param {MotionData} motion
 * @param {number} piece with that time
 * @param {number} time
 */
export function provedNow({ sigma1, sigma2, k, until }, piece, time) {
  const low = sigma2[piece];
  const high = sigma1[piece];
  const most = k[piece];
  if (low !== null && high !== null && most !== null) {
    return `Now: σ₂ ≥ ${down(low)}, σ₁ ≤ ${up(high)}, k ≤ ${up(most)}`;
  }
  return time < until ? "Now: proved not to fold" : "Now: not proved";
}
