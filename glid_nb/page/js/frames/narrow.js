// A figure of several panels on a narrow page: panels wrap like words, so that their text stays
// legible.

/** @import { Box, Placed } from "./data.js" */

const LEAST = 0.75; // scale: letters of 8 points, 12 CSS pixels, then have 9

/**
 * The parts in rows, each row in the middle.
 *
 * @param {Box[]} parts
 * @param {number} width of the page
 * @param {number} scale
 * @returns {Placed[]}
 */
function inRows(parts, width, scale) {
  /** @type {Box[][]} */
  const rows = [];
  let left = 0;
  for (const part of parts) {
    const wide = scale * part[2];
    if (!rows.length || wide > left) {
      rows.push([]);
      left = width;
    }
    rows[rows.length - 1].push(part);
    left -= wide;
  }
  let top = 0;
  return rows.flatMap((row) => {
    let x = (width - row.reduce((sum, [, , wide]) => sum + scale * wide, 0)) / 2;
    const y = top;
    top += scale * Math.max(...row.map(([, , , high]) => high));
    return row.map((from) => {
      const [, , wide, high] = from;
      const placed = { from, to: /** @type {Box} */ ([x, y, scale * wide, scale * high]) };
      x += scale * wide;
      return placed;
    });
  });
}

/**
 * The height of parts in rows.
 *
 * @param {Placed[]} placed
 */
export function heightOf(placed) {
  return Math.max(...placed.map(({ to: [, y, , height] }) => y + height));
}

/**
 * Where the parts are. They have their own size if all of them are then visible together, and else
 * a smaller one.
 *
 * @param {Box[]} parts
 * @param {number} width of the page
 * @param {number} height that is visible at once
 */
export function arranged(parts, width, height) {
  const most = Math.min(1, width / Math.max(...parts.map(([, , wide]) => wide)));
  const scales = [most, 0.95, 0.9, 0.85, 0.8, LEAST].filter((scale) => scale <= most);
  const tried = scales.map((scale) => inRows(parts, width, scale));
  return tried.find((placed) => heightOf(placed) <= height) ?? tried[tried.length - 1];
}

/**
 * The picture with its parts placed.
 *
 * @param {string} svg
 * @param {Placed[]} placed
 * @param {[width: number, height: number]} size of the whole figure, in CSS pixels
 * @param {number} width of the page
 */
export function rearranged(svg, placed, size, width) {
  const whole = svg
    .slice(svg.indexOf("<svg"))
    .replace(/ width="[^"]*" height="[^"]*"/, ` id="whole" width="${size[0]}" height="${size[1]}"`);
  const height = heightOf(placed);
  const views = placed.map(({ from, to }) => {
    const [x, y, wide, high] = to;
    const at = `x="${x}" y="${y}" width="${wide}" height="${high}"`;
    return `<svg ${at} viewBox="${from.join(" ")}"><use xlink:href="#whole"/></svg>`;
  });
  const names = 'xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"';
  const shown = `width="${width}" height="${height}" viewBox="0 0 ${width} ${height}"`;
  const paper = '<rect width="100%" height="100%" fill="white"/>';
  return `<svg ${names} ${shown}><defs>${whole}</defs>${paper}${views.join("")}</svg>`;
}

/**
 * Where points of the first panel are, as shares of the arranged picture's width and height.
 *
 * @param {[x: number, y: number][]} points as shares of the whole figure's width and height
 * @param {Placed[]} placed
 * @param {[width: number, height: number]} size of the whole figure, in CSS pixels
 * @param {number} width of the page
 */
export function moved(points, placed, size, width) {
  const [{ from, to }] = placed;
  const [scale, height] = [to[2] / from[2], heightOf(placed)];
  return points.map(([x, y]) => {
    const [right, down] = [x * size[0] - from[0], y * size[1] - from[1]];
    return /** @type {[x: number, y: number]} */ ([
      (to[0] + scale * right) / width,
      (to[1] + scale * down) / height,
    ]);
  });
}
