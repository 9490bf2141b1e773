// Shows a picture under a map, or plays its motion, from the data in the page.

import { Motion } from "../motion/motion.js";
import { make } from "../pad/dom.js";
import { View } from "../pad/view.js";

(async () => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const get = (id) => document.getElementById(id);
  const canvas = document.querySelector("canvas");
  const fail = (message) => Object.assign(get("problem"), { textContent: message, hidden: false });
  const gl = canvas.getContext("webgl2", {
    antialias: true,
    premultipliedAlpha: true,
    preserveDrawingBuffer: true,
  });
  if (!gl || !window.DecompressionStream)
    return fail("This page needs WebGL 2 and a browser of 2023 or later.");

  const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer;
  const unpacked = async ({ bytes: text, step }, width) => {
    // what `_packed` in page.py wrote
    const stream = new Blob([bytes(text)]).stream().pipeThrough(new DecompressionStream("deflate"));
    const packed = new Uint8Array(await new Response(stream).arrayBuffer());
    const n = packed.length / 4;
    const whole = new Int32Array(n);
    for (let i = 0; i < n; i++) {
      const folded =
        packed[i] | (packed[n + i] << 8) | (packed[2 * n + i] << 16) | (packed[3 * n + i] << 24);
      whole[i] =
        ((folded >>> 1) ^ -(folded & 1)) +
        2 * (whole[i - width] ?? 0) -
        (whole[i - 2 * width] ?? 0);
    }
    return Float32Array.from(whole, (value) => step * value);
  };
  const restored = async ({ sizes, rows, shares }, width) => {
    // what `_factored` wrote
    const few = await unpacked(rows, rows.width);
    const each = await unpacked(shares, sizes.length);
    const values = new Float64Array((each.length / sizes.length) * width);
    each.forEach((share, i) => {
      const k = i % sizes.length;
      const to = width * Math.floor(i / sizes.length);
      for (let j = 0; j < width; j++) values[to + j] += (share / sizes[k]) * few[width * k + j];
    });
    return Float32Array.from(values);
  };
  const source = await unpacked(data.source, 2);
  const count = source.length / 2;
  const wide = count > 65535;
  const rows = await restored(data.coefficients, data.width);
  const undeformed = rows.subarray(0, data.width);
  const motion = new Motion(data.motion, rows.subarray(data.width));
  const cage = new Float32Array(bytes(data.cage));
  const heights = await restored(data.heights, count);
  const layers = new Motion(
    { times: data.height_times.length ? data.height_times : [0], repeat: motion.repeat },
    heights,
  );
  const corners = await unpacked(data.triangles, 3);
  const height = ([a, b, c]) => heights[a] + heights[b] + heights[c];
  const faces = Array.from({ length: corners.length / 3 }, (_, i) =>
    [0, 1, 2].map((k) => corners[3 * i] + (k && corners[3 * i + k])),
  );
  const triangles = new (wide ? Uint32Array : Uint16Array)(
    faces.sort((a, b) => height(a) - height(b)).flat(),
  );
  const position = new Float32Array(3 * count);
  for (let i = 0; i < count; i++)
    position.set([source[2 * i], source[2 * i + 1], layers.floats[i]], 3 * i);

  const program = gl.createProgram();
  for (const [kind, text] of [
    [gl.VERTEX_SHADER, data.vertex],
    [gl.FRAGMENT_SHADER, data.fragment],
  ]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) return fail(gl.getShaderInfoLog(shader));
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) return fail(gl.getProgramInfoLog(program));
  gl.useProgram(program);
  const uniform = (name) => gl.getUniformLocation(program, name);

  const put = (target, made, values) => {
    gl.bindBuffer(target, made);
    gl.bufferData(target, values, gl.DYNAMIC_DRAW);
    return made;
  };
  const buffer = (target, values) => put(target, gl.createBuffer(), values);
  const attribute = (name, size, stride, offset) => {
    const place = gl.getAttribLocation(program, name);
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, size, gl.FLOAT, false, stride, offset);
  };
  const points = buffer(gl.ARRAY_BUFFER, position);
  attribute("position", 3, 0, 0);
  buffer(gl.ELEMENT_ARRAY_BUFFER, triangles);
  let move; // shows the map that an array stands for
  if (cage.length) {
    const blocks = ["cage", "coefficients", "holes"].map((name, i) => {
      gl.uniformBlockBinding(program, gl.getUniformBlockIndex(program, `${name}_block`), i);
      const made = buffer(gl.UNIFORM_BUFFER, cage);
      gl.bindBufferBase(gl.UNIFORM_BUFFER, i, made);
      return made;
    });
    move = (mixed) => {
      put(gl.UNIFORM_BUFFER, blocks[1], mixed.subarray(0, cage.length));
      put(gl.UNIFORM_BUFFER, blocks[2], mixed.subarray(cage.length));
    };
  } else {
    // too large for a shader: images and derivatives of the vertices
    const images = buffer(gl.ARRAY_BUFFER, undeformed);
    attribute("image", 2, 24, 0);
    attribute("derivatives", 4, 24, 8);
    move = (mixed) => put(gl.ARRAY_BUFFER, images, mixed);
  }
  gl.uniform4f(
    uniform("frame"),
    data.frame[0],
    data.frame[1],
    data.frame[2] - data.frame[0],
    data.frame[3] - data.frame[1],
  );
  gl.uniform3fv(uniform("colors"), data.colors);
  gl.uniform1f(uniform("grid_spacing"), data.grid);
  gl.enable(gl.DEPTH_TEST);
  gl.depthFunc(gl.LEQUAL);
  gl.enable(gl.BLEND);
  gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);

  const view = new View(() => draw(), { nearest: 1e-4, farthest: 100 });
  const overlay = get("overlay");
  const straight = get("source");
  const slider = get("time");
  const waiting = []; // thumbnails that are seen and not drawn yet
  let time = motion.start;

  function fit() {
    Object.assign(view, fitted(canvas.clientWidth, canvas.clientHeight));
    draw();
  }

  function fitted(width, height) {
    const [xmin, ymin, xmax, ymax] = straight.checked ? data.source_bounds : data.bounds;
    const unit = Math.max((xmax - xmin) / width, (ymax - ymin) / height) / (1 - 2 * data.margin);
    return { width, height, unit, x: (xmin + xmax) / 2, y: (ymin + ymax) / 2 };
  }

  function draw() {
    if (waiting.length) drawThumb(waiting.shift());
    paint(view);
  }

  function paint({ width: w, height: h, unit, x, y }) {
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = [Math.round(w * ratio), Math.round(h * ratio)];
    if (canvas.width !== width || canvas.height !== height)
      Object.assign(canvas, { width, height });
    gl.viewport(0, 0, width, height);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const [sx, sy] = [2 / (unit * w), 2 / (unit * h)];
    gl.uniformMatrix4fv(uniform("projectionMatrix"), false, [
      sx,
      0,
      0,
      0,
      0,
      sy,
      0,
      0,
      0,
      0,
      -1,
      0,
      -x * sx,
      -y * sy,
      0,
      1,
    ]);
    gl.uniform1f(uniform("pixel"), unit / ratio);
    gl.uniform1f(uniform("overlay"), overlay.value);
    gl.uniform2fv(uniform("color_range"), data.ranges[overlay.value] ?? [0, 1]);
    if (layers.times.length > 1) {
      layers.at(time).forEach((height, i) => {
        position[3 * i + 2] = height;
      });
      put(gl.ARRAY_BUFFER, points, position);
    }
    move(straight.checked ? undeformed : motion.at(time));
    gl.drawElements(gl.TRIANGLES, triangles.length, wide ? gl.UNSIGNED_INT : gl.UNSIGNED_SHORT, 0);
  }

  const place = (e) => [e.offsetX, e.offsetY];
  const pointers = new Map();
  canvas.addEventListener("pointerdown", (e) => {
    canvas.setPointerCapture(e.pointerId);
    pointers.set(e.pointerId, place(e));
  });
  canvas.addEventListener("pointermove", (e) => {
    if (pointers.has(e.pointerId)) view.follow(pointers, e.pointerId, place(e));
  });
  canvas.addEventListener("lostpointercapture", (e) => pointers.delete(e.pointerId));
  canvas.addEventListener("wheel", (e) => view.wheel(e, place(e)), { passive: false });
  get("fit").addEventListener("click", fit);
  straight.addEventListener("change", fit);

  // Colours for the distortion, from an isometry's value to the certified bound, or a tenth off.
  const LABELS = { 2: "Stretch σ₁", 3: "Stretch σ₂", 4: "Dilatation k" };
  const css = (i) => `rgb(${data.colors.slice(3 * i, 3 * i + 3).map((c) => Math.round(255 * c))})`;
  const stops = data.colors.length / 3;
  document.documentElement.style.setProperty(
    "--colors",
    Array.from({ length: stops }, (_, i) => css(i)).join(),
  );
  for (const value of Object.keys(data.ranges)) overlay.append(new Option(LABELS[value], value));
  const down = (x) => (Math.floor(1000 * x) / 1000).toFixed(3);
  const up = (x) => (Math.ceil(1000 * x) / 1000).toFixed(3);
  overlay.addEventListener("change", () => {
    draw();
    const { value } = overlay;
    const range = data.ranges[value];
    const legend = get("legend");
    legend.hidden = !range;
    if (!range) return;
    const end = value === "3" ? down(range[1]) : up(range[1]);
    legend.replaceChildren(`${LABELS[value]} ${range[0]}`, make("i"), end);
  });

  // What moves: the time runs by itself, or glides to a pose, or follows the slider.
  const STEP = 1 / 25;
  const GLIDE = 600; // s, ms
  const span = motion.end - motion.start;
  const play = get("play");
  const thumbs = [];
  let course = null;
  let due = 0; // `at` gives the time so many ms after it began, while it lasts

  function seek(t) {
    time = t === motion.end ? t : motion.within(t);
    slider.value = time;
    get("clock").textContent = `${time.toFixed(2)} / ${motion.end.toFixed(2)} s`;
    const { piece } = motion.place(time);
    const [low, high, k] = [motion.sigma2[piece], motion.sigma1[piece], motion.k[piece]];
    const bare = time < motion.until ? "proved not to fold" : "not proved";
    get("here").textContent =
      `Now: ${low === null ? bare : `σ₂ ≥ ${down(low)}, σ₁ ≤ ${up(high)}, k ≤ ${up(k)}`}`;
    thumbs.forEach((thumb, i) =>
      thumb.setAttribute(
        "aria-current",
        Math.abs(motion.keyframes[i] - motion.within(time)) < 1e-3,
      ),
    );
    draw();
  }

  function run(next) {
    cancelAnimationFrame(due);
    course = next && { began: performance.now(), ...next };
    if (course) due = requestAnimationFrame(tick);
    play.textContent = course?.plays ? "❚❚" : "▶";
    play.setAttribute("aria-label", course?.plays ? "Pause" : "Play");
  }

  function tick(now) {
    const { began, lasts, at } = course;
    const passed = Math.min(Math.max(now - began, 0), lasts);
    seek(at(passed));
    if (passed === lasts) run(null);
    else due = requestAnimationFrame(tick);
  }

  function playOrPause() {
    if (course?.plays) return run(null);
    const from = (!data.loop && time >= motion.end ? motion.start : time) - motion.start;
    const lasts = data.loop ? Infinity : 1000 * (span - from);
    const at = (ms) => (ms === lasts ? motion.end : motion.start + ((from + ms / 1000) % span));
    run({ plays: true, lasts, at });
  }

  // Along the motion, so that everything on the way is proved; a loop goes the shorter way round.
  function glideTo(to) {
    const last = motion.times.at(-1);
    const away = motion.repeat === "loop" ? [0, span, -span] : [0];
    const from = motion.repeat === "ping-pong" && time > last ? 2 * last - time : time;
    const far = (goal) => Math.abs(goal - from);
    const goal = away.map((shift) => to + shift).sort((a, b) => far(a) - far(b))[0];
    const eased = (s) => s * s * (3 - 2 * s);
    const at = (ms) => (ms < GLIDE ? from + eased(ms / GLIDE) * (goal - from) : goal);
    run({ lasts: GLIDE, at });
  }

  // Thumbnails that come into sight are drawn one with each frame, so that the motion does not wait for them.
  const seen = new IntersectionObserver((entries) => {
    if (!waiting.length) requestAnimationFrame(drawOn);
    for (const { target } of entries.filter((entry) => entry.isIntersecting)) {
      waiting.push(thumbs.indexOf(target));
      seen.unobserve(target);
    }
  });

  function drawOn() {
    if (!waiting.length) return;
    if (!course) draw();
    requestAnimationFrame(drawOn);
  }

  function drawThumb(i) {
    const small = thumbs[i].firstChild;
    const kept = [time, overlay.value, straight.checked];
    [time, overlay.value, straight.checked] = [motion.keyframes[i], "0", false];
    paint(fitted(56, 56));
    Object.assign(small, { width: canvas.width, height: canvas.height })
      .getContext("2d")
      .drawImage(canvas, 0, 0);
    [time, overlay.value, straight.checked] = kept;
  }

  function prepare() {
    document.querySelector("section").hidden = false;
    Object.assign(slider, { min: motion.start, max: motion.end });
    motion.keyframes.forEach((t, i) => {
      const title = `Pose ${i + 1}, at ${t.toFixed(2)} s`;
      const onclick = () => glideTo(t);
      const thumb = make("button", { title, "aria-label": title, onclick }, make("canvas"));
      thumbs.push(thumb);
      seen.observe(thumb);
    });
    get("poses").append(...thumbs);
    const colors = Array.from({ length: 100 }, (_, i) => {
      const t = motion.start + ((i + 0.5) / 100) * span;
      const sigma2 = motion.sigma2[motion.place(t).piece] ?? 0;
      return `${t < motion.until ? css(Math.round((1 - Math.min(sigma2, 1)) * (stops - 1))) : "#7f7f7f"} ${i}% ${i + 1}%`;
    });
    get("strip").style.background = `linear-gradient(to right, ${colors})`;
    play.addEventListener("click", playOrPause);
    slider.addEventListener("input", () => {
      run(null);
      seek(Number(slider.value));
    });
    document.addEventListener("keydown", (e) => {
      const control = /BUTTON|SELECT/.test(e.target.tagName) || e.target.type === "checkbox";
      const step = { ArrowLeft: -STEP, ArrowRight: STEP }[e.key] * (e.shiftKey ? 5 : 1);
      const to = { Home: motion.start, End: motion.end }[e.key] ?? time + step;
      if (
        e.ctrlKey ||
        e.metaKey ||
        e.altKey ||
        e.target.tagName === "SELECT" ||
        (e.key === " " ? control : Number.isNaN(to))
      )
        return;
      e.preventDefault();
      if (e.key === " ") return playOrPause();
      run(null);
      seek(Math.min(Math.max(to, motion.start), motion.end));
    });
    seek(motion.start);
    run(null);
    if (data.loop && !matchMedia("(prefers-reduced-motion: reduce)").matches) playOrPause();
  }

  const picture = new Image();
  picture.onerror = () => fail("The picture in this page is damaged.");
  picture.onload = () => {
    const most = gl.getParameter(gl.MAX_TEXTURE_SIZE);
    if (Math.max(picture.width, picture.height) > most)
      return fail(`This device shows pictures of at most ${most} pixels.`);
    gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    gl.pixelStorei(gl.UNPACK_PREMULTIPLY_ALPHA_WEBGL, true);
    gl.pixelStorei(gl.UNPACK_FLIP_Y_WEBGL, true);
    gl.pixelStorei(gl.UNPACK_COLORSPACE_CONVERSION_WEBGL, gl.NONE);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, picture);
    gl.generateMipmap(gl.TEXTURE_2D);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
    if (motion.keyframes.length) prepare();
    new ResizeObserver(fit).observe(canvas);
    fit();
    document.documentElement.dataset.ready = "true";
  };
  picture.src = data.picture;
})();
