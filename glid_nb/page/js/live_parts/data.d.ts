// What `parts_live_html` in glid_nb/export/live_page.py writes into the page of several shapes.

import type { LiveMap } from "../live/types.d.ts";
import type { LiveData } from "../live_page/data.d.ts";

type Common =
  | "title"
  | "painting"
  | "fragment"
  | "frame"
  | "size"
  | "margin"
  | "grid"
  | "colors"
  | "ranges";

/** What belongs to one shape. */
export type PartData = Omit<LiveData, Common> & { name: string };

/** The shapes, the rearmost first, and what they share. */
export type PartsData = Pick<LiveData, Common> & { parts: PartData[] };

/** The maps of all shapes as one. Its certificate has the worst bounds of all. */
export type JointMap = LiveMap & { parts: LiveMap[] };
