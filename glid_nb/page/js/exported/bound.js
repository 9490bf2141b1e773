// What one of several renderers has bound in the WebGL context that they share.

const BLOCKS = [0, 1, 2]; // of uniforms, as the renderer binds them

/** What the renderer of one shape has bound in the context. */
export class Bound {
  #gl;
  #array;
  /** @type {WebGLProgram | null} */
  #program = null;
  /** @type {WebGLTexture | null} */
  #texture = null;
  /** @type {(WebGLBuffer | null)[]} */
  #blocks = [];

  /** @param {WebGL2RenderingContext} gl what is bound from now on is the shape's */
  constructor(gl) {
    this.#gl = gl;
    this.#array = gl.createVertexArray();
    gl.bindVertexArray(this.#array);
  }

  /** Notes what is bound now. */
  note() {
    const gl = this.#gl;
    this.#program = gl.getParameter(gl.CURRENT_PROGRAM);
    this.#texture = gl.getParameter(gl.TEXTURE_BINDING_2D);
    this.#blocks = BLOCKS.map((i) => gl.getIndexedParameter(gl.UNIFORM_BUFFER_BINDING, i));
  }

  /** Binds it again. */
  restore() {
    const gl = this.#gl;
    gl.bindVertexArray(this.#array);
    gl.useProgram(this.#program);
    gl.bindTexture(gl.TEXTURE_2D, this.#texture);
    for (const i of BLOCKS) gl.bindBufferBase(gl.UNIFORM_BUFFER, i, this.#blocks[i]);
  }
}
