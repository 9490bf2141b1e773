// What the modules of the live solver share. Other types are JSDoc beside the code.
//
// `n` is the number of columns of the basis: the offset cage's vertices, then one for each hole.

import type { Point } from "../types.d.ts";

/** A cage, its offset cage and its hole points, as `Domain.to_dict` of the package writes them. */
export interface Outline {
  cage: Point[];
  holes: Point[][];
  offset_cage: Point[];
  offset_holes: Point[][];
  hole_points: Point[];
}

/** Complex numbers, or a complex matrix row by row. */
export interface Complex {
  re: Float64Array;
  im: Float64Array;
}

/** A map: [Re phi, Im phi, Re psi, Im psi], n numbers each. */
export type Coefficients = Float64Array;

/** f = f_z and g = conj(f_zbar) at s nodes: [Re f, Im f, Re g, Im g], s numbers each. */
export type Samples = Float64Array;

/** Where pins hold the shape. Lists have one entry for each pin. */
export interface Pose {
  handles: Point[];
  targets: Point[];
  /** How firmly each is held; 1 without. */
  weights?: number[] | null;
  /** Radians by which the shape turns at the pin; null where it may turn freely. */
  angles?: (number | null)[] | null;
  /** Factors by which it is scaled there; null where they are free. */
  scales?: (number | null)[] | null;
}

/** What is proved of a map, on the whole closed domain if `certified`. */
export interface Certificate {
  certified: boolean;
  sigma2_lower: number;
  sigma1_upper: number;
  k_upper: number;
  /** Turns of f_z along each loop of the cage, the exterior first. */
  windings: number[];
  /** The panels that were halved. */
  halved: number;
  /** The panel that could not be proved, or -1. */
  refused: number;
}

/** Names of the energies, as `ENERGIES` of the package has them. */
export type EnergyName = "iso" | "exp" | "amips" | "mips" | "arap";

/** Stiff areas, as `glid_nb.solvers.stiffness.stiff_nodes` gives them for an outline. */
export interface Stiff {
  /** Factors of the weights at the panels' starts, then at their middles. */
  factors: number[];
  /** Nodes inside the areas, and their weights. */
  points: Point[];
  weights: number[];
}

/** How to solve. */
export interface SolverOptions {
  energy?: EnergyName;
  /** The parameter of `exp` and `amips`; 1 without. */
  s?: number;
  /** lambda of (20), for lengths in twentieths of the cage's longer side; 1e5 without. */
  weight?: number;
  stiff?: Stiff | null;
}

/** What the page asks of the worker. Every request has a number, which its answers repeat. */
export type LiveRequest =
  /** Prepares a shape; `points` are where every map is evaluated, such as a mesh's vertices. */
  | { type: "shape"; id: number; outline: Outline; points?: Point[]; options?: SolverOptions }
  /** Changes the energy; the map stays. */
  | { type: "options"; id: number; options: SolverOptions }
  /** Solves from the identity. */
  | { type: "solve"; id: number; pose: Pose }
  /** Follows moved targets from the map that is; a later request replaces one that waits. */
  | { type: "drag"; id: number; pose: Pose }
  /** Takes up another map, if it can be proved. */
  | { type: "place"; id: number; pose: Pose; coefficients: Coefficients }
  /** Evaluates every map at other points from now on, and answers with the map that is. */
  | { type: "points"; id: number; points: Point[] }
  /** Asks what a file with the proof of the map that is has to claim. */
  | { type: "claim"; id: number };

/** What the worker answers. */
export type LiveAnswer =
  | { type: "ready"; id: number; panels: number; columns: number }
  | LiveMap
  | { type: "claim"; id: number; claim: Claim }
  | { type: "failed"; id: number; message: string };

/** A certified map. The certificate was computed from these coefficients. */
export interface LiveMap {
  type: "map";
  id: number;
  /** Whether the worker goes on with this request. */
  settled: boolean;
  outcome: string;
  energy: number;
  coefficients: Coefficients;
  certificate: Certificate;
  /** Of the shape's points, if it has any: x and y in turn, and [Re f_z, Im f_z, Re g, Im g]. */
  images: Float64Array | null;
  samples: Samples | null;
  /** Of the pins, likewise. */
  pins: Field;
  /** Steps that this answer took, and ms for them and for the evaluation at the shape's points. */
  steps: number;
  took: number;
  evaluated: number;
}

/** A map at k points: x and y of each in turn, and [Re f_z, Im f_z, Re g, Im g], k numbers each. */
export interface Field {
  images: Float64Array;
  samples: Samples;
}

/** What is claimed of a map, for `glid-check`. */
export interface Claim {
  coefficients: Coefficients;
  certificate: Certificate;
  /** For each edge of the cage its pieces [k, d], from k / 2^d to (k + 1) / 2^d. */
  panels: [k: number, d: number][][];
}
