// What the kernel says of a timeline: the traits of `TimelinePanel` in glid_nb/widgets/timeline.py.

import type { Repeat } from "../motion/motion.js";
import type { Point } from "../types.js";
import type { Easing } from "./ease.js";

export interface Keyframe {
  name: string;
  time: number;
  /** Of the motion to the next keyframe. */
  easing: Easing;
  /** The key of its picture in `thumbnails`. */
  thumbnail?: string;
}

/** The motion from one keyframe to the next. */
export interface Span {
  start: number;
  end: number;
  status: "proved" | "fails" | "refused" | "computing";
  reason: string;
  /** The last instant that is proved. */
  until: number;
  /** Of the knots, as far as it is proved. */
  times: number[];
  /** The coefficients at the knots; empty where the kernel evaluates. */
  floats: DataView;
  /** The bound on each piece between two knots. */
  sigma2: number[];
}

export interface Shown {
  keyframes: Keyframe[];
  active: number;
  repeat: Repeat;
  /** Seconds from the last keyframe back to the first, of a loop. */
  back: number;
  /** Where the part begins and ends that plays over and over; null for the whole motion. */
  range: [start: number, end: number] | null;
  recording: boolean;
  onion: boolean;
  /** Whether there is an export button. */
  exports: boolean;
  /** Whether the kernel evaluates the motion. */
  kernel: boolean;
  /** The name of the edited part; empty if there is only one shape. */
  part: string;
}

/** The heights of a picture's vertices at the keyframes; no times where they stay. */
export interface Heights {
  times: number[];
  floats: DataView;
}

/** The places of pins, pair after pair, and the indices of those that are locked. */
export interface Pins {
  floats: DataView;
  locked: number[];
}

/** The pins that a drag takes: at the knots of each span, and at the keyframes, by their times. */
export interface MovingPins {
  spans: (Pins & { end: number; times: number[] })[];
  poses: Pins[];
  /** Of a loop also the time of the return. */
  keyframes: number[];
}

/** Those pins at a time. Places of hidden ones are not numbers. */
export interface PinsThen {
  places: Point[];
  locked: number[];
}

/** The motion of a shape around the edited one. */
export interface PartMotion {
  key: string;
  name: string;
  spans: Span[];
  heights: Heights;
}

export interface TimelineTraits {
  stage: string;
  /** Frames in a second of an export. */
  rate: number;
  shown: Shown;
  motion: { spans: Span[] };
  heights: Heights;
  part_motions: PartMotion[];
  pins: MovingPins;
  thumbnails: Record<string, string>;
}
