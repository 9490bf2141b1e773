// Runs first in the page: records every map that the worker sends, and every frame that is drawn.
// `window.slowness` times as long as a turn of the worker takes, the worker then waits: a slow processor.

{
  const record = { maps: [], frames: [] };
  const Original = window.Worker;
  const slow = (slowness) => `{
    const post = globalThis.postMessage.bind(globalThis);
    const { set } = Object.getOwnPropertyDescriptor(MessagePort.prototype, "onmessage");
    Object.defineProperty(MessagePort.prototype, "onmessage", { set(turn) {
      set.call(this, (event) => {
        const began = performance.now();
        const waiting = [];
        globalThis.postMessage = (answer) => waiting.push(answer);
        turn(event);
        const end = performance.now() + ${slowness - 1} * (performance.now() - began);
        while (performance.now() < end);
        for (const answer of waiting) post(answer);
      });
    } });
  }
  `;
  window.Worker = class extends Original {
    constructor(address) {
      const code = window.glidPage.worker;
      const text = window.slowness > 1 ? slow(window.slowness) + code : code;
      super(URL.createObjectURL(new Blob([text], { type: "text/javascript" })));
      URL.revokeObjectURL(address);
      this.addEventListener("message", ({ data }) => {
        if (data.type !== "map") return;
        const { certificate, outcome, steps, took } = data;
        const { certified } = certificate;
        record.maps.push({ at: performance.now(), certified, outcome, steps, took });
      });
    }
  };
  const draw = WebGL2RenderingContext.prototype.drawElements;
  WebGL2RenderingContext.prototype.drawElements = function (...rest) {
    record.frames.push(performance.now());
    return draw.apply(this, rest);
  };
  let pressed;
  addEventListener(
    "pointerdown",
    ({ pointerId }) => {
      pressed = pointerId;
    },
    true,
  );

  /** Moves the pressed pointer from place to place, and tells what happened meanwhile. */
  window.recorded = ({ places, seconds, rate }) => {
    const start = performance.now();
    const pad = document.getElementById("pad");
    let moves = 0;
    return new Promise((resolve) => {
      const timer = setInterval(() => {
        const [clientX, clientY] = places[moves % places.length];
        const where = { clientX, clientY, pointerId: pressed, pointerType: "mouse", buttons: 1 };
        pad.dispatchEvent(new PointerEvent("pointermove", { ...where, bubbles: true }));
        moves += 1;
        const stop = performance.now();
        if (stop - start < 1000 * seconds) return;
        clearInterval(timer);
        resolve({ ...record, start, stop, moves });
      }, 1000 / rate);
    });
  };
}
