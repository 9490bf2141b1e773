"use strict";
(() => {
  // motion/motion.js
  var Motion = class {
    // values: plain JSON; floats: a Float32Array of the arrays of all knots, one after the other.
    constructor(values, floats) {
      Object.assign(this, values);
      this.floats = floats;
      this.mixed = new Float32Array(floats.length / this.times.length);
    }
    get start() {
      return this.times[0];
    }
    get end() {
      const last = this.times.at(-1);
      return this.repeat === "ping-pong" ? 2 * last - this.start : last;
    }
    // The time from start to end that shows what any time shows: loops and ping-pongs go on for ever.
    within(time) {
      const { start, end } = this;
      if (this.repeat === "once") return Math.min(Math.max(time, start), end);
      const span = end - start;
      return start + ((time - start) % span + span) % span;
    }
    // The piece between two knots at a time, and the share of it that has passed.
    place(time) {
      const { times } = this;
      let t = this.within(time);
      if (t > times.at(-1)) t = 2 * times.at(-1) - t;
      const next = times.findIndex((knot, i) => i && t < knot);
      const high = next < 0 ? times.length - 1 : next, low = high - 1;
      return { piece: low, share: (t - times[low]) / (times[high] - times[low]) };
    }
    // The array at a time. Every call returns the same one, with other numbers.
    at(time) {
      const { piece, share } = this.place(time);
      const { floats, mixed } = this, n = mixed.length, from = piece * n, to = from + n;
      for (let i = 0; i < n; i++) mixed[i] = (1 - share) * floats[from + i] + share * floats[to + i];
      return mixed;
    }
  };

  // pad/dom.js
  function make(tag, properties = {}, ...children) {
    const element = document.createElement(tag);
    if (tag === "button") element.type = "button";
    for (const [name, value] of Object.entries(properties)) {
      if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
      else if (name in element && name !== "list") element[name] = value;
      else element.setAttribute(name, value);
    }
    element.append(...children);
    return element;
  }

  // pad/view.js
  var WHEEL_SPEED = 15e-4;
  var WHEEL_LINE = 33;
  var distance = ([x, y], [u, v]) => Math.hypot(x - u, y - v);
  var View = class {
    // up: 1 if the world's y points up, -1 if down. changed(): called after every change.
    constructor(changed, { up = 1, nearest, farthest }) {
      Object.assign(this, { changed, up, nearest, farthest });
      Object.assign(this, { x: 0, y: 0, unit: 1, width: 0, height: 0 });
    }
    toWorld([px, py]) {
      const { x, y, unit, up } = this;
      return [x + (px - this.width / 2) * unit, y - up * (py - this.height / 2) * unit];
    }
    toScreen([x, y]) {
      const { unit, up } = this;
      return [(x - this.x) / unit + this.width / 2, up * (this.y - y) / unit + this.height / 2];
    }
    line(points) {
      return points.map((point) => this.toScreen(point));
    }
    pan(dx, dy) {
      this.x -= dx * this.unit;
      this.y += this.up * dy * this.unit;
      this.changed();
    }
    // Zooms about a place on the screen, by default its middle.
    zoom(factor, place = [this.width / 2, this.height / 2]) {
      const [x, y] = this.toWorld(place);
      const unit = Math.min(this.farthest, Math.max(this.nearest, this.unit * factor));
      this.x = x + (this.x - x) * (unit / this.unit);
      this.y = y + (this.y - y) * (unit / this.unit);
      this.unit = unit;
      this.changed();
    }
    // A pinch on a touchpad is a wheel with Ctrl.
    wheel(e, place) {
      e.preventDefault();
      const step = e.deltaMode === WheelEvent.DOM_DELTA_LINE ? e.deltaY * WHEEL_LINE : e.deltaY;
      this.zoom(Math.exp(step * WHEEL_SPEED * (e.ctrlKey ? 5 : 1)), place);
    }
    // Follows one of the pressed pointers, whose last places are known; two of them zoom as well.
    follow(pointers, id, place) {
      const before = pointers.get(id), other = [...pointers].find(([one]) => one !== id)?.[1];
      const share = other ? 0.5 : 1;
      pointers.set(id, place);
      this.pan(share * (place[0] - before[0]), share * (place[1] - before[1]));
      if (!other) return;
      const apart = (one) => Math.max(distance(one, other), 1);
      this.zoom(apart(before) / apart(place), [(place[0] + other[0]) / 2, (place[1] + other[1]) / 2]);
    }
  };

  // exported/main.js
  (async () => {
    "use strict";
    const data = JSON.parse(document.getElementById("data").textContent);
    const get = (id) => document.getElementById(id);
    const canvas = document.querySelector("canvas");
    const fail = (message) => Object.assign(get("problem"), { textContent: message, hidden: false });
    const gl = canvas.getContext("webgl2", { antialias: true, premultipliedAlpha: true, preserveDrawingBuffer: true });
    if (!gl || !window.DecompressionStream) return fail("This page needs WebGL 2 and a browser of 2023 or later.");
    const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer;
    const unpacked = async ({ bytes: text, step }, width) => {
      const stream = new Blob([bytes(text)]).stream().pipeThrough(new DecompressionStream("deflate"));
      const packed = new Uint8Array(await new Response(stream).arrayBuffer());
      const n = packed.length / 4, whole = new Int32Array(n);
      for (let i = 0; i < n; i++) {
        const folded = packed[i] | packed[n + i] << 8 | packed[2 * n + i] << 16 | packed[3 * n + i] << 24;
        whole[i] = (folded >>> 1 ^ -(folded & 1)) + 2 * (whole[i - width] ?? 0) - (whole[i - 2 * width] ?? 0);
      }
      return Float32Array.from(whole, (value) => step * value);
    };
    const restored = async ({ sizes, rows: rows2, shares }, width) => {
      const few = await unpacked(rows2, rows2.width), each = await unpacked(shares, sizes.length);
      const values = new Float64Array(each.length / sizes.length * width);
      each.forEach((share, i) => {
        const k = i % sizes.length, to = width * Math.floor(i / sizes.length);
        for (let j = 0; j < width; j++) values[to + j] += share / sizes[k] * few[width * k + j];
      });
      return Float32Array.from(values);
    };
    const source = await unpacked(data.source, 2), count = source.length / 2, wide = count > 65535;
    const rows = await restored(data.coefficients, data.width);
    const undeformed = rows.subarray(0, data.width), motion = new Motion(data.motion, rows.subarray(data.width));
    const cage = new Float32Array(bytes(data.cage)), heights = await restored(data.heights, count);
    const layers = new Motion({ times: data.height_times.length ? data.height_times : [0], repeat: motion.repeat }, heights);
    const corners = await unpacked(data.triangles, 3), height = ([a, b, c]) => heights[a] + heights[b] + heights[c];
    const faces = Array.from({ length: corners.length / 3 }, (_, i) => [0, 1, 2].map((k) => corners[3 * i] + (k && corners[3 * i + k])));
    const triangles = new (wide ? Uint32Array : Uint16Array)(faces.sort((a, b) => height(a) - height(b)).flat());
    const position = new Float32Array(3 * count);
    for (let i = 0; i < count; i++) position.set([source[2 * i], source[2 * i + 1], layers.floats[i]], 3 * i);
    const program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, data.vertex], [gl.FRAGMENT_SHADER, data.fragment]]) {
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
      const place2 = gl.getAttribLocation(program, name);
      gl.enableVertexAttribArray(place2);
      gl.vertexAttribPointer(place2, size, gl.FLOAT, false, stride, offset);
    };
    const points = buffer(gl.ARRAY_BUFFER, position);
    attribute("position", 3, 0, 0);
    buffer(gl.ELEMENT_ARRAY_BUFFER, triangles);
    let move;
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
      const images = buffer(gl.ARRAY_BUFFER, undeformed);
      attribute("image", 2, 24, 0);
      attribute("derivatives", 4, 24, 8);
      move = (mixed) => put(gl.ARRAY_BUFFER, images, mixed);
    }
    gl.uniform4f(uniform("frame"), data.frame[0], data.frame[1], data.frame[2] - data.frame[0], data.frame[3] - data.frame[1]);
    gl.uniform3fv(uniform("colors"), data.colors);
    gl.uniform1f(uniform("grid_spacing"), data.grid);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    const view = new View(() => draw(), { nearest: 1e-4, farthest: 100 });
    const overlay = get("overlay"), straight = get("source"), slider = get("time");
    const waiting = [];
    let time = motion.start;
    function fit() {
      Object.assign(view, fitted(canvas.clientWidth, canvas.clientHeight));
      draw();
    }
    function fitted(width, height2) {
      const [xmin, ymin, xmax, ymax] = straight.checked ? data.source_bounds : data.bounds;
      const unit = Math.max((xmax - xmin) / width, (ymax - ymin) / height2) / (1 - 2 * data.margin);
      return { width, height: height2, unit, x: (xmin + xmax) / 2, y: (ymin + ymax) / 2 };
    }
    function draw() {
      if (waiting.length) drawThumb(waiting.shift());
      paint(view);
    }
    function paint({ width: w, height: h, unit, x, y }) {
      const ratio = window.devicePixelRatio || 1;
      const [width, height2] = [Math.round(w * ratio), Math.round(h * ratio)];
      if (canvas.width !== width || canvas.height !== height2) Object.assign(canvas, { width, height: height2 });
      gl.viewport(0, 0, width, height2);
      gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
      const [sx, sy] = [2 / (unit * w), 2 / (unit * h)];
      gl.uniformMatrix4fv(uniform("projectionMatrix"), false, [sx, 0, 0, 0, 0, sy, 0, 0, 0, 0, -1, 0, -x * sx, -y * sy, 0, 1]);
      gl.uniform1f(uniform("pixel"), unit / ratio);
      gl.uniform1f(uniform("overlay"), overlay.value);
      gl.uniform2fv(uniform("color_range"), data.ranges[overlay.value] ?? [0, 1]);
      if (layers.times.length > 1) {
        layers.at(time).forEach((height3, i) => {
          position[3 * i + 2] = height3;
        });
        put(gl.ARRAY_BUFFER, points, position);
      }
      move(straight.checked ? undeformed : motion.at(time));
      gl.drawElements(gl.TRIANGLES, triangles.length, wide ? gl.UNSIGNED_INT : gl.UNSIGNED_SHORT, 0);
    }
    const place = (e) => [e.offsetX, e.offsetY], pointers = /* @__PURE__ */ new Map();
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
    const LABELS = { 2: "Stretch σ₁", 3: "Stretch σ₂", 4: "Dilatation k" };
    const css = (i) => `rgb(${data.colors.slice(3 * i, 3 * i + 3).map((c) => Math.round(255 * c))})`;
    const stops = data.colors.length / 3;
    document.documentElement.style.setProperty("--colors", Array.from({ length: stops }, (_, i) => css(i)).join());
    for (const value of Object.keys(data.ranges)) overlay.append(new Option(LABELS[value], value));
    const down = (x) => (Math.floor(1e3 * x) / 1e3).toFixed(3), up = (x) => (Math.ceil(1e3 * x) / 1e3).toFixed(3);
    overlay.addEventListener("change", () => {
      draw();
      const { value } = overlay, range = data.ranges[value], legend = get("legend");
      legend.hidden = !range;
      if (!range) return;
      const end = value === "3" ? down(range[1]) : up(range[1]);
      legend.replaceChildren(`${LABELS[value]} ${range[0]}`, make("i"), end);
    });
    const STEP = 1 / 25, GLIDE = 600;
    const span = motion.end - motion.start, play = get("play"), thumbs = [];
    let course = null, due = 0;
    function seek(t) {
      time = t === motion.end ? t : motion.within(t);
      slider.value = time;
      get("clock").textContent = `${time.toFixed(2)} / ${motion.end.toFixed(2)} s`;
      const { piece } = motion.place(time);
      const [low, high, k] = [motion.sigma2[piece], motion.sigma1[piece], motion.k[piece]];
      const bare = time < motion.until ? "proved not to fold" : "not proved";
      get("here").textContent = `Now: ${low === null ? bare : `σ₂ ≥ ${down(low)}, σ₁ ≤ ${up(high)}, k ≤ ${up(k)}`}`;
      thumbs.forEach((thumb, i) => thumb.setAttribute("aria-current", Math.abs(motion.keyframes[i] - motion.within(time)) < 1e-3));
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
      const { began, lasts, at } = course, passed = Math.min(Math.max(now - began, 0), lasts);
      seek(at(passed));
      if (passed === lasts) run(null);
      else due = requestAnimationFrame(tick);
    }
    function playOrPause() {
      if (course?.plays) return run(null);
      const from = (!data.loop && time >= motion.end ? motion.start : time) - motion.start;
      const lasts = data.loop ? Infinity : 1e3 * (span - from);
      const at = (ms) => ms === lasts ? motion.end : motion.start + (from + ms / 1e3) % span;
      run({ plays: true, lasts, at });
    }
    function glideTo(to) {
      const last = motion.times.at(-1), away = motion.repeat === "loop" ? [0, span, -span] : [0];
      const from = motion.repeat === "ping-pong" && time > last ? 2 * last - time : time;
      const far = (goal2) => Math.abs(goal2 - from);
      const goal = away.map((shift) => to + shift).sort((a, b) => far(a) - far(b))[0];
      const eased = (s) => s * s * (3 - 2 * s);
      const at = (ms) => ms < GLIDE ? from + eased(ms / GLIDE) * (goal - from) : goal;
      run({ lasts: GLIDE, at });
    }
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
      const small = thumbs[i].firstChild, kept = [time, overlay.value, straight.checked];
      [time, overlay.value, straight.checked] = [motion.keyframes[i], "0", false];
      paint(fitted(56, 56));
      Object.assign(small, { width: canvas.width, height: canvas.height }).getContext("2d").drawImage(canvas, 0, 0);
      [time, overlay.value, straight.checked] = kept;
    }
    function prepare() {
      document.querySelector("section").hidden = false;
      Object.assign(slider, { min: motion.start, max: motion.end });
      motion.keyframes.forEach((t, i) => {
        const title = `Pose ${i + 1}, at ${t.toFixed(2)} s`, onclick = () => glideTo(t);
        const thumb = make("button", { title, "aria-label": title, onclick }, make("canvas"));
        thumbs.push(thumb);
        seen.observe(thumb);
      });
      get("poses").append(...thumbs);
      const colors = Array.from({ length: 100 }, (_, i) => {
        const t = motion.start + (i + 0.5) / 100 * span, sigma2 = motion.sigma2[motion.place(t).piece] ?? 0;
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
        if (e.ctrlKey || e.metaKey || e.altKey || e.target.tagName === "SELECT" || (e.key === " " ? control : isNaN(to))) return;
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
      if (Math.max(picture.width, picture.height) > most) return fail(`This device shows pictures of at most ${most} pixels.`);
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
})();
