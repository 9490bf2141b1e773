// How to draw, chosen by measured times: who moves the mesh, and how fine it is.

/** ms for a frame, of the display's 16. */
const QUICK = 4;
const FAST_ENOUGH = 8;
const TOO_SLOW = 16;
/** Pixels per pixel of the display, along a side, of a frame in a movement that is too slow. */
const COARSE = 0.5;

/**
 * The median.
 * @param {number[]} values
 */
export function median(values) {
  const sorted = values.toSorted((a, b) => a - b);
  return sorted[Math.floor(sorted.length / 2)];
}

/**
 * Whether the mesh may be finer, after a frame by the shader took so long.
 * @param {number} ms
 */
export function mayBeFiner(ms) {
  return ms <= QUICK;
}

/**
 * Whether a frame by the shader is quick enough, so that nothing else is tried.
 * @param {number} ms
 */
export function shaderSuffices(ms) {
  return ms <= FAST_ENOUGH;
}

/**
 * Pixels to draw per pixel of the display, along a side. Where drawing is slow, a movement has fewer.
 * @param {number} ms of a frame with all pixels
 * @param {boolean} moving
 */
export function sharpness(ms, moving) {
  return moving && ms > TOO_SLOW ? COARSE : 1;
}

/**
 * Who moves the mesh's vertices: the shader, or the solver's module, after which the shader paints only.
 * @param {number} shader ms of a frame whose shader evaluates the map
 * @param {number} painting ms of a frame whose shader paints only
 * @param {number} evaluation ms of the module for all vertices
 * @returns {"shader" | "module"}
 */
export function quicker(shader, painting, evaluation) {
  return painting + evaluation < shader ? "module" : "shader";
}
