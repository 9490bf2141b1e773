// Shows a textured mesh, deformed or not, from the data in the page.
"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const canvas = document.querySelector("canvas");
  const fail = (message) => {
    const problem = document.getElementById("problem");
    problem.textContent = message;
    problem.hidden = false;
  };
  const gl = canvas.getContext("webgl2", { antialias: true, premultipliedAlpha: true, preserveDrawingBuffer: true });
  if (!gl) return fail("This page needs WebGL 2, which this browser does not offer.");

  const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer;
  const floats = (text) => new Float32Array(bytes(text));
  const triangles = new Uint32Array(bytes(data.triangles));

  const compile = (kind, text) => {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, `#version 300 es\n${text}`);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    return shader;
  };
  const program = gl.createProgram();
  gl.attachShader(program, compile(gl.VERTEX_SHADER, `
    in vec2 position; in vec2 place; in float height; out vec2 uv; uniform vec2 scale; uniform vec2 shift;
    void main() { uv = place; gl_Position = vec4(position * scale + shift, -height, 1.0); }`));
  gl.attachShader(program, compile(gl.FRAGMENT_SHADER, `
    precision highp float; in vec2 uv; out vec4 color; uniform sampler2D picture; uniform vec4 line;
    void main() {
      color = line.a > 0.0 ? vec4(line.rgb * line.a, line.a) : texture(picture, uv);
      if (color.a < 0.004) discard; // it must not hide what is behind
    }`));
  gl.bindAttribLocation(program, 0, "position");
  gl.bindAttribLocation(program, 1, "place");
  gl.bindAttribLocation(program, 2, "height");
  gl.linkProgram(program);
  gl.useProgram(program);
  const uniform = (name) => gl.getUniformLocation(program, name);

  const buffer = (target, values) => {
    const made = gl.createBuffer();
    gl.bindBuffer(target, made);
    gl.bufferData(target, values, gl.STATIC_DRAW);
    return made;
  };
  const deformed = buffer(gl.ARRAY_BUFFER, floats(data.deformed));
  const source = buffer(gl.ARRAY_BUFFER, floats(data.source));
  buffer(gl.ARRAY_BUFFER, floats(data.texture));
  gl.enableVertexAttribArray(1);
  gl.vertexAttribPointer(1, 2, gl.FLOAT, false, 0, 0);
  buffer(gl.ARRAY_BUFFER, floats(data.heights));
  gl.enableVertexAttribArray(2);
  gl.vertexAttribPointer(2, 1, gl.FLOAT, false, 0, 0);
  gl.enableVertexAttribArray(0);
  const faces = buffer(gl.ELEMENT_ARRAY_BUFFER, triangles);
  const lines = edgesOf(triangles);
  const edges = buffer(gl.ELEMENT_ARRAY_BUFFER, lines);
  gl.depthFunc(gl.LEQUAL);
  gl.enable(gl.BLEND);
  gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);

  function edgesOf(t) {
    const found = new Map();
    for (let i = 0; i < t.length; i += 3) {
      for (const [a, b] of [[t[i], t[i + 1]], [t[i + 1], t[i + 2]], [t[i + 2], t[i]]]) {
        found.set(Math.min(a, b) * 2 ** 32 + Math.max(a, b), [a, b]);
      }
    }
    return new Uint32Array([...found.values()].flat());
  }

  const view = { scale: 1, x: 0, y: 0 }; // CSS pixels per world unit; the world's point in the middle
  const boxes = { mesh: document.getElementById("mesh"), source: document.getElementById("source") };

  function fit() {
    const [xmin, ymin, xmax, ymax] = boxes.source.checked ? data.source_bounds : data.bounds;
    view.x = (xmin + xmax) / 2;
    view.y = (ymin + ymax) / 2;
    const { clientWidth: w, clientHeight: h } = canvas;
    view.scale = (1 - 2 * data.margin) * Math.min(w / (xmax - xmin), h / (ymax - ymin));
    draw();
  }

  function draw() {
    const { clientWidth: w, clientHeight: h } = canvas;
    const ratio = window.devicePixelRatio || 1;
    canvas.width = Math.round(w * ratio);
    canvas.height = Math.round(h * ratio);
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    const [sx, sy] = [(2 * view.scale) / w, (2 * view.scale) / h];
    gl.uniform2f(uniform("scale"), sx, sy);
    gl.uniform2f(uniform("shift"), -view.x * sx, -view.y * sy);
    gl.bindBuffer(gl.ARRAY_BUFFER, boxes.source.checked ? source : deformed);
    gl.vertexAttribPointer(0, 2, gl.FLOAT, false, 0, 0);
    gl.uniform4f(uniform("line"), 0, 0, 0, 0);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, faces);
    gl.drawElements(gl.TRIANGLES, triangles.length, gl.UNSIGNED_INT, 0); // the lower ones first
    if (!boxes.mesh.checked) return;
    gl.disable(gl.DEPTH_TEST);
    gl.uniform4f(uniform("line"), 0, 0.45, 0.7, 0.45);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, edges);
    gl.drawElements(gl.LINES, lines.length, gl.UNSIGNED_INT, 0);
  }

  function zoom(factor, clientX, clientY) {
    const box = canvas.getBoundingClientRect();
    const dx = clientX - box.left - box.width / 2;
    const dy = box.height / 2 - (clientY - box.top);
    const scale = Math.min(Math.max(view.scale * factor, 1e-2), 1e4);
    view.x += dx / view.scale - dx / scale;
    view.y += dy / view.scale - dy / scale;
    view.scale = scale;
    draw();
  }

  const pointers = new Map();
  canvas.addEventListener("pointerdown", (e) => {
    canvas.setPointerCapture(e.pointerId);
    pointers.set(e.pointerId, [e.clientX, e.clientY]);
  });
  canvas.addEventListener("pointermove", (e) => {
    const before = pointers.get(e.pointerId);
    if (!before) return;
    const other = [...pointers].find(([id]) => id !== e.pointerId)?.[1];
    pointers.set(e.pointerId, [e.clientX, e.clientY]);
    const share = other ? 0.5 : 1; // two fingers move the picture by their mean
    view.x -= (share * (e.clientX - before[0])) / view.scale;
    view.y += (share * (e.clientY - before[1])) / view.scale;
    if (other) {
      const apart = (p) => Math.max(Math.hypot(p[0] - other[0], p[1] - other[1]), 1);
      zoom(apart([e.clientX, e.clientY]) / apart(before), (e.clientX + other[0]) / 2, (e.clientY + other[1]) / 2);
    } else draw();
  });
  for (const name of ["pointerup", "pointercancel"]) {
    canvas.addEventListener(name, (e) => pointers.delete(e.pointerId));
  }
  canvas.addEventListener("wheel", (e) => {
    e.preventDefault();
    zoom(Math.exp(-e.deltaY * 0.0015), e.clientX, e.clientY);
  }, { passive: false });
  document.getElementById("fit").addEventListener("click", fit);
  boxes.mesh.addEventListener("change", draw);
  boxes.source.addEventListener("change", fit);

  const picture = new Image();
  picture.onerror = () => fail("The picture in this page is damaged.");
  picture.onload = () => {
    const most = gl.getParameter(gl.MAX_TEXTURE_SIZE);
    if (Math.max(picture.width, picture.height) > most) return fail(`This device shows pictures of at most ${most} pixels.`);
    gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    gl.pixelStorei(gl.UNPACK_PREMULTIPLY_ALPHA_WEBGL, true);
    gl.pixelStorei(gl.UNPACK_COLORSPACE_CONVERSION_WEBGL, gl.NONE);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, picture);
    gl.generateMipmap(gl.TEXTURE_2D);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
    new ResizeObserver(fit).observe(canvas);
    fit();
    document.documentElement.dataset.ready = "true";
  };
  picture.src = data.picture;
})();
