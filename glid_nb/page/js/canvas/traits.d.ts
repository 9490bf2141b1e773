// What the kernel says of a canvas: the traits of `Stage` in glid_nb/widgets/pane.py.

import type { Outline, Pose, SolverOptions } from "../live/types.js";
import type { Point } from "../types.js";

/** Angle and scale of the pin that was selected last, and whether each is wanted. */
export type Ring = [angle: number, scale: number, turned: boolean, scaled: boolean];

export interface Marks {
  targets: Point[];
  images: Point[];
  selected: number[];
  hidden: number[];
  ring: Ring | [];
}

/**
 * The pins that a drag takes while a motion stands still: those of the keyframe before, where the
 * shape carries them. Places of hidden ones are not numbers.
 */
export interface PinsBetween {
  places: Point[];
  locked: number[];
}

/** Pins by their indices: which are locked, which the user hid, and the group's number of each. */
export interface PinMarks {
  locked: number[];
  away: number[];
  groups: number[];
}

export interface ColorBar {
  title: string;
  /** The title while a motion is seen. */
  moving?: string;
  colors: string[];
  ticks: string[];
  about: string;
}

/** What the left button does; empty while it pins and drags. */
export type Tool = "" | "stiff" | "erase";

export interface Brush {
  radius: number;
  /** 0 erases. */
  strength: number;
}

/** The domain, and the sizes of the shader's arrays, in vectors. */
export interface Outlined {
  outline: Outline;
  chain: number;
  shaderHoles: number;
}

/** A shape that is drawn but not edited. */
export interface PartShape extends Outlined {
  key: string;
  materials: string[];
}

/** A pose whose map the kernel has found. */
export interface Rest {
  number: number;
  pose: Pose;
  coefficients: DataView;
}

export interface CanvasTraits {
  width: number;
  height: number;
  room: number[];
  view: [x: number, y: number, unit: number];
  coefficients: DataView;
  outline: Outlined;
  part_shapes: PartShape[];
  part_maps: Record<string, DataView>;
  solver_script: string;
  solver: { options: SolverOptions } | Record<string, never>;
  rest: Rest | Record<string, never>;
  marks: Marks;
  names: string[];
  pins: PinMarks;
  /** Width and height of the picture in its pixels. */
  picture_size: number[];
  /** A picture behind the shape; empty for none. */
  reference: DataView<ArrayBuffer>;
  /** The background, while there is a reference over it; empty for none. */
  behind_reference: DataView<ArrayBuffer>;
  onion: [color: string, loops: Point[][]][];
  stiff: [strength: number, loops: Point[][]][];
  /** Empty before the kernel has told of it. */
  brush: (Brush & { tool: Tool }) | Record<string, never>;
  cursor: Point | null;
  legend: ColorBar | Record<string, never>;
  panel_legend: ColorBar | Record<string, never>;
  legend_corner: string;
  notice: string;
  prepared: number;
  interactive: boolean;
  uniform_vectors: number;
  drawing_time: number;
  drawn: boolean;
  renderer: string;
  camera: string;
  materials: string[];
}
