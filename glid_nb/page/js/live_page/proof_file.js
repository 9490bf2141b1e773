// The map and its proof as `glid-check` reads them; docs/checking.md documents the format.

/** @import { Claim, Outline } from "../live/types.js" */

const FRACTION = 52; // bits
const LEAST_EXPONENT = -1022;

/**
 * A number as Python's `float.hex` writes it: its 64 bits.
 * @param {number} x finite
 */
export function hexText(x) {
  const bits = new DataView(new ArrayBuffer(8));
  bits.setFloat64(0, x);
  const whole = bits.getBigUint64(0);
  const sign = whole >> 63n ? "-" : "";
  const exponent = Number((whole >> BigInt(FRACTION)) & 0x7ffn);
  const fraction = whole & ((1n << BigInt(FRACTION)) - 1n);
  if (!exponent && !fraction) return `${sign}0x0.0p+0`;
  const power = exponent ? exponent - 1023 : LEAST_EXPONENT;
  const digits = fraction.toString(16).padStart(FRACTION / 4, "0");
  return `${sign}0x${exponent ? 1 : 0}.${digits}p${power < 0 ? "" : "+"}${power}`;
}

/**
 * The contents of map.json and proof.json.
 * @param {Outline} outline
 * @param {Claim} claim
 */
export function proofFiles(outline, { coefficients, certificate, panels }) {
  const n = coefficients.length / 4;
  // JSON has no -0, so both files have 0.
  const pair = (/** @type {number} */ first, /** @type {number} */ j) => [
    coefficients[first * n + j] + 0,
    coefficients[(first + 1) * n + j] + 0,
  ];
  const columns = Array.from({ length: n }, (_, j) => j);
  const { cage, holes, offset_cage, offset_holes, hole_points } = outline;
  const map = {
    cage,
    holes,
    offset_cage,
    offset_holes,
    hole_points,
    phi: columns.map((j) => pair(0, j)),
    psi: columns.map((j) => pair(2, j)),
  };
  const { sigma2_lower, sigma1_upper, k_upper, windings } = certificate;
  const bounds = { sigma2_lower, sigma1_upper, k_upper };
  const claimed = {
    format: "glid_nb-proof",
    version: 1,
    .../** @type {object} */ (inHex({ ...map, ...bounds })),
    windings,
    panels,
  };
  return {
    map: JSON.stringify({ format: "glid_nb-map", version: 1, ...map }),
    proof: JSON.stringify(claimed),
  };
}

/**
 * @param {unknown} value
 * @returns {unknown} the same with every number as text
 */
function inHex(value) {
  if (typeof value === "number") return hexText(value + 0);
  if (Array.isArray(value)) return value.map(inHex);
  const entries = Object.entries(/** @type {object} */ (value));
  return Object.fromEntries(entries.map(([key, one]) => [key, inHex(one)]));
}
