// What the kernel says of a list: the traits of `RowList` in glid_nb/widgets/row_list.py.

/** What can be switched on or off for each thing. */
export type Switch = "hidden" | "locked";

export interface Row {
  key: number;
  /** Before the name; empty where the name alone says which thing it is. */
  number: string;
  name: string;
  /** Instead of both where there is no name. */
  unnamed: string;
  /** What stands behind the name, such as its place. */
  detail: string;
  /** What a screen reader says of the detail. */
  said: string;
  /** Things with the same number above 0 belong together. */
  group: number;
  /** A data URI; empty for none. */
  picture: string;
  switches: Partial<Record<Switch, boolean>>;
}

export interface RowTraits {
  label: string;
  /** What stands there while the list is empty. */
  nothing: string;
  rows: Row[];
  /** The keys of the selected things; the last one counts most. */
  chosen: number[];
  /** Whether several can be selected. */
  several: boolean;
}
