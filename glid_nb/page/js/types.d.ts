// What several modules share, and what anywidget hands them. Other types are JSDoc beside the code.

/** (x, y), in the coordinates that the name or the comment tells. */
export type Point = [number, number];

/** What a path is stroked with, the lowest first: widths and colours. */
export type Strokes = [width: number, style: string][];

/** What a drag moves: the number of a pin, or "loop:index" of a cage's vertex. */
export type Mark = number | string;

/** What lies below a pointer. */
export interface Found {
  /** What can be dragged. */
  mark?: Mark;
  /** Of the ring around a pin. */
  part?: "turn" | "knob";
  /** Whether it is where the shape has got to, not where it should be. */
  reached?: boolean;
  /** Of the cage that is traced. */
  vertex?: { loop: number; index: number };
  edge?: { foot: Point };
  hole?: number;
}

/** An event for the kernel. */
export interface KernelEvent {
  type: string;
  /** Events with the same word here replace each other while they wait. */
  replaces?: string;
  [content: string]: unknown;
}

/** A widget's model, as anywidget hands it to `render`. */
export interface Model<Traits = Record<string, any>> {
  get<Name extends keyof Traits & string>(name: Name): Traits[Name];
  set(name: string, value: unknown): void;
  save_changes(): void;
  send(content: unknown, callbacks?: unknown, buffers?: ArrayBuffer[]): void;
  on(names: string, listener: (...values: any[]) => void, context?: unknown): void;
  off(
    names: string | null,
    listener?: ((...values: any[]) => void) | null,
    context?: unknown,
  ): void;
  trigger(name: string, ...values: unknown[]): void;
  widget_manager: any;
}

/** What anywidget hands to `render`; the signal ends with the view. */
export interface Context<Traits = Record<string, any>> {
  model: Model<Traits>;
  el: HTMLElement;
  signal: AbortSignal;
}
