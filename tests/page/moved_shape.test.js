// A shape of a canvas, moved by its maps.

import assert from "node:assert/strict";
import { test } from "node:test";
import { MovedShape } from "../../glid_nb/page/js/canvas/moved_shape.js";

/** @param {number} size of the uniforms' arrays, in vectors */
function drawn(size = 2) {
  const uniforms = {
    cage: { value: new Array(size) },
    coefficients: { value: new Float32Array() },
    holes: { value: new Array(1) },
  };
  const position = {
    array: Float32Array.of(1, 2, 0.5, 3, 4, -0.5),
    count: 2,
    version: -1,
    setArray(/** @type {Float32Array<ArrayBuffer>} */ array) {
      this.array = array;
    },
  };
  const material = { uniforms };
  const geometry = { attributes: { position }, userData: {} };
  return { obj: material, mesh: { material, geometry, name: "", visible: true } };
}

test("a map reaches the shape's own materials only", () => {
  const [own, other] = [drawn(), drawn()];
  const shape = new MovedShape();
  shape.materials = [own];
  const floats = Float32Array.of(1, 2, 3);
  shape.move([other.mesh, own.mesh], floats, false);
  assert.deepEqual([...own.obj.uniforms.coefficients.value], [1, 2]);
  assert.deepEqual([...own.obj.uniforms.holes.value], [3]);
  assert.equal(other.obj.uniforms.coefficients.value.length, 0);
});

test("a map of another size waits for its materials", () => {
  const own = drawn(5);
  const shape = new MovedShape();
  shape.materials = [own];
  shape.move([own.mesh], Float32Array.of(1, 2, 3), false);
  assert.equal(own.obj.uniforms.coefficients.value.length, 0);
});

test("a motion's heights go, and the kernel's return, for whichever view of the shape", () => {
  const [own, other] = [drawn(), drawn()];
  const shape = new MovedShape();
  shape.materials = [own];
  const meshes = [other.mesh, own.mesh];
  const { position } = own.mesh.geometry.attributes;
  const before = position.array;
  shape.lift(meshes, Float32Array.of(7, 8));
  assert.deepEqual([...position.array], [1, 2, 7, 3, 4, 8]);
  assert.ok(position.version > 0); // three.js takes it, also after pythreejs has set it back
  const later = new MovedShape(); // as after a press on another shape
  later.materials = [own];
  later.lift(meshes, null);
  assert.equal(position.array, before);
  assert.deepEqual([...before], [1, 2, 0.5, 3, 4, -0.5]);
  assert.deepEqual([...other.mesh.geometry.attributes.position.array], [1, 2, 0.5, 3, 4, -0.5]);
});
