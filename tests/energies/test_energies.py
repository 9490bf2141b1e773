"""Isometric energies and their five scalars (paper Section 6, Table 1, Appendix E)."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from glid_nb._features import enable_x64
from glid_nb.energies import (
    AMIPS,
    ARAP,
    ENERGIES,
    MIPS,
    CustomEnergy,
    Energy,
    EnergyError,
    ExponentialSymmetricDirichlet,
    SymmetricDirichlet,
    by_name,
)

# The second column of Table 1, in singular values, written independently of the energies.


def iso(a: Any, b: Any) -> Any:
    return (a**2 + a**-2 + b**2 + b**-2) / 2


def amips(a: Any, b: Any, s: float) -> Any:
    return np.exp(s * (a / b + b / a) + a * b + 1 / (a * b))


CLOSED: list[tuple[Energy, Callable[[Any, Any], Any]]] = [
    (SymmetricDirichlet(), iso),
    (ExponentialSymmetricDirichlet(0.3), lambda a, b: np.exp(0.3 * iso(a, b))),
    (ExponentialSymmetricDirichlet(2.0), lambda a, b: np.exp(2 * iso(a, b))),
    (AMIPS(1.0), lambda a, b: amips(a, b, 1.0)),
    (AMIPS(0.25), lambda a, b: amips(a, b, 0.25)),
    (ARAP(), lambda a, b: (a - 1) ** 2 + (b - 1) ** 2),
    (MIPS(), lambda a, b: (a / b + b / a) / 2),
]
IDS = [f"{e.name}-{getattr(e, 's', '')}" for e, _ in CLOSED]
COUNT = 16


@functools.cache
def compiled(method: str) -> Callable[..., Any]:
    return jax.jit(lambda energy, x, y: getattr(energy, method)(x, y))


@functools.cache
def automatic(function: Callable[[Any, Any], Any]) -> Callable[..., Any]:
    gradient = jax.grad(function, argnums=(0, 1))
    hessian = jax.hessian(function, argnums=(0, 1))
    return jax.jit(jax.vmap(lambda x, y: (gradient(x, y), hessian(x, y))))


@functools.cache
def density_of(energy: Energy) -> Callable[[Any, Any], Any]:
    return lambda x, y: energy.density(x, y)


def squares(sigma1: Any, sigma2: Any) -> tuple[np.ndarray, np.ndarray]:
    """x = |f_z|^2 and y = |f_zbar|^2 of singular values."""
    a, b = np.broadcast_arrays(sigma1, sigma2)
    return ((a + b) / 2) ** 2, ((a - b) / 2) ** 2


# Singular values sigma_2 <= sigma_1 = sigma_2 * ratio; a ratio of 1 is y = 0.
samples = st.lists(
    st.tuples(st.floats(-0.7, 0.7), st.one_of(st.just(0.0), st.floats(-8, 1))),
    min_size=COUNT,
    max_size=COUNT,
)


def singular_values(drawn: list[tuple[float, float]]) -> tuple[np.ndarray, np.ndarray]:
    exponent, ratio = np.array(drawn).T
    sigma2 = 10.0**exponent
    # Ratios between 1 and 3.
    return sigma2 * (1 + 2 * np.where(ratio == 0, 0, 10.0 ** np.minimum(ratio, 0))), sigma2


@pytest.mark.parametrize(("energy", "formula"), CLOSED, ids=IDS)
@given(drawn=samples)
@settings(max_examples=15)
def test_densities_are_those_of_the_singular_values(
    energy: Energy, formula: Callable[[Any, Any], Any], drawn: list[tuple[float, float]]
) -> None:
    sigma1, sigma2 = singular_values(drawn)
    x, y = squares(sigma1, sigma2)
    expected = formula(sigma1, sigma2)
    with enable_x64():
        got = np.asarray(compiled("density")(energy, x, y))
    # Exponentials magnify the rounding of their arguments.
    tolerance = 1e-11 * np.maximum(1, np.log(np.maximum(expected, 1)))
    np.testing.assert_array_less(np.abs(got - expected), tolerance * (expected + 1e-3))


@pytest.mark.parametrize(("energy", "formula"), CLOSED, ids=IDS)
def test_numbers_are_evaluated_in_double_precision(
    energy: Energy, formula: Callable[[Any, Any], Any]
) -> None:
    """The bug: JAX evaluated numbers, and arrays of NumPy, in 32 bits."""
    x, y = squares(1.4, 0.8)
    expected = formula(1.4, 0.8)
    for one in (energy, CustomEnergy(energy.density)):
        for kind in (float, np.asarray, np.atleast_1d):
            value = np.asarray(one.density(kind(x), kind(y)))
            assert value.dtype == np.float64
            np.testing.assert_allclose(value, expected, rtol=1e-14)
    for value in energy.differentials(float(x), float(y)):
        assert np.asarray(value).dtype == np.float64
    single = jnp.asarray([x], jnp.float32)
    assert energy.density(single, single / 9).dtype == jnp.float32  # an array of JAX keeps its type


def test_no_two_energies_are_one_to_a_compiled_program() -> None:
    """jit finds its programs by the structure of the trees.

    Another class has another structure; another value of a parameter has not.
    """
    one_each = {type(energy): energy for energy, _ in CLOSED}
    one_each[CustomEnergy] = CustomEnergy(lambda x, y: x + y)
    structures = [jax.tree.structure(energy) for energy in one_each.values()]
    for i, one in enumerate(structures):
        assert [one == other for other in structures] == [i == j for j in range(len(structures))]
    assert jax.tree.structure(AMIPS(1.0)) == jax.tree.structure(AMIPS(0.25))


@pytest.mark.slow
@pytest.mark.parametrize("energy", [e for e, _ in CLOSED], ids=IDS)
@given(drawn=samples)
@settings(max_examples=15)
def test_alphas_and_betas_are_the_derivatives(
    energy: Energy, drawn: list[tuple[float, float]]
) -> None:
    x, y = squares(*singular_values(drawn))
    with enable_x64():
        got = compiled("differentials")(energy, x, y)
        (dx, dy), ((dxx, dxy), (dyx, dyy)) = automatic(density_of(energy))(x, y)
    for value, expected, scale in (
        (got.alpha1, dx, np.abs(dx) + np.abs(dy)),
        (got.alpha2, dy, np.abs(dx) + np.abs(dy)),
        (got.beta1, dxx, np.abs(dxx) + np.abs(dyy)),
        (got.beta2, dyy, np.abs(dxx) + np.abs(dyy)),
        (got.beta3, dxy, np.abs(dxx) + np.abs(dyy)),
        (got.beta3, dyx, np.abs(dxx) + np.abs(dyy)),
    ):
        error = np.abs(np.asarray(value) - np.asarray(expected))
        assert (error <= 1e-10 * np.asarray(scale)).all()


@pytest.mark.parametrize("energy", [e for e, _ in CLOSED], ids=IDS)
@pytest.mark.parametrize("gap", [1e-1, 1e-2])
def test_near_degenerate_samples(energy: Energy, gap: float) -> None:
    """x - y is small and exactly representable, so the test measures the formulas' own
    precision."""
    x = np.full(COUNT, 1.0) + np.arange(COUNT) / 8
    gap = 2.0 ** np.round(np.log2(gap))
    y = x - gap
    with enable_x64():
        density = np.asarray(compiled("density")(energy, x, y))
        got = compiled("differentials")(energy, x, y)
        (dx, dy), ((dxx, dxy), (_, dyy)) = automatic(density_of(energy))(x, y)
    finite = np.isfinite(density) & (density < 1e280)
    assert finite.any() or isinstance(energy, ExponentialSymmetricDirichlet)
    for value, expected in zip(got, (dx, dy, dxx, dyy, dxy), strict=True):
        np.testing.assert_allclose(
            np.asarray(value)[finite], np.asarray(expected)[finite], rtol=1e-9, atol=1e-10
        )


FORMULAS: list[tuple[Energy, Callable[[Any, Any], Any]]] = [
    (SymmetricDirichlet(), lambda x, y: (x + y) * (1 + 1 / (x - y) ** 2)),
    (
        ExponentialSymmetricDirichlet(0.7),
        lambda x, y: jnp.exp(0.7 * (x + y) * (1 + 1 / (x - y) ** 2)),
    ),
    (AMIPS(0.5), lambda x, y: jnp.exp((2 * 0.5 * (x + y) + 1) / (x - y) + x - y)),
    (ARAP(), lambda x, y: 2 * (x + y) - 4 * jnp.sqrt(x) + 2),
]


@pytest.mark.slow
@pytest.mark.parametrize(("energy", "formula"), FORMULAS, ids=[e.name for e, _ in FORMULAS])
def test_a_custom_energy_of_the_same_formula_is_the_same(
    energy: Energy, formula: Callable[[Any, Any], Any]
) -> None:
    custom = CustomEnergy(formula)
    assert custom.name == "custom"
    x, y = squares(np.linspace(0.8, 2.2, COUNT), np.linspace(0.8, 0.6, COUNT))
    with enable_x64():
        np.testing.assert_allclose(
            compiled("density")(custom, x, y), compiled("density")(energy, x, y), rtol=1e-12
        )
        got, expected = (compiled("differentials")(e, x, y) for e in (custom, energy))
    for value, other in zip(got, expected, strict=True):
        np.testing.assert_allclose(value, other, rtol=1e-10, atol=1e-12)


def test_a_custom_energy_may_be_unsymmetric_and_of_any_sign() -> None:
    custom = CustomEnergy(lambda x, y: jnp.sin(x) * y - x * y**3)
    x, y = np.linspace(0.5, 2, COUNT), np.linspace(0, 0.4, COUNT)
    with enable_x64():
        d = compiled("differentials")(custom, x, y)
    expected = (
        np.cos(x) * y - y**3,
        np.sin(x) - 3 * x * y**2,
        -np.sin(x) * y,
        -6 * x * y,
        np.cos(x) - 3 * y**2,
    )
    for value, other in zip(d, expected, strict=True):
        np.testing.assert_allclose(value, other, rtol=1e-12, atol=1e-14)


# MIPS is least at every conformal map, isometric or not.
@pytest.mark.parametrize("energy", [e for e, _ in CLOSED[:-1]], ids=IDS[:-1])
def test_the_isometry_is_a_minimum(energy: Energy) -> None:
    """In the singular values: stationary at (1, 1), and no neighbour is lower."""
    sigma1, sigma2 = (a.ravel() for a in np.meshgrid([0.9, 1, 1.1, 1.3], [0.7, 0.8, 0.9, 1]))
    x, y = squares(sigma1, sigma2)
    with enable_x64():
        at_isometry = float(energy.density(np.ones(1), np.zeros(1))[0])
        around = np.asarray(compiled("density")(energy, x, y))
    assert (around[(sigma1 != 1) | (sigma2 != 1)] > at_isometry).all()


@pytest.mark.parametrize(
    ("energy", "value"),
    [
        (SymmetricDirichlet(), 2.0),
        (ExponentialSymmetricDirichlet(1.5), math.exp(3.0)),
        (AMIPS(2.0), math.exp(6.0)),
        (MIPS(), 1.0),
        (ARAP(), 0.0),
    ],
    ids=list(ENERGIES),
)
def test_values_at_the_isometry(energy: Energy, value: float) -> None:
    with enable_x64():
        assert float(energy.density(np.ones(1), np.zeros(1))[0]) == pytest.approx(value, rel=1e-14)


def test_a_sharper_energy_runs_the_same_program() -> None:
    traced = []

    @jax.jit
    def density(energy: Energy, x: jax.Array, y: jax.Array) -> jax.Array:
        traced.append(energy)
        return energy.density(x, y)

    with enable_x64():
        for s in (0.5, 1.0, 2.0):
            value = density(AMIPS(s), np.array([1.5]), np.array([0.2]))
            assert float(value[0]) == pytest.approx(math.exp((2 * s * 1.7 + 1) / 1.3 + 1.3))
    assert len(traced) == 1


def test_energies_are_values() -> None:
    assert SymmetricDirichlet() == SymmetricDirichlet()
    assert AMIPS(2) == AMIPS(2.0) != AMIPS(1)
    with pytest.raises(AttributeError):
        AMIPS(2).s = 3  # type: ignore[misc]


def test_energies_by_name() -> None:
    assert list(ENERGIES) == ["iso", "exp", "amips", "mips", "arap"]
    assert [by_name(name).name for name in ENERGIES] == list(ENERGIES)
    assert by_name("exp") == ExponentialSymmetricDirichlet(1.0)
    assert by_name("exp", 3) == ExponentialSymmetricDirichlet(3.0)
    assert by_name("amips", 0.5) == AMIPS(0.5)
    assert by_name("iso", 4.0) == SymmetricDirichlet()


@pytest.mark.parametrize("name", ["", "ISO", "dirichlet", None, 3])
def test_unknown_names_are_refused(name: object) -> None:
    with pytest.raises(EnergyError, match=r"unknown energy .*iso, exp, amips, mips, arap"):
        by_name(name)  # type: ignore[arg-type]


@pytest.mark.parametrize("make", [ExponentialSymmetricDirichlet, AMIPS])
@pytest.mark.parametrize(
    "s", [0, 0.0, -1, -1e-9, math.nan, math.inf, -math.inf, True, "1", None, np.float64(-2)]
)
def test_bad_sharpness_is_refused(make: Callable[[Any], Energy], s: object) -> None:
    with pytest.raises(EnergyError, match=r"s of the energy '(exp|amips)' must be"):
        make(s)


@pytest.mark.parametrize("s", [np.array(-1.0), [1.0], 1j], ids=["array", "list", "complex"])
def test_what_is_no_number_is_refused_as_sharpness(s: object) -> None:
    with pytest.raises(EnergyError, match="s of the energy 'amips' must be"):
        AMIPS(s)  # type: ignore[arg-type]


@pytest.mark.parametrize("function", [None, 3, "x + y"])
def test_a_custom_energy_must_be_callable(function: object) -> None:
    with pytest.raises(EnergyError, match="function E"):
        CustomEnergy(function)  # type: ignore[arg-type]


def test_a_custom_energy_must_be_finite_at_the_isometry() -> None:
    """As its docstring says."""
    with pytest.raises(EnergyError, match="isometry"):
        CustomEnergy(lambda x, y: x / y)


@pytest.mark.parametrize(
    "function", [lambda x: x, lambda x, y: jnp.stack([x, y])], ids=["one argument", "two values"]
)
def test_a_custom_energy_of_another_form_is_refused(function: Any) -> None:
    with pytest.raises(EnergyError, match=r"must be a function E\(x, y\) of two numbers"):
        CustomEnergy(function)
