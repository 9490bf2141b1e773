// Draws the picture under a map, by WebGL 2 and the canvas's shaders.

/** @import { PageData, PartData } from "./data.js" */

/**
 * The mesh of the picture.
 *
 * @typedef {object} Mesh
 * @property {Float32Array} source (x, y) of its vertices
 * @property {Float32Array} heights of its vertices
 * @property {[number, number, number][]} triangles
 */

/**
 * What does not change: the shaders, the picture's place, and the colours.
 *
 * @typedef {Pick<PageData, "fragment" | "frame" | "colors" | "grid" | "ranges"> &
 *   Pick<PartData, "vertex">} Shown
 */

/**
 * What is drawn once.
 *
 * @typedef {object} Frame
 * @property {number} width CSS pixels
 * @property {number} height
 * @property {number} unit world units per CSS pixel
 * @property {number} x the centre
 * @property {number} y
 * @property {string} overlay the number of what the colours say, as in picture.frag
 * @property {Float32Array} coefficients of the map
 * @property {Float32Array | null} heights of the vertices, where they move
 * @property {number} [sharpness] pixels per pixel of the display, along a side; 1 if not given
 * @property {boolean} [above] whether it covers what is drawn already, which stays
 */

const FLOAT = 4; // bytes

/** Why the page cannot show its picture, in words for the reader. */
export class CannotShow extends Error {}

export class Renderer {
  /** @type {WebGL2RenderingContext} */
  #gl;
  #program;
  #position;
  #count; // of the triangles' corners
  #index; // their type
  #points;
  /** @type {Record<string, WebGLUniformLocation | null>} */
  #uniforms = {};
  /** @type {(coefficients: Float32Array) => void} shows the map that an array stands for */
  #move;
  #frame;

  /**
   * @param {HTMLCanvasElement} canvas
   * @param {WebGL2RenderingContext} gl
   * @param {Shown} data
   * @param {Mesh} mesh
   * @param {Float32Array} cage empty where a shader cannot hold it
   */
  constructor(canvas, gl, data, mesh, cage) {
    this.canvas = canvas;
    this.ranges = data.ranges;
    this.#gl = gl;
    this.#program = linked(gl, data.vertex, data.fragment);
    gl.useProgram(this.#program);
    this.#position = positions(mesh);
    this.#points = this.#buffer(gl.ARRAY_BUFFER, this.#position);
    this.#attribute("position", 3, 0, 0);
    const corners = inOrder(mesh).flat();
    const many = mesh.heights.length > 65535;
    this.#count = corners.length;
    this.#index = many ? gl.UNSIGNED_INT : gl.UNSIGNED_SHORT;
    this.#buffer(gl.ELEMENT_ARRAY_BUFFER, new (many ? Uint32Array : Uint16Array)(corners));
    this.#move = cage.length ? this.#movedByShader(cage) : this.#movedByBuffer();
    this.#frame = data.frame;
    const [left, bottom, right, top] = data.frame;
    gl.uniform4f(this.#uniform("frame"), left, bottom, right - left, top - bottom);
    gl.uniform3fv(this.#uniform("colors"), data.colors);
    gl.uniform1f(this.#uniform("grid_spacing"), data.grid);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
  }

  /** @param {HTMLImageElement} picture */
  setPicture(picture) {
    const gl = this.#gl;
    const most = gl.getParameter(gl.MAX_TEXTURE_SIZE);
    if (Math.max(picture.width, picture.height) > most) {
      throw new CannotShow(`This device shows pictures of at most ${most} pixels.`);
    }
    gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    gl.pixelStorei(gl.UNPACK_PREMULTIPLY_ALPHA_WEBGL, true);
    gl.pixelStorei(gl.UNPACK_FLIP_Y_WEBGL, true);
    gl.pixelStorei(gl.UNPACK_COLORSPACE_CONVERSION_WEBGL, gl.NONE);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, picture);
    gl.generateMipmap(gl.TEXTURE_2D);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
  }

  /** @param {Frame} frame */
  draw({ width, height, unit, x, y, overlay, coefficients, heights, sharpness = 1, above }) {
    const gl = this.#gl;
    const ratio = (window.devicePixelRatio || 1) * sharpness;
    this.#resize(Math.round(width * ratio), Math.round(height * ratio));
    gl.clear(gl.DEPTH_BUFFER_BIT | (above ? 0 : gl.COLOR_BUFFER_BIT));
    const projection = projectionMatrix(width, height, unit, x, y);
    gl.uniformMatrix4fv(this.#uniform("projectionMatrix"), false, projection);
    gl.uniform1f(this.#uniform("pixel"), unit / ratio);
    gl.uniform1f(this.#uniform("overlay"), Number(overlay));
    gl.uniform2fv(this.#uniform("color_range"), this.ranges[overlay] ?? [0, 1]);
    if (heights) this.#lift(heights);
    this.#move(coefficients);
    gl.drawElements(gl.TRIANGLES, this.#count, this.#index, 0);
    // The style sheet of a page may give the canvas a picture to lie behind.
    const [left, bottom, right, top] = this.#frame;
    const { style } = this.canvas;
    style.backgroundSize = `${(right - left) / unit}px ${(top - bottom) / unit}px`;
    style.backgroundPosition = `${(left - x) / unit + width / 2}px ${(y - top) / unit + height / 2}px`;
  }

  /**
   * @param {number} width pixels
   * @param {number} height
   */
  #resize(width, height) {
    const { canvas } = this;
    if (canvas.width !== width || canvas.height !== height) {
      canvas.width = width;
      canvas.height = height;
    }
    this.#gl.viewport(0, 0, width, height);
  }

  /** @param {Float32Array} heights */
  #lift(heights) {
    heights.forEach((height, i) => {
      this.#position[3 * i + 2] = height;
    });
    this.#put(this.#gl.ARRAY_BUFFER, this.#points, this.#position);
  }

  /** @param {Float32Array} cage */
  #movedByShader(cage) {
    const gl = this.#gl;
    const [, coefficients, holes] = ["cage", "coefficients", "holes"].map((name, i) => {
      const block = gl.getUniformBlockIndex(this.#program, `${name}_block`);
      gl.uniformBlockBinding(this.#program, block, i);
      const buffer = this.#buffer(gl.UNIFORM_BUFFER, cage);
      gl.bindBufferBase(gl.UNIFORM_BUFFER, i, buffer);
      return buffer;
    });
    return (/** @type {Float32Array} */ mixed) => {
      this.#put(gl.UNIFORM_BUFFER, coefficients, mixed.subarray(0, cage.length));
      this.#put(gl.UNIFORM_BUFFER, holes, mixed.subarray(cage.length));
    };
  }

  // The arrays hold images and derivatives of the vertices.
  #movedByBuffer() {
    const gl = this.#gl;
    const images = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, images);
    this.#attribute("image", 2, 6 * FLOAT, 0);
    this.#attribute("derivatives", 4, 6 * FLOAT, 2 * FLOAT);
    return (/** @type {Float32Array} */ mixed) => this.#put(gl.ARRAY_BUFFER, images, mixed);
  }

  /** @param {string} name */
  #uniform(name) {
    this.#uniforms[name] ??= this.#gl.getUniformLocation(this.#program, name);
    return this.#uniforms[name];
  }

  /**
   * Takes an attribute from the buffer that is bound.
   *
   * @param {string} name
   * @param {number} size
   * @param {number} stride bytes
   * @param {number} offset bytes
   */
  #attribute(name, size, stride, offset) {
    const gl = this.#gl;
    const place = gl.getAttribLocation(this.#program, name);
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, size, gl.FLOAT, false, stride, offset);
  }

  /**
   * @param {number} target
   * @param {AllowSharedBufferSource} values
   */
  #buffer(target, values) {
    /** @type {WebGLBuffer} */
    const buffer = this.#gl.createBuffer();
    this.#put(target, buffer, values);
    return buffer;
  }

  /**
   * @param {number} target
   * @param {WebGLBuffer} buffer
   * @param {AllowSharedBufferSource} values
   */
  #put(target, buffer, values) {
    this.#gl.bindBuffer(target, buffer);
    this.#gl.bufferData(target, values, this.#gl.DYNAMIC_DRAW);
  }
}

/**
 * @param {WebGL2RenderingContext} gl
 * @param {string} vertex
 * @param {string} fragment
 */
function linked(gl, vertex, fragment) {
  const program = gl.createProgram();
  gl.attachShader(program, compiled(gl, gl.VERTEX_SHADER, vertex));
  gl.attachShader(program, compiled(gl, gl.FRAGMENT_SHADER, fragment));
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
    throw new CannotShow(gl.getProgramInfoLog(program) ?? "The shaders do not fit together.");
  }
  return program;
}

/**
 * @param {WebGL2RenderingContext} gl
 * @param {number} kind
 * @param {string} text
 */
function compiled(gl, kind, text) {
  const shader = gl.createShader(kind);
  if (!shader) throw new CannotShow("The graphics card was lost.");
  gl.shaderSource(shader, text);
  gl.compileShader(shader);
  if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) {
    throw new CannotShow(gl.getShaderInfoLog(shader) ?? "A shader does not compile.");
  }
  return shader;
}

/**
 * (x, y, height) of the vertices.
 *
 * @param {Mesh} mesh
 */
function positions({ source, heights }) {
  const count = source.length / 2;
  const position = new Float32Array(3 * count);
  for (let i = 0; i < count; i++) {
    position.set([source[2 * i], source[2 * i + 1], heights[i]], 3 * i);
  }
  return position;
}

/**
 * The triangles, the lowest first.
 *
 * @param {Mesh} mesh
 */
export function inOrder({ heights, triangles }) {
  const height = (/** @type {number[]} */ [a, b, c]) => heights[a] + heights[b] + heights[c];
  return [...triangles].sort((a, b) => height(a) - height(b));
}

/**
 * @param {number} width CSS pixels
 * @param {number} height
 * @param {number} unit world units per CSS pixel
 * @param {number} x the centre
 * @param {number} y
 */
export function projectionMatrix(width, height, unit, x, y) {
  const sx = 2 / (unit * width);
  const sy = 2 / (unit * height);
  return [sx, 0, 0, 0, 0, sy, 0, 0, 0, 0, -1, 0, -x * sx, -y * sy, 0, 1];
}
