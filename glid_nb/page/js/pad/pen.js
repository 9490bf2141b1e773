// A function that has draw(context) fill a canvas in the next frame, in the CSS pixels of a view,
// however often it is called until then.
export function painter(canvas, view, signal, draw) {
  let due = 0;
  signal.addEventListener("abort", () => cancelAnimationFrame(due));
  return () => {
    due ||= requestAnimationFrame(() => {
      due = 0;
      draw(clearedContext(canvas, view));
    });
  };
}

function clearedContext(canvas, { width, height }) {
  const ratio = window.devicePixelRatio || 1;
  const size = [Math.round(width * ratio), Math.round(height * ratio)];
  if (canvas.width !== size[0] || canvas.height !== size[1]) [canvas.width, canvas.height] = size;
  const ctx = canvas.getContext("2d");
  ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
  ctx.clearRect(0, 0, width, height);
  return ctx;
}

export function circle(ctx, [x, y], radius, styles, dash) {
  ctx.beginPath();
  ctx.arc(x, y, radius, 0, 2 * Math.PI);
  strokePath(ctx, styles, dash);
}

export function disk(ctx, place, radius, fill, stroke, width) {
  circle(ctx, place, radius, []);
  ctx.fillStyle = fill;
  ctx.fill();
  if (stroke) strokePath(ctx, [[width, stroke]]);
}

// Begins a path along lines of points, by default closed.
export function tracePath(ctx, lines, closed = true) {
  ctx.beginPath();
  for (const line of lines) {
    line.forEach(([x, y], i) => (i ? ctx.lineTo(x, y) : ctx.moveTo(x, y)));
    if (closed) ctx.closePath();
  }
}

// The corners of a rectangle between two opposite ones.
export function rectangle([left, top], [right, bottom]) {
  return [
    [left, top],
    [right, top],
    [right, bottom],
    [left, bottom],
  ];
}

// Fills the inside of lines of points, by default with their holes left out, and keeps their path.
export function fillPath(ctx, lines, style, rule = "evenodd") {
  tracePath(ctx, lines);
  ctx.fillStyle = style;
  ctx.fill(rule);
}

// Strokes the present path in widths and colours, the lowest first.
export function strokePath(ctx, styles, dash = []) {
  ctx.setLineDash(dash);
  for (const [lineWidth, strokeStyle] of styles) {
    Object.assign(ctx, { lineWidth, strokeStyle });
    ctx.stroke();
  }
  ctx.setLineDash([]);
}
