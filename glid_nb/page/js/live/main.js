// The script of the worker.

import { serve } from "./worker.js";

serve(/** @type {import("./worker.js").Scope} */ (/** @type {unknown} */ (globalThis)));
