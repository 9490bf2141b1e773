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
}
