"""A domain's maps in the form that shaders take."""

from __future__ import annotations

import numpy as np
import pytest

from glid_nb.page import ShaderMap, vertex_shader

from ..support.domains import NAMES, domain, random_map


def test_the_chain_holds_every_loop_closed() -> None:
    shader = ShaderMap(domain("twin"))
    loops = domain("twin").offset_cage.loops_complex
    assert shader.n_chain == sum(map(len, loops)) + len(loops)
    starts = np.flatnonzero(~shader.cage[:, 2:].any(axis=1))
    assert len(starts) == len(loops)
    for start, loop in zip(starts, loops, strict=True):
        chain = shader.cage[start : start + len(loop) + 1, :2] @ [1, 1j]
        np.testing.assert_allclose(chain, [loop[-1], *loop], atol=1e-6)


@pytest.mark.parametrize("name", NAMES)
def test_no_uniform_looks_like_a_matrix(name: str) -> None:
    """pythreejs takes lists of 2, 3, 4, 9 and 16 numbers for vectors and matrices."""
    map_ = random_map(name, 0.1, seed=1)
    for uniform in ShaderMap(map_.domain).uniforms(map_).values():
        assert len(uniform["value"]) not in (2, 3, 4, 9, 16)


def test_the_wire_is_both_arrays_of_coefficients() -> None:
    map_ = random_map("twin", 0.1, seed=1)
    shader = ShaderMap(map_.domain)
    chain, holes = shader.coefficients(map_)
    wire = np.frombuffer(shader.wire(map_), "<f4")
    np.testing.assert_array_equal(wire, np.concatenate([chain.ravel(), holes.ravel()]))
    assert chain.shape == shader.cage.shape


def test_the_shader_is_told_how_long_its_arrays_are() -> None:
    shader = ShaderMap(domain("twin"))
    text = vertex_shader("picture", shader)
    assert f"#define N_CHAIN {shader.n_chain}\n" in text
    assert f"#define N_HOLES {shader.n_holes}\n" in text
    assert text.count("void harmonic_map(") == 1


def test_a_shader_that_holds_the_domain_needs_both_arrays() -> None:
    shader = ShaderMap(domain("ell"))
    assert shader.fits(10_000)
    assert not shader.fits(2 * shader.n_chain)
