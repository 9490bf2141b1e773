// What the kernel says of a toolbar: the traits of `Toolbar` in glid_nb/widgets/toolbar.py.

export type Tool = "" | "stiff" | "erase";

export interface ToolbarTraits {
  tool: Tool;
  /** What the shape shows. */
  overlay: string;
  overlays: [name: string, label: string][];
  /** What else can be shown. */
  checks: [name: string, label: string, title: string][];
  /** Which of these are shown. */
  shows: Record<string, boolean>;
  /** Whether there is a reference picture. */
  referenced: boolean;
  can_undo: boolean;
  can_redo: boolean;
}
