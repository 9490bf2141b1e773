"""The map in the shader agrees with NumPy, and a frame is a small message."""

from __future__ import annotations

from collections import deque
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Page

from glid_nb.energies import ENERGIES
from glid_nb.geometry import triangulate
from glid_nb.imaging import PixelFrame
from glid_nb.imaging.order import order_of
from glid_nb.page import ShaderMap, energy_defines, glsl
from glid_nb.widgets.layers import picture_texture
from glid_nb.widgets.scene import Drawing, Scene, drawing_order, energy_uniform, stacked_triangles

from ..support.domains import NAMES, domain, random_map

PICTURE = np.full((40, 40, 4), 255, np.uint8)

# Runs the canvas's own files at points z and reads the outputs back, six numbers each.
_RUN = """async ({head, main, uniforms, points}) => {
  const gl = document.createElement('canvas').getContext('webgl2');
  const text = `#version 300 es
    precision highp float;
    in vec2 z; out vec2 f; out vec2 fz; out vec2 fzb_conj;
    ${head}
    void main() { ${main} gl_Position = vec4(0); gl_PointSize = 1.0; }`;
  const program = gl.createProgram();
  const fragment = `#version 300 es
    precision highp float;
    out vec4 color;
    void main() { color = vec4(1); }`;
  const check = (done, log) => { if (!done) throw new Error(log); };
  for (const [kind, source] of [[gl.VERTEX_SHADER, text], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    check(gl.getShaderParameter(shader, gl.COMPILE_STATUS), gl.getShaderInfoLog(shader));
    gl.attachShader(program, shader);
  }
  gl.transformFeedbackVaryings(program, ['f', 'fz', 'fzb_conj'], gl.INTERLEAVED_ATTRIBS);
  gl.linkProgram(program);
  check(gl.getProgramParameter(program, gl.LINK_STATUS), gl.getProgramInfoLog(program));
  gl.useProgram(program);
  for (const [name, value] of Object.entries(uniforms)) {
    const set = value.length === 2 ? 'uniform2fv' : 'uniform4fv';
    gl[set](gl.getUniformLocation(program, name), new Float32Array(value));
  }
  const count = points.length / 2;
  gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
  gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(points), gl.STATIC_DRAW);
  const place = gl.getAttribLocation(program, 'z');
  gl.enableVertexAttribArray(place);
  gl.vertexAttribPointer(place, 2, gl.FLOAT, false, 0, 0);
  const result = gl.createBuffer();
  gl.bindBuffer(gl.TRANSFORM_FEEDBACK_BUFFER, result);
  gl.bufferData(gl.TRANSFORM_FEEDBACK_BUFFER, 24 * count, gl.STATIC_READ);
  gl.bindBufferBase(gl.TRANSFORM_FEEDBACK_BUFFER, 0, result);
  gl.enable(gl.RASTERIZER_DISCARD);
  gl.beginTransformFeedback(gl.POINTS);
  gl.drawArrays(gl.POINTS, 0, count);
  gl.endTransformFeedback();
  const out = new Float32Array(6 * count);
  gl.getBufferSubData(gl.TRANSFORM_FEEDBACK_BUFFER, 0, out);
  return Array.from(out);
}"""


def shaded_points(
    page: Page, head: str, main: str, uniforms: dict[str, Any], points: np.ndarray
) -> np.ndarray:
    """(k, 6) outputs of a shader at (k, 2) points."""
    values = {name: np.ravel(value).tolist() for name, value in uniforms.items()}
    arguments = {"head": head, "main": main, "uniforms": values, "points": points.ravel().tolist()}
    return np.reshape(page.evaluate(_RUN, arguments), (-1, 6))


@pytest.mark.browser
@pytest.mark.slow
def test_the_energies_in_the_shader_agree_with_the_python_ones(page: Page) -> None:
    """Every named energy, also MIPS, at distortions from none to strong."""
    sigma1, sigma2 = (a.ravel() for a in np.meshgrid(np.linspace(1, 3, 9), np.linspace(0.4, 1, 7)))
    points = np.stack([((sigma1 + sigma2) / 2) ** 2, ((sigma1 - sigma2) / 2) ** 2], axis=1)
    points = points.astype(np.float32)
    head = energy_defines() + glsl("energy.glsl")
    page.goto("about:blank")
    for name, kind in ENERGIES.items():
        energy = kind(*[0.3 for _ in kind.parameters()])
        main = "f = vec2(energy_density(z.x, z.y), 0.0); fz = z; fzb_conj = z;"
        seen = shaded_points(page, head, main, {"energy": energy_uniform(energy)}, points)
        exact = energy.density(*points.astype(float).T)
        np.testing.assert_allclose(seen[:, 0], exact, rtol=2e-4, atol=1e-5, err_msg=name)


def test_every_named_energy_has_a_shader_expression_of_its_own() -> None:
    shaders = [energy.shader for energy in ENERGIES.values()]
    assert all(shaders)
    assert len(set(shaders)) == len(shaders)
    numbers = [energy_uniform(energy())[0] for energy in ENERGIES.values()]
    assert numbers == list(range(len(ENERGIES)))


@pytest.mark.browser
@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_the_shader_agrees_with_numpy(page: Page, name: str) -> None:
    map_ = random_map(name, 0.3, seed=5)
    shader = ShaderMap(map_.domain)
    points = triangulate(map_.domain.cage, 1500).vertices.astype(np.float32)
    coefficients, holes = shader.coefficients(map_)
    page.goto("about:blank")
    uniforms = {"cage": shader.cage, "coefficients": coefficients, "holes": holes}
    head = shader.defines() + glsl("harmonic.glsl")
    seen = shaded_points(page, head, "harmonic_map(z, f, fz, fzb_conj);", uniforms, points)
    f, fz, fzb_conj = np.split(seen, 3, axis=1)
    exact = points.astype(float)
    np.testing.assert_allclose(f, map_(exact), atol=1e-4)
    a, b = map_.wirtinger(exact)
    np.testing.assert_allclose(fz @ [1, 1j], a, atol=2e-3)
    np.testing.assert_allclose(fzb_conj @ [1, 1j], b.conj(), atol=2e-3)


def _wire_size(widget_messages: list[Any]) -> int:
    import json

    return sum(
        len(json.dumps(data, default=str)) + sum(len(memoryview(b).cast("B")) for b in buffers)
        for data, buffers in widget_messages
    )


@pytest.mark.parametrize("n_vertices", [1_000, 100_000])
def test_a_frame_is_small_at_any_resolution(n_vertices: int, sent: list[Any]) -> None:
    from glid_nb.widgets.pane import Pane

    map_ = random_map("annulus", 0.01, seed=2)
    pane = Pane(
        PICTURE,
        map_,
        (300, 300),
        interactive=True,
        n_vertices=n_vertices,
        evaluated_in=None,
    )
    assert pane.scene.evaluated_in == "shader"
    sent.clear()
    moved = random_map("annulus", 0.01, seed=3)
    handles = np.zeros((8, 2)) + np.arange(8)[:, None]
    pane.show(Drawing(moved, targets=handles, images=handles, selected=(1,)))
    assert 0 < _wire_size(sent) < 4_000
    pane.close()


def test_the_kernel_evaluates_what_a_shader_cannot_hold(sent: list[Any]) -> None:
    map_ = random_map("annulus", 0.01, seed=2)
    frame, texture = PixelFrame(*PICTURE.shape[1::-1]), picture_texture(PICTURE)
    scene = Scene(frame, texture, map_, 500, uniform_vectors=100)
    assert scene.evaluated_in == "kernel"
    image = scene.picture.attributes["image"].array
    points = scene.picture.attributes["position"].array[:, :2]
    np.testing.assert_allclose(image, map_(points), atol=1e-5)
    moved = random_map("annulus", 0.01, seed=3)
    sent.clear()
    scene.show(Drawing(moved))
    image = scene.picture.attributes["image"].array
    np.testing.assert_allclose(image, moved(points), atol=1e-5)
    assert _wire_size(sent) > 24 * len(points)
    # A move of the pointer before the next frame is solved moves marks, not vertices.
    sent.clear()
    scene.show(Drawing(moved))
    assert _wire_size(sent) == 0
    scene.close()


def shaded(triangles: np.ndarray, remembered: int = 16) -> int:
    """How often a vertex is shaded by a cache of the last few vertices."""
    last: deque[int] = deque(maxlen=remembered)
    count = 0
    for vertex in triangles.ravel().tolist():
        if vertex not in last:
            last.append(vertex)
            count += 1
    return count


@pytest.mark.parametrize("name", ["ell", "triple"])
def test_vertices_are_shaded_little_more_than_once(name: str) -> None:
    mesh = triangulate(domain(name).cage, 4_000)
    ordered = drawing_order(mesh)
    assert sorted(map(tuple, ordered)) == sorted(map(tuple, mesh.triangles))
    assert shaded(ordered) < 1.4 * len(mesh.vertices)
    assert shaded(mesh.triangles) > 2 * shaded(ordered)


@pytest.mark.parametrize("name", ["ell", "triple"])
def test_layers_cost_few_more_vertices_and_lie_in_order(name: str) -> None:
    mesh, order = triangulate(domain(name).cage, 4_000), order_of(domain(name).cage)
    points, ordered = stacked_triangles(mesh, order)
    assert sorted(map(tuple, ordered)) == sorted(map(tuple, mesh.triangles))
    assert shaded(ordered) < 1.4 * len(mesh.vertices)
    heights = order(mesh.vertices)
    share = (heights - heights.min()) / np.ptp(heights)
    np.testing.assert_allclose(points[:, 2], 8 * share - 4, atol=1e-12)  # the camera sees 5
    rank = np.argsort(np.argsort(points[ordered, 2].mean(axis=1)))
    assert (np.maximum.accumulate(rank) - rank).max() <= len(ordered) / 8 + 1


def test_a_mesh_of_a_few_triangles_has_no_rows() -> None:
    mesh = triangulate(domain("ell").cage, 3)
    assert sorted(map(tuple, drawing_order(mesh))) == sorted(map(tuple, mesh.triangles))
