"""Displacement fields: every sign against rational numbers, and what cannot be read."""

from __future__ import annotations

import itertools
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

import glid_nb as glid

pytestmark = pytest.mark.slow

Array = NDArray[Any]


def corner_determinants(
    field: Array, spacing: tuple[float, float] = (1, 1)
) -> dict[Any, list[Fraction]]:
    """The four corners of every cell, in rational numbers, from the positions of its pixels."""
    h, w = field.shape[:2]
    step = [Fraction(one) for one in spacing]

    def place(i: int, j: int) -> tuple[Fraction, Fraction]:
        dx, dy = (Fraction(one.item()) for one in field[i, j])
        return j * step[0] + dx, i * step[1] + dy

    found = {}
    for i, j in itertools.product(range(h - 1), range(w - 1)):
        (a, b), (c, d) = [[place(i + k, j + m) for m in (0, 1)] for k in (0, 1)]
        along = [(b[0] - a[0], b[1] - a[1]), (d[0] - c[0], d[1] - c[1])]
        up = [(c[0] - a[0], c[1] - a[1]), (d[0] - b[0], d[1] - b[1])]
        unit = step[0] * step[1]
        found[i, j] = [(p[0] * q[1] - p[1] * q[0]) / unit for p in along for q in up]
    return found


def check(field: Array, spacing: tuple[float, float] = (1, 1)) -> glid.Audit:
    """The audit, after a comparison with rational numbers."""
    audit = glid.audit(field, spacing=spacing)
    exact = {cell: min(values) for cell, values in corner_determinants(field, spacing).items()}
    least = min(exact.values())
    wanted = "folds" if least < 0 else ("collapses" if least == 0 else "proved")
    assert audit.verdict == wanted
    signs = {cell: (value > 0) - (value < 0) for cell, value in exact.items()}
    assert {cell: audit.signs[cell] for cell in signs} == signs
    assert audit.folded == list(signs.values()).count(-1)
    if abs(least) > Fraction(2) ** -1000 and abs(least) < Fraction(2) ** 1000:
        assert audit.smallest == pytest.approx(float(least), rel=1e-12)
    assert (audit.determinant is not None) == (audit.point is not None) == (least < 0)
    if wanted == "proved":
        assert audit.lower_bound is not None
        assert 0 <= Fraction(audit.lower_bound) <= least
    return audit


FINITE = st.floats(allow_nan=False, allow_infinity=False)
NEAR = st.sampled_from([0.0, 1.0, -1.0, 0.5, -0.5, 1 - 2**-53, 1 + 2**-52, 5e-324, -1e-310])
SMALL = st.floats(-3, 3)


@st.composite
def fields(draw: st.DrawFn) -> Array:
    h, w = draw(st.integers(2, 4)), draw(st.integers(2, 4))
    one = draw(st.sampled_from([FINITE, NEAR, SMALL]))
    numbers = draw(st.lists(one, min_size=2 * h * w, max_size=2 * h * w))
    field = np.array(numbers).reshape(h, w, 2)
    kind: Any = draw(st.sampled_from([np.float64, np.float32, np.float16, np.int32]))
    with np.errstate(all="ignore"):
        limit = 1e9 if kind is np.int32 else np.finfo(kind).max
        return np.clip(field, -limit, limit).astype(kind)


# The least denominators of the folded area overflow where they do not count.
_LEAST_STEP = np.zeros((3, 4, 2))
_LEAST_STEP[1, 2, 1], _LEAST_STEP[2, 1], _LEAST_STEP[2, 2] = 1, (5e-324, -0.5), (-1, -0.5)


@given(fields())
@example(_LEAST_STEP)
@settings(max_examples=80)
def test_every_sign_is_that_of_rational_numbers(field: Array) -> None:
    check(field)


@given(fields(), st.floats(1e-8, 1e8), st.floats(1e-8, 1e8), st.sampled_from([-1, 1]))
@settings(max_examples=40)
def test_with_steps_between_pixels_too(field: Array, sx: float, sy: float, sign: int) -> None:
    check(field.astype(np.float64), (sx, sign * sy))


@pytest.mark.parametrize("scale", [1e-8, 1e-3, 1.0, 1e3, 1e8])
def test_at_every_scale(scale: float) -> None:
    rng = np.random.default_rng(3)
    field = scale * rng.normal(size=(5, 6, 2))
    check(field, (scale, scale))
    check(field)
    check(0.1 * field, (scale, scale))


def test_nearly_collapsed_cells() -> None:
    """Floating signs of these are wrong: the determinants are a few units of the last place."""
    rng = np.random.default_rng(4)
    y, x = np.mgrid[:6, :6]
    slope, signs = 0.1, set()
    for _ in range(20):
        # x + dx = t and y + dy = slope t, up to rounding: every cell is flat.
        t = x + y / 3 + rng.normal(size=x.shape)
        field = np.stack([t - x, slope * t - y], axis=-1)
        signs |= set(check(field).signs.ravel().tolist())
    assert {-1, 1} <= signs


def test_a_collapsed_field() -> None:
    y, x = np.mgrid[:5, :6]
    audit = check(-np.stack([x, 0 * y], axis=-1))
    assert (audit.verdict, audit.smallest) == ("collapses", 0.0)
    assert not audit.proved


def test_central_differences_miss_a_fold() -> None:
    """They skip the pixel in the middle, which may be anywhere."""
    field = np.zeros((7, 7, 2))
    field[3, 3] = (2.5, 0.0)  # beyond the next pixel
    gradients: Any = [np.gradient(field[..., k]) for k in range(2)]
    (dx_y, dx_x), (dy_y, dy_x) = gradients
    central = (1 + dx_x) * (1 + dy_y) - dx_y * dy_x
    assert central[3, 3] == 1.0
    checkerboard = np.zeros((8, 8, 2))
    checkerboard[..., 0] = 0.75 * (-1) ** np.arange(8)
    along: Any = np.gradient(checkerboard[..., 0], axis=1)
    inside = along[1:-1, 1:-1]
    assert not inside.any()  # central differences take it for the identity
    audit = check(checkerboard)
    assert audit.verdict == "folds"
    assert audit.determinant == -0.5
    assert audit.folded_area == 4 * 7  # whole cells of every second column
    assert check(field).verdict == "folds"


def test_the_area_that_folds() -> None:
    rng = np.random.default_rng(5)
    field = rng.normal(size=(4, 4, 2))
    u, v = np.meshgrid(*[(np.arange(400) + 0.5) / 400] * 2)
    area = 0.0
    for a, b, c, _ in corner_determinants(field).values():
        area += np.mean(float(a) + u * float(b - a) + v * float(c - a) < 0)
    assert glid.audit(field).folded_area == pytest.approx(area, abs=0.02)


def test_the_components_may_be_swapped() -> None:
    rng = np.random.default_rng(6)
    field = rng.normal(size=(5, 4, 2))
    swapped = glid.audit(field[..., ::-1], order="yx")
    assert swapped.message == glid.audit(field).message


def test_another_axis_of_length_one() -> None:
    rng = np.random.default_rng(7)
    field = rng.normal(size=(5, 4, 2))
    assert glid.audit(field[:, :, None]).message == glid.audit(field).message


def test_mirrored_axes_change_the_sign_of_displacements() -> None:
    rng = np.random.default_rng(8)
    field = 0.7 * rng.normal(size=(5, 4, 2))
    mirrored = glid.audit(-field, spacing=(-1, -1))
    np.testing.assert_array_equal(mirrored.determinants, glid.audit(field).determinants)


def with_value(value: float) -> Array:
    field = np.zeros((4, 5, 2))
    field[2, 3, 1] = value
    return field


@pytest.mark.parametrize(
    ("field", "message"),
    [
        (with_value(np.nan), "dy is nan at the pixel x = 3, y = 2"),
        (with_value(-np.inf), "dy is -inf at the pixel x = 3, y = 2"),
        (np.zeros((1, 5, 2)), r"1 x 5 pixels \(rows x columns\); a cell needs at least 2 x 2"),
        (np.zeros((5, 1, 2)), "a cell needs at least 2 x 2"),
        (np.zeros((0, 5, 2)), r"has the shape \(h, w, 2\), not \(0, 5, 2\)"),
        (np.zeros((2, 5, 6)), r"np.moveaxis\(field, 0, -1\)"),
        (np.zeros((4, 5, 6, 3)), "take a slice"),
        (np.zeros((4, 5, 3)), "take a slice"),
        (np.zeros((4, 5)), "has the shape"),
        (np.zeros((4, 5, 2), complex), "complex128 values"),
        (np.zeros((4, 5, 2), bool), "bool values"),
        ([[[1, 2], [3]]], "is not an array of shape"),
        (np.ma.masked_equal(np.zeros((4, 5, 2)), 0), "masked"),
    ],
)
def test_what_cannot_be_read(field: Any, message: str) -> None:
    with pytest.raises(glid.InputError, match=message):
        glid.audit(field)


def test_a_masked_array_without_a_masked_number_is_a_field() -> None:
    assert glid.audit(np.ma.masked_array(np.zeros((3, 3, 2)))).proved


def test_a_nan_of_swapped_components_is_named() -> None:
    with pytest.raises(glid.InputError, match="dx is nan"):
        glid.audit(with_value(np.nan), order="yx")


def test_wrong_arguments() -> None:
    field = np.zeros((4, 5, 2))
    with pytest.raises(glid.InputError, match="order must be"):
        glid.audit(field, order="dx")
    with pytest.raises(glid.InputError, match="spacing must be two finite numbers other than 0"):
        glid.audit(field, spacing=(1, 0))
    with pytest.raises(glid.InputError, match="are for functions"):
        glid.audit(field, bounds=(0, 0, 1, 1))


def test_large_integers_are_exact() -> None:
    field = np.zeros((3, 3, 2), np.int64)
    field[1, 1] = (2**60 + 1, -(2**61) - 1)
    check(field)


def test_the_result_is_a_value() -> None:
    audit = glid.audit(with_value(-2.0))
    data = audit.to_dict()
    assert data["verdict"] == "folds"
    assert data["point"] == list(audit.point)
    assert "signs" not in data
    with pytest.raises(ValueError, match="read-only"):
        audit.determinants[0, 0] = 1


@pytest.mark.parametrize("inverse", [False, True])
def test_a_field_of_a_map_is_audited_where_it_is_known(inverse: bool) -> None:
    """Beside the shape its values are 0, so the whole array folds at the shape's edge."""
    turn = np.exp(0.5j)
    shape = glid.Domain.from_cage(glid.Cage([[-6, -2], [6, -2], [6, 2], [-6, 2]]))
    turned = glid.HarmonicMap(
        shape, turn * shape.offset_cage.loops_complex[0], np.zeros(shape.n_coefficients)
    )
    field = turned.displacement_field(glid.PixelFrame(60, 50), (50, 40), inverse=inverse)
    found = glid.audit(field)
    assert found.proved
    assert found.smallest == pytest.approx(1, abs=1e-9)
    known = field.known
    cells = known[1:, 1:] & known[:-1, 1:] & known[1:, :-1] & known[:-1, :-1]
    assert found.pieces == cells.sum() == (found.signs == 1).sum()
    assert (np.isfinite(found.determinants) == cells).all()
    assert glid.audit(field.values, spacing=field.spacing).verdict == "folds"


def test_a_field_without_a_known_cell_is_refused() -> None:
    small = glid.HarmonicMap.identity(
        glid.Domain.from_cage(glid.Cage([[0, 0], [1, 0], [1, 1], [0, 1]]))
    )
    with pytest.raises(glid.InputError, match="no cell of the field has four known corners"):
        glid.audit(small.displacement_field(glid.PixelFrame(9, 9)))
