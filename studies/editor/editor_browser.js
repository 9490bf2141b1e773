// Runs first in the page. Records pointers, drawn frames and received bytes.

window.glid = {
  press: null,
  moves: [],
  frames: [],
  bytes: 0,
  canvasBytes: 0,
  firstFrame: null,
  delay: 0, // ms of the kernel's replies
  solvers: 0, // of the page, that are ready
};

{
  const { glid } = window;
  const ID_WITHIN = 4096; // the first bytes of a message, which name its widget
  let waiting = []; // functions to call with the time of the next drawn frame
  let widgets = [];

  const now = () => performance.now();
  const noteDrawing = () => {
    if (!waiting.length && glid.firstFrame !== null) return;
    const told = waiting;
    waiting = [];
    // The frame is complete when the next one begins.
    requestAnimationFrame(() => {
      glid.firstFrame ??= now();
      for (const tell of told) tell(now());
    });
  };
  for (const kind of [WebGLRenderingContext, WebGL2RenderingContext]) {
    const draw = kind.prototype.drawElements;
    kind.prototype.drawElements = function (...rest) {
      noteDrawing();
      return draw.apply(this, rest);
    };
  }

  addEventListener(
    "pointerdown",
    (e) => {
      glid.press = [e.clientX, e.clientY];
    },
    { capture: true },
  );
  addEventListener(
    "pointermove",
    (e) => {
      if (e.buttons) glid.moves.push([e.timeStamp, e.clientX, e.clientY]);
    },
    { capture: true },
  );

  const size = (data) => data.byteLength ?? data.length;
  const text = (data) =>
    typeof data === "string"
      ? data
      : new TextDecoder("latin1").decode(new Uint8Array(data, 0, Math.min(ID_WITHIN, size(data))));
  window.WebSocket = class extends WebSocket {
    constructor(...rest) {
      super(...rest);
      this.addEventListener("message", ({ data }) => {
        glid.bytes += size(data);
        const start = text(data);
        if (widgets.some((id) => start.includes(id))) glid.canvasBytes += size(data);
      });
    }
    set onmessage(act) {
      super.onmessage = (e) => {
        if (glid.delay) setTimeout(() => act.call(this, e), glid.delay);
        else act.call(this, e);
      };
    }
  };

  // Records when each map of the page's own solver was drawn, with the target that it was solved for.
  window.Worker = class extends Worker {
    constructor(...rest) {
      super(...rest);
      this.aims = new Map();
      this.addEventListener("message", ({ data }) => {
        if (data.type === "ready") glid.solvers += 1;
        const target = data.type === "map" && this.aims.get(data.id);
        if (target) waiting.push((time) => glid.frames.push([time, target]));
      });
    }
    postMessage(request) {
      if (request.type === "drag") this.aims.set(request.id, request.pose.targets.at(-1));
      super.postMessage(request);
    }
  };

  // Records when each change of a model's trait was drawn, with a sample that identifies it.
  glid.watch = (model, trait, count, identities) => {
    widgets = identities;
    model.on(`change:${trait}`, () => {
      const value = model.get(trait);
      const { buffer, byteOffset, byteLength } = value.data ?? value;
      const numbers = new Uint32Array(buffer.slice(byteOffset, byteOffset + byteLength));
      const stride = Math.max(1, Math.floor(numbers.length / count));
      const sample = Array.from({ length: count }, (_, i) => numbers[i * stride]).filter(
        (n) => n !== undefined,
      );
      waiting.push((time) => glid.frames.push([time, sample]));
    });
  };

  glid.clear = () => {
    const counts = { bytes: 0, canvasBytes: 0 };
    Object.assign(glid, { press: null, moves: [], frames: [], firstFrame: null, ...counts });
  };

  glid.seen = () => {
    const { press, moves, frames, bytes, canvasBytes } = glid;
    return { press, moves, frames, bytes, canvasBytes };
  };

  // Whether the last drawn frame is the one with this sample.
  glid.drawn = (sample) => {
    const [, last] = glid.frames.at(-1) ?? [0, []];
    return last.length === sample.length && last.every((n, i) => n === sample[i]);
  };

  // Runs code in a cell, and returns when that began.
  glid.runCell = (index, code) => {
    const { content } = window.jupyterapp.shell.currentWidget;
    content.model.cells.get(index).sharedModel.setSource(code);
    glid.clear();
    content.activeCellIndex = index;
    const start = performance.now();
    window.jupyterapp.commands.execute("notebook:run-cell");
    return start;
  };
}
