import type { Solving } from "./solving.js";
import type { LiveRequest } from "./types.d.ts";

/** A union's members without a key. */
type Without<Union, Key extends string> = Union extends unknown ? Omit<Union, Key> : never;

/** A request before it has its number. */
export type Unnumbered = Without<LiveRequest, "id">;

/** What follows pins: the solver of one shape, or those of several. */
export type Solver = Pick<Solving, "drag" | "map" | "onmap" | "place">;
