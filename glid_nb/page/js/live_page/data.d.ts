// What `live_page_html` in glid_nb/export/live_page.py writes into the page, and what its modules share.

import type { Box, Factored, MotionData, Packed } from "../exported/data.d.ts";
import type { Coefficients, LiveMap, Outline, SolverOptions } from "../live/types.d.ts";
import type { Point } from "../types.d.ts";

/** A point that is held. */
export interface Pin {
  handle: Point;
  target: Point;
  /** Radians, counter-clockwise; null where the shape may turn freely. */
  angle: number | null;
  scale: number | null;
  weight: number;
  /** Where the shape overlaps, what is higher is in front. The page leaves it as it is. */
  depth: number;
  name: string;
}

/** What undo brings back. */
export interface Edit {
  pins: readonly Pin[];
  /** Numbers of pins; the last one has the ring. */
  selected: readonly number[];
  /** A certified map, near the one that these pins ask for. */
  coefficients: Coefficients;
}

/** A kept pose; `frame` is its certified map. */
export interface Kept {
  pins: readonly Pin[];
  frame: LiveMap;
}

export interface LiveData {
  title: string;
  outline: Outline;
  options: SolverOptions;
  /** The stiff areas' strokes, as `glid.Pose` takes them; null without. */
  stiffness?: object[] | null;
  /** The map to begin with; empty for the identity. */
  start: number[];
  /** The pins of the start; of a motion, those of all keyframes. */
  poses: Pin[][];
  motion: (MotionData & { coefficients: Factored; width: number }) | null;
  /** The mesh before its triangles are divided. */
  source: Packed;
  heights: Packed;
  triangles: Packed;
  /** The shader that evaluates the map; empty where the cage is too large for it. */
  vertex: string;
  /** The shader that takes vertices which are moved already. */
  painting: string;
  fragment: string;
  /** Vectors of the shader's arrays. */
  chain: number;
  shaderHoles: number;
  /** The picture's place in the world, and its pixels. */
  frame: Box;
  size: [width: number, height: number];
  margin: number;
  grid: number;
  colors: number[];
  ranges: Record<string, [number, number]>;
}
