// What `live` in glid_nb/figures/frames.py writes.

export interface Control {
  name: string;
  /** The words of each position. */
  values: string[];
  /** The position to begin with. */
  start: number;
  /** Whether it is a check box, for false and true. */
  check: boolean;
}

export interface Frames {
  controls: Control[];
  /** The lines of all frames, each once. */
  lines: string[];
  /** The lines of each frame, by number. The last control's position changes first. */
  frames: number[][];
  /** The words above each frame. */
  titles: string[];
  /** Where each frame's point is, as shares of the picture's width and height from its top left. */
  points?: [x: number, y: number][];
  /** Panels from left to right, then colour bars and legends; empty for a figure with one panel. */
  parts: Box[];
}

/** In CSS pixels of the whole figure, from its top left. */
export type Box = [x: number, y: number, width: number, height: number];

/** Where a part of a figure is on a narrow page. */
export interface Placed {
  /** In the whole figure. */
  from: Box;
  /** On the page; the scale is the same in both directions. */
  to: Box;
}
