// How long the page takes to draw.

const N_TIMED = 3; // drawings, after a first one that compiles the shaders

const nextFrame = () => new Promise((go) => requestAnimationFrame(go));

// Milliseconds of the quickest of some drawings, 0 where there is nothing to draw on.
export async function drawingTime(pad, shapes) {
  const times = [];
  for (let i = 0; i <= N_TIMED; i++) {
    shapes.redraw(); // the renderer draws in the next frame, before what is below
    await nextFrame();
    const canvas = pad.closest(".glid-pane")?.querySelector(".jupyter-threejs canvas");
    const gl = canvas && (canvas.getContext("webgl") || canvas.getContext("webgl2"));
    if (!gl) continue;
    const start = performance.now();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4)); // waits for all of it
    times.push(performance.now() - start);
  }
  const quickest = Math.min(...times.slice(1));
  return Number.isFinite(quickest) ? quickest : 0;
}
