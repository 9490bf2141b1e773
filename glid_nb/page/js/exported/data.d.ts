// What `parts_page_html` in glid_nb/export/page.py writes into the page.

import type { Repeat } from "../motion/motion.js";

/** Numbers as `packed` writes them. */
export interface Packed {
  step: number;
  bytes: string;
}

/** Rows of numbers as `factored` writes them: sums of few rows. */
export interface Factored {
  sizes: number[];
  rows: Packed & { width: number };
  shares: Packed;
}

/** The bounds of pieces, null where they are not proved; a map that stands still has none. */
export interface MotionData {
  times: number[];
  keyframes: number[];
  repeat: Repeat;
  sigma2: (number | null)[];
  sigma1: (number | null)[];
  k: (number | null)[];
  until: number;
}

export type Box = [left: number, bottom: number, right: number, top: number];

/** What belongs to one shape. */
export interface PartData {
  /** The vertices of the picture's mesh, undeformed. */
  source: Packed;
  /** Of each vertex, one row for each of `height_times`. */
  heights: Factored;
  height_times: number[];
  triangles: Packed;
  /** What the shown map covers, and the undeformed shape. */
  bounds: Box;
  source_bounds: Box;
  vertex: string;
  motion: MotionData;
  /** Rows of `width` numbers: the undeformed shape's, then those at the knots. */
  coefficients: Factored;
  width: number;
  /** Empty where a shader cannot hold it. */
  cage: string;
  picture: string;
}

export interface PageData {
  /** The shapes, the rearmost first. Their motions have the same start, end and keyframes. */
  parts: PartData[];
  fragment: string;
  /** The pictures' place in the world. */
  frame: Box;
  margin: number;
  grid: number;
  /** Red, green and blue of the colour map's stops. */
  colors: number[];
  /** By the overlay's number, the values at the ends of the colour map. */
  ranges: Record<string, [number, number]>;
  loop: boolean;
}
