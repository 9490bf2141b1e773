// A shape that deforms in the page, without a kernel: what other modules import.

export { energyNamed } from "./energy.js";
export { distortionOf, FieldPoints } from "./fields.js";
export { Shape } from "./shape.js";
export { Solver } from "./solver.js";
export { LiveWorker, serve } from "./worker.js";
