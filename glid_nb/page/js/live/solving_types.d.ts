import type { LiveRequest } from "./types.d.ts";

/** A union's members without a key. */
type Without<Union, Key extends string> = Union extends unknown ? Omit<Union, Key> : never;

/** A request before it has its number. */
export type Unnumbered = Without<LiveRequest, "id">;
