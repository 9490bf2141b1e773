"""Functions: thin-plate splines by closed form, others by bounds on derivatives."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.interpolate import RBFInterpolator
from skimage.transform import ThinPlateSplineTransform

import glid_nb as glid
from glid_nb.auditing.splines import thin_plate

pytestmark = [
    pytest.mark.slow,
    # scikit-image 0.26 calls what SciPy 1.18 deprecates.
    pytest.mark.filterwarnings("ignore:.*(distance_matrix|minkowski_distance):DeprecationWarning"),
]

Array = NDArray[Any]
BOX = (0.0, 0.0, 10.0, 10.0)
GRID = np.stack(np.meshgrid(*[np.linspace(0, 10, 4)] * 2), axis=-1).reshape(-1, 2)


def moved(size: float, seed: int = 1) -> Array:
    return GRID + size * np.random.default_rng(seed).normal(size=GRID.shape)


def scipys(targets: Array, **how: Any) -> RBFInterpolator:
    return RBFInterpolator(GRID, targets, kernel="thin_plate_spline", **how)


def skimages(targets: Array) -> Any:
    spline = ThinPlateSplineTransform()
    estimate = getattr(spline, "_estimate")  # noqa: B009  (the public name differs between versions)
    estimate(GRID, targets)
    return spline


def jacobians(function: Any, points: Array, h: float = 1e-5) -> Array:
    steps = ([h, 0], [0, h])
    return np.stack([(function(points + s) - function(points - s)) / (2 * h) for s in steps], -1)


SPLINES = {
    "scipy": scipys,
    "skimage": skimages,
    "scaled": lambda targets: scipys(targets, epsilon=0.3),
    "smooth": lambda targets: scipys(targets, smoothing=0.5),
}


@pytest.mark.parametrize("kind", SPLINES)
def test_the_enclosure_holds_what_differences_show(kind: str) -> None:
    function = SPLINES[kind](moved(0.8))
    spline = thin_plate(function)
    assert spline is not None
    rng = np.random.default_rng(2)
    low = rng.uniform(0, 9, (150, 2))
    low[:16] = GRID - 1e-3  # boxes round the centres
    sides = 10.0 ** rng.uniform(-2.7, 0, (150, 2))
    boxes = np.concatenate([low, low + sides], axis=1)
    found = spline.enclose(boxes)
    for _ in range(8):
        points = low + rng.uniform(size=low.shape) * sides
        points[:16] = np.where(rng.uniform(size=(16, 1)) < 0.5, points[:16], GRID + 3e-5)
        away = points - (boxes[:, :2] + boxes[:, 2:]) / 2
        assert found.slope is not None
        value = found.middle + np.einsum("bijk,bk->bij", found.slope, away)
        # The differences themselves are off, most near a centre.
        assert (np.abs(jacobians(function, points) - value) <= found.radius + 1e-4).all()
    centre = (boxes[:, :2] + boxes[:, 2:]) / 2
    far = np.abs(centre[:, None] - GRID).max(axis=-1).min(axis=1) > 0.01
    differences = jacobians(function, centre)[far]
    np.testing.assert_allclose(found.centre[far], differences, atol=1e-6)


def test_smaller_boxes_have_narrower_enclosures_even_at_a_centre() -> None:
    spline = thin_plate(scipys(moved(0.8)))
    assert spline is not None
    widths = []
    for size in (1e-1, 1e-3, 1e-5, 1e-7):
        box = np.array([[*(GRID[5] - size), *(GRID[5] + size)]])
        widths.append(spline.enclose(box).radius.max())
    assert all(after < before / 30 for before, after in itertools.pairwise(widths))


@pytest.mark.parametrize("kind", SPLINES)
@pytest.mark.parametrize("size", [0.2, 1.2])
def test_a_spline_is_decided_as_samples_are(kind: str, size: float) -> None:
    function = SPLINES[kind](moved(size))
    audit = glid.audit(function, bounds=BOX, budget=40_000)
    dense = np.stack(np.meshgrid(*[np.linspace(0, 10, 101)] * 2), axis=-1).reshape(-1, 2)
    sampled = np.linalg.det(jacobians(function, dense))
    if sampled.min() < -0.01:
        assert audit.verdict == "folds"
        there = np.linalg.det(jacobians(function, np.array([audit.point])))[0]
        assert there <= audit.determinant + 1e-4
        share = (sampled < 0).mean() * 100
        assert audit.folded_area - 1 <= share <= audit.folded_area + audit.undecided_area + 1
    elif sampled.min() > 0.05:
        assert audit.verdict == "proved"
        assert audit.lower_bound is not None
        assert 0 < audit.lower_bound <= sampled.min() + 1e-4
        assert (audit.signs == 1).all()
    assert audit.outlines is not None
    sides = np.ptp(audit.outlines, axis=1)
    assert sides.prod(axis=1).sum() == pytest.approx(100.0)  # the boxes cover the bounds


def test_far_from_the_origin_and_small() -> None:
    for scale, shift in ((1e-3, 0.0), (1e4, 0.0), (1.0, 1e6)):
        source, target = GRID * scale + shift, moved(0.2) * scale + shift
        spline = RBFInterpolator(source, target, kernel="thin_plate_spline")
        bounds = (shift, shift, 10 * scale + shift, 10 * scale + shift)
        assert glid.audit(spline, bounds=bounds).proved


def wave(size: float) -> Any:
    """Its determinant is 1 - 4 size^2 cos(2x) cos(2y), and second derivatives stay below 4 size."""
    return lambda p: p + size * np.sin(2 * p[:, ::-1])


def test_a_bound_on_second_derivatives_decides() -> None:
    audit = glid.audit(wave(0.3), bounds=BOX, second_derivative=1.2)
    assert audit.proved
    assert audit.lower_bound is not None
    assert 0 < audit.lower_bound <= 0.64
    audit = glid.audit(wave(0.6), bounds=BOX, second_derivative=2.4)
    assert audit.verdict == "folds"
    assert audit.point is not None
    assert audit.determinant is not None
    x, y = audit.point
    assert 1 - 1.44 * np.cos(2 * x) * np.cos(2 * y) <= audit.determinant < 0


def test_enclosures_of_ones_own_decide() -> None:
    def jacobian(boxes: Array) -> tuple[Array, Array]:
        low, high = np.zeros((2, len(boxes), 2, 2))
        low[:, 0, 0], high[:, 0, 0] = 2 * boxes[:, 0], 2 * boxes[:, 2]
        low[:, 1, 1] = high[:, 1, 1] = 1.0
        return low, high

    def square(points: Array) -> Array:
        return np.stack([points[:, 0] ** 2, points[:, 1]], axis=-1)

    assert glid.audit(square, bounds=(0.1, 0, 1, 1), jacobian=jacobian).proved
    audit = glid.audit(square, bounds=(-1, 0, 1, 1), jacobian=jacobian)
    assert audit.verdict == "folds"
    assert audit.folded_area == pytest.approx(1.0, abs=0.05)
    # The determinant is 0 on an edge of the bounds, which no enclosure decides.
    audit = glid.audit(square, bounds=(0, 0, 1, 1), jacobian=jacobian, budget=500)
    assert audit.verdict == "undecided"
    assert audit.undecided_area > 0
    assert "larger budget" in audit.message


@pytest.mark.parametrize(("size", "words"), [(0.3, "no fold was met"), (0.6, "seems to fold")])
def test_values_alone_prove_nothing(size: float, words: str) -> None:
    audit = glid.audit(wave(size), bounds=BOX)
    assert audit.verdict == "undecided"
    assert audit.point is None
    assert words in audit.message
    assert audit.smallest == pytest.approx(1 - 4 * size**2, abs=0.02)


def test_a_function_of_jax() -> None:
    import jax.numpy as jnp

    def bend(points: Any) -> Any:
        return points + 0.2 * jnp.sin(points[:, ::-1])

    audit = glid.audit(bend, bounds=(0, 0, 3, 3))
    assert audit.smallest == pytest.approx(0.96, abs=0.05)


@pytest.mark.parametrize(
    ("function", "how", "message"),
    [
        (wave(0.1), {}, "a function needs bounds"),
        (wave(0.1), {"bounds": (0, 0, 1)}, "bounds must be four numbers"),
        (wave(0.1), {"bounds": (0, 0, 0, 1)}, "xmin < xmax"),
        (wave(0.1), {"bounds": (0, 0, np.inf, 1)}, "must be finite"),
        (lambda p: p[:, 0], {"bounds": BOX}, r"must return \(k, 2\) points"),
        (lambda p: p / 0.0, {"bounds": BOX}, "must be finite on the bounds"),
        (wave(0.1), {"bounds": BOX, "second_derivative": -1}, "at least 0"),
        (wave(0.1), {"bounds": BOX, "source": [[0, 0]]}, "a function needs no source"),
        (wave(0.1), {"bounds": BOX, "jacobian": lambda b: b}, "jacobian must"),
        (wave(0.1), {"bounds": BOX, "jacobian": lambda b: (b, b)}, "jacobian of 64 boxes"),
        (wave(0.1), {"bounds": BOX, "jacobian": abs, "second_derivative": 1.0}, "not both"),
    ],
)
def test_what_cannot_be_audited(function: Any, how: dict[str, Any], message: str) -> None:
    with np.errstate(all="ignore"), pytest.raises(glid.InputError, match=message):
        glid.audit(function, **how)


def test_a_harmonic_map_is_sent_to_certify() -> None:
    domain = glid.Domain.from_cage(glid.Cage([[0, 0], [4, 0], [4, 2], [0, 2]]))
    map = glid.HarmonicMap.identity(domain)
    with pytest.raises(glid.InputError, match=r"glid\.certify"):
        glid.audit(map)
    for its in (map.inverse, glid.HarmonicTransform(map)):
        with pytest.raises(glid.InputError, match=f"this {type(its).__name__} belongs"):
            glid.audit(its, bounds=BOX)


def test_other_splines_are_functions_without_closed_form() -> None:
    for how in ({"kernel": "cubic"}, {"kernel": "thin_plate_spline", "neighbors": 9}):
        function = RBFInterpolator(GRID, moved(0.1), **how)
        assert thin_plate(function) is None
        assert glid.audit(function, bounds=BOX).verdict == "undecided"
