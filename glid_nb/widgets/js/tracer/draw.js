// Draws the stage: picture, cage, vertices, holes, strokes and the places of problems.

const HALO = "rgba(255, 255, 255, 0.9)";
const SPECK = 12; // CSS pixels; dropped holes smaller than this show under the pointer only
const CHECK = 8; // CSS pixels per square of the checkerboard under transparent pictures

export function drawStage(ctx, scene) {
  const { width, height, ratio, view, colors } = scene;
  ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
  ctx.clearRect(0, 0, width, height);
  if (!scene.size) return;
  const corner = view.toScreen([0, 0]);
  const extent = scene.size.map((n) => n / view.unit);
  drawChecks(ctx, colors, corner, extent, width, height);
  if (scene.bitmap) {
    ctx.imageSmoothingEnabled = 6 * view.unit > 1;
    ctx.imageSmoothingQuality = "high";
    ctx.drawImage(scene.bitmap, ...corner, ...extent);
  }
  const loops = scene.loops.map((loop) => loop.map((p) => view.toScreen(p)));
  if (loops.length && scene.veil) drawVeil(ctx, loops, colors, corner, extent);
  scene.holes.forEach((hole, i) => {
    const loop = hole.loop.map((p) => view.toScreen(p));
    const hovered = scene.hover?.hole === i;
    if (hovered) fillPath(ctx, [loop], hole.kept ? colors.warnSoft : colors.accentSoft);
    const visible = Math.sqrt(hole.area) > SPECK * view.unit;
    if (hovered || (!hole.kept && visible)) strokePath(ctx, [loop], colors.faint, 1.25, [4, 3]);
  });
  drawStrokes(ctx, scene);
  if (loops.length) drawCage(ctx, scene, loops);
  for (const problem of scene.problems) {
    if (problem.point) drawProblem(ctx, view.toScreen(problem.point), colors);
  }
}

function drawChecks(ctx, colors, [x, y], [w, h], width, height) {
  // Only the part that is seen; a picture may be zoomed in far.
  const left = Math.max(x, 0);
  const top = Math.max(y, 0);
  const right = Math.min(x + w, width);
  const bottom = Math.min(y + h, height);
  if (right <= left || bottom <= top) return;
  ctx.save();
  ctx.beginPath();
  ctx.rect(left, top, right - left, bottom - top);
  ctx.clip();
  ctx.fillStyle = colors.checkLight;
  ctx.fillRect(left, top, right - left, bottom - top);
  ctx.fillStyle = colors.checkDark;
  for (let j = Math.floor(top / CHECK); j * CHECK < bottom; j++) {
    for (let i = Math.floor(left / CHECK) + ((Math.floor(left / CHECK) + j) & 1); i * CHECK < right; i += 2) {
      ctx.fillRect(i * CHECK, j * CHECK, CHECK, CHECK);
    }
  }
  ctx.restore();
}

function tracePath(ctx, loops) {
  ctx.beginPath();
  for (const loop of loops) {
    loop.forEach(([x, y], i) => (i ? ctx.lineTo(x, y) : ctx.moveTo(x, y)));
    ctx.closePath();
  }
}

function fillPath(ctx, loops, style) {
  tracePath(ctx, loops);
  ctx.fillStyle = style;
  ctx.fill("evenodd");
}

function strokePath(ctx, loops, style, width, dash = []) {
  ctx.lineJoin = "round";
  tracePath(ctx, loops);
  ctx.strokeStyle = HALO;
  ctx.lineWidth = width + 2.25;
  ctx.stroke();
  ctx.setLineDash(dash);
  ctx.strokeStyle = style;
  ctx.lineWidth = width;
  ctx.stroke();
  ctx.setLineDash([]);
}

// What lies outside the cage steps back.
function drawVeil(ctx, loops, colors, [x, y], [w, h]) {
  tracePath(ctx, loops);
  ctx.rect(x, y, w, h);
  ctx.fillStyle = colors.veil;
  ctx.fill("evenodd");
}

function drawStrokes(ctx, scene) {
  if (!scene.showStrokes) return;
  const { view, strokes: { foreground, background } } = scene;
  const pairs = [
    [background, scene.colors.background],
    [foreground, scene.colors.foreground],
  ];
  if (scene.stroke) pairs.push([[scene.stroke.points], scene.colors[scene.stroke.brush]]);
  ctx.lineCap = ctx.lineJoin = "round";
  for (const [strokes, color] of pairs) {
    for (const stroke of strokes) {
      ctx.beginPath();
      stroke.forEach((p, i) => {
        const [x, y] = view.toScreen(p);
        if (i) ctx.lineTo(x, y);
        else ctx.moveTo(x, y);
      });
      if (stroke.length === 1) ctx.lineTo(...view.toScreen(stroke[0]));
      ctx.strokeStyle = HALO;
      ctx.lineWidth = 8;
      ctx.stroke();
      ctx.strokeStyle = color;
      ctx.lineWidth = 5;
      ctx.stroke();
    }
  }
}

function drawCage(ctx, scene, loops) {
  const { colors, hover, selected } = scene;
  const color = scene.problems.length ? colors.warn : colors.accent;
  strokePath(ctx, loops, color, 1.75);
  if (!scene.showVertices) return;
  const radius = vertexRadius(loops);
  loops.forEach((loop, i) =>
    loop.forEach(([x, y], j) => {
      const chosen = selected.has(`${i}:${j}`);
      const hovered = hover?.vertex?.loop === i && hover.vertex.index === j;
      const r = hovered || chosen ? radius + 1.75 : radius;
      ctx.beginPath();
      ctx.arc(x, y, r + 1, 0, 2 * Math.PI);
      ctx.fillStyle = HALO;
      ctx.fill();
      ctx.beginPath();
      ctx.arc(x, y, r, 0, 2 * Math.PI);
      ctx.fillStyle = chosen || hovered ? color : "white";
      ctx.fill();
      ctx.strokeStyle = color;
      ctx.lineWidth = 1.5;
      ctx.stroke();
    }),
  );
  if (hover?.edge) drawPlus(ctx, scene.view.toScreen(hover.edge.foot), color);
}

// Smaller where vertices are close together on the stage.
function vertexRadius(loops) {
  let total = 0;
  let count = 0;
  for (const loop of loops) {
    loop.forEach(([x, y], i) => {
      const [u, v] = loop[(i + 1) % loop.length];
      total += Math.hypot(u - x, v - y);
      count++;
    });
  }
  return Math.min(4, Math.max(1.75, (total / Math.max(count, 1)) * 0.16));
}

function drawPlus(ctx, [x, y], color) {
  ctx.beginPath();
  ctx.arc(x, y, 7, 0, 2 * Math.PI);
  ctx.fillStyle = "white";
  ctx.fill();
  ctx.strokeStyle = color;
  ctx.lineWidth = 1.5;
  ctx.stroke();
  ctx.beginPath();
  ctx.moveTo(x - 3.5, y);
  ctx.lineTo(x + 3.5, y);
  ctx.moveTo(x, y - 3.5);
  ctx.lineTo(x, y + 3.5);
  ctx.stroke();
}

function drawProblem(ctx, [x, y], colors) {
  for (const [style, width] of [
    [HALO, 5],
    [colors.warn, 2.25],
  ]) {
    ctx.beginPath();
    ctx.arc(x, y, 13, 0, 2 * Math.PI);
    ctx.strokeStyle = style;
    ctx.lineWidth = width;
    ctx.stroke();
  }
}
