// What the kernel says of a tracing: the traits of `CageTracer` in glid_nb/widgets/tracer.py.
// Points are in pixels of the picture.

import type { Point } from "../types.js";

export interface Options {
  method: string;
  invert: boolean | null;
  [name: string]: unknown;
}

export interface Hole {
  loop: Point[];
  /** Square pixels. */
  area: number;
  kept: boolean;
  by_offset: boolean;
}

export interface Shown {
  /** Width and height of the picture; null without one. */
  size: [width: number, height: number] | null;
  loops: Point[][];
  problems: { message: string; point: Point | null }[];
  options: Options;
  /** What a tracing chose by itself. */
  automatic: Record<string, any> | null;
  notes: string[];
  component: number;
  n_components: number;
  component_area: number;
  n_filled: number;
  reach_shares: { in_hole: number; edge: number };
  /** The largest ones of `n_holes`. */
  holes: Hole[];
  n_holes: number;
  strokes: Record<"foreground" | "background", Point[][]>;
  /** Why the outline is a guess; empty or null where it is none. */
  doubt: string | null;
  can_undo: boolean;
  can_redo: boolean;
  edited: boolean;
  discarded: boolean;
  tool: Tool;
  /** Of the outline that is drawn by hand. */
  corners: Point[];
  /** An outline drawn inside the shape, of which it is not known yet what it is; else empty. */
  inside: Point[];
  /** What the knife did last: its pieces as shares of the shape, and which one is kept. */
  cut: { shares: number[]; kept: number; in_middle: boolean } | null;
  /** Of the knife's slit, in pixels; null where the kernel chooses it. */
  knife_width: number | null;
  selected: [loop: number, index: number][];
  /** Whether the other pieces of a picture or cut can be kept as parts. */
  keeps: boolean;
}

export type Tool =
  | "edit"
  | "foreground"
  | "background"
  | "color"
  | "component"
  | "polygon"
  | "rectangle"
  | "knife";

export interface TracerTraits {
  picture: DataView<ArrayBuffer>;
  /** Empty until the first state came. */
  shown: Shown | Record<string, never>;
  height: number | null;
}
