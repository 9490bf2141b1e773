"""Cholesky's factorisation by LAPACK's own memory order, against NumPy's and JAX's."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import jax
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from glid_nb._runtime import double_precision
from glid_nb.solvers import cholesky

WAYS = ["direct", "portable"]


@pytest.fixture(params=WAYS)
def way(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Two ways to the same result. The first one is the CPU's."""
    if request.param == "portable":
        monkeypatch.setattr(cholesky, "lapack_in_place", lambda: False)


def definite(size: int, seed: int) -> np.ndarray:
    rows = np.random.default_rng(seed).normal(size=(size, size))
    return rows @ rows.T + 0.1 * np.eye(size)


def compiled(function: Callable[..., Any]) -> Callable[..., Any]:
    # A new function, so that each way is traced anew.
    return jax.jit(lambda *arguments: function(*arguments))


def test_this_jax_calls_lapack_as_we_do() -> None:
    """If this fails, the copies are back: look at JAX's lowered text, and repair the module."""
    assert cholesky.lapack_in_place()


@pytest.mark.slow
@pytest.mark.usefixtures("way")
@pytest.mark.parametrize("size", [1, 2, 37, 130])
@double_precision
def test_factor_and_solution(size: int) -> None:
    h, b = definite(size, size), np.arange(1.0, size + 1)
    # Only the upper half is read.
    factor = compiled(cholesky.factorise)(np.triu(h))
    np.testing.assert_allclose(np.diag(factor), np.diag(np.linalg.cholesky(h)), rtol=1e-9)
    x = compiled(cholesky.solve)(factor, b)
    np.testing.assert_allclose(x, np.linalg.solve(h, b), rtol=1e-8)


@pytest.mark.slow
@given(st.integers(2, 20), st.integers(0, 2**32 - 1))
@settings(max_examples=15, deadline=None)
@double_precision
def test_an_indefinite_matrix_shows_in_the_last_entry(size: int, seed: int) -> None:
    h = definite(size, seed)
    place = seed % size
    h[place, place] = -1.0
    assert np.isnan(cholesky.factorise(jax.numpy.asarray(h))[-1, -1])


@pytest.mark.usefixtures("way")
@double_precision
def test_the_matrix_that_is_factored_stays_as_it_is() -> None:
    h = jax.numpy.asarray(definite(8, 1))
    before = np.array(h)
    compiled(cholesky.factorise)(h)
    np.testing.assert_array_equal(h, before)


@pytest.mark.usefixtures("way")
@double_precision
def test_many_at_once() -> None:
    h = np.stack([definite(9, seed) for seed in range(4)])
    h[2, 3, 3] = -1.0
    b = np.random.default_rng(5).normal(size=(4, 9))

    def both(h: Any, b: Any) -> Any:
        factor = cholesky.factorise(h)
        return factor, cholesky.solve(factor, b)

    factor, x = compiled(jax.vmap(both))(h, b)
    assert np.isnan(factor[:, -1, -1]).tolist() == [False, False, True, False]
    for i in (0, 1, 3):
        np.testing.assert_allclose(x[i], np.linalg.solve(h[i], b[i]), rtol=1e-9)
