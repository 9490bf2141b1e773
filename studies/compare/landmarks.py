"""Warps from landmarks: how often they fold, and how far they miss landmarks that were left out.

A picture of 100 x 100 pixels is moved by a known map without folds. Landmarks are drawn at random
in its middle part, and their images are known up to the error of a click. Half of them are left
out; the other half is given to each method. Folds are what `glid_nb.audit` proves: exactly for the
thin-plate spline and the triangles, and for the B-spline on its displacements at whole pixels.
"""

import functools
import time
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BSpline, LinearNDInterpolator, RBFInterpolator
from scipy.spatial import Delaunay

import glid_nb
from studies.store import Measurement
from studies.study import Plan, Study, Task
from studies.tables import Row

Array = NDArray[Any]

SIDE = 100  # pixels
_MARGIN = 10  # without landmarks, pixels
LANDMARKS = 24  # half of them are left out
DRAWS = 40
NOISE = (0.0, 3.0)  # standard deviations of a click, pixels
_CELLS = 8  # of the B-spline's control grid, along a side
_SMOOTHING = 1e-3  # weight of the control grid's second differences


def bend(points: Array) -> Array:
    """The whole picture bends: (k, 2) points on concentric circles."""
    angle, radius = (points[:, 0] - SIDE / 2) / (1.5 * SIDE), 1.5 * SIDE + points[:, 1]
    return np.stack([radius * np.sin(angle) + SIDE / 2, radius * np.cos(angle) - 1.5 * SIDE], 1)


def twirl(points: Array) -> Array:
    """The middle turns by 40 degrees, and the picture's border hardly moves."""
    d = points - SIDE / 2
    angle = np.radians(40) * np.exp(-((d**2).sum(axis=1)) / (0.25 * SIDE) ** 2)
    turned = (d[:, 0] + 1j * d[:, 1]) * np.exp(1j * angle)
    return SIDE / 2 + np.stack([turned.real, turned.imag], axis=1)


TRUTHS: dict[str, Callable[[Array], Array]] = {"the whole bends": bend, "the middle turns": twirl}


class Warp(NamedTuple):
    """A fitted warp."""

    images: Callable[[Array], Array]
    """Of (k, 2) points; NaN where there is none."""
    folds: Callable[[], bool]


def harmonic(src: Array, dst: Array, pieces: int = 4) -> Warp:
    """`glid_nb.HarmonicTransform` on the whole picture, by one descent without restarts."""
    domain = glid_nb.Domain.rectangle((SIDE, SIDE), pieces=pieces)
    transform = glid_nb.HarmonicTransform.from_estimate(
        src, dst, domain=domain, options=glid_nb.Options(restarts=0)
    )
    return Warp(transform, lambda: not glid_nb.certify(transform.map).certified)


def thin_plate(src: Array, dst: Array) -> Warp:
    """The thin-plate spline through the landmarks."""
    spline = RBFInterpolator(src, dst, kernel="thin_plate_spline")
    box = (0, 0, SIDE - 1, SIDE - 1)
    return Warp(spline, lambda: glid_nb.audit(spline, bounds=box).verdict == "folds")


def piecewise_affine(src: Array, dst: Array) -> Warp:
    """Affine on Delaunay's triangles of the landmarks; nothing outside their hull."""
    mesh = Delaunay(src)

    def folds() -> bool:
        return glid_nb.audit(dst, source=src, triangles=mesh.simplices).verdict == "folds"

    return Warp(LinearNDInterpolator(mesh, dst), folds)


def b_spline(src: Array, dst: Array) -> Warp:
    """Displacements by a cubic B-spline of least squares, slightly smoothed."""
    knots = np.linspace(-3, _CELLS + 3, _CELLS + 7) * SIDE / _CELLS
    n = len(knots) - 4

    def matrix(points: Array) -> Array:
        x, y = (BSpline.design_matrix(points[:, i], knots, 3).toarray() for i in (0, 1))
        return (x[:, :, None] * y[:, None, :]).reshape(len(points), -1)

    second = np.diff(np.eye(n), 2, axis=0)
    rough = np.concatenate([np.kron(second, np.eye(n)), np.kron(np.eye(n), second)])
    left = np.concatenate([matrix(src), np.sqrt(_SMOOTHING) * rough])
    right = np.concatenate([dst - src, np.zeros((len(rough), 2))])
    coefficients = np.linalg.lstsq(left, right, rcond=None)[0]

    def folds() -> bool:
        rows, columns = np.mgrid[:SIDE, :SIDE]
        pixels = np.stack([columns, rows], axis=-1).reshape(-1, 2).astype(float)
        field = (matrix(pixels) @ coefficients).reshape(SIDE, SIDE, 2)
        return glid_nb.audit(field).verdict == "folds"

    return Warp(lambda points: points + matrix(points) @ coefficients, folds)


METHODS = {
    "harmonic map (ours)": harmonic,
    "the same, `pieces=1`": functools.partial(harmonic, pieces=1),
    "thin-plate spline": thin_plate,
    "piecewise affine": piecewise_affine,
    "B-spline": b_spline,
}


def measure(truth: str, noise: float, plan: Plan) -> Measurement:
    """Folds, errors and times of every method, over random landmarks."""
    rng, draws = np.random.default_rng(0), 2 if plan.quick else DRAWS
    found: dict[str, Any] = {name: {"folds": 0, "errors": [], "seconds": []} for name in METHODS}
    for _ in range(draws):
        src = rng.uniform(_MARGIN, SIDE - _MARGIN, (LANDMARKS, 2))
        exact = TRUTHS[truth](src)
        dst = exact + noise * rng.normal(size=src.shape)
        half = LANDMARKS // 2
        for name, fit in METHODS.items():
            began = time.process_time()
            warp = fit(src[:half], dst[:half])
            one = found[name]
            one["seconds"].append(time.process_time() - began)
            one["folds"] += warp.folds()
            errors = np.linalg.norm(warp.images(src[half:]) - exact[half:], axis=1)
            one["errors"] += errors[np.isfinite(errors)].tolist()
    return {"name": f"{truth}, {noise:g}", "draws": draws, "half": half, "methods": found}


def tables(found: list[Measurement]) -> dict[str, list[Row]]:
    """Folds and errors; times apart, because they depend on the machine."""
    rows: list[Row] = []
    seconds: dict[str, list[float]] = {name: [] for name in METHODS}
    for data in found:
        truth, noise = data["name"].rsplit(", ", 1)
        asked = data["draws"] * data["half"]
        for name, one in data["methods"].items():
            rows.append(
                {
                    "the truth": truth,
                    "clicks off by, px": noise,
                    "method": name,
                    "folds": f"{one['folds']} of {data['draws']}",
                    "median error at left-out landmarks, px": float(np.median(one["errors"])),
                    "95th percentile, px": float(np.percentile(one["errors"], 95)),
                    "without an image": f"{asked - len(one['errors'])} of {asked}",
                }
            )
            seconds[name] += one["seconds"]
    times = [
        {"method": name, "processor time, ms": 1e3 * float(np.median(values))}
        for name, values in seconds.items()
    ]
    return {"landmarks": rows, "landmark-times": times}


def _tasks(plan: Plan) -> list[Task]:
    of = f"{LANDMARKS} landmarks, draws {DRAWS}, quick {plan.quick}"
    return [
        Task(
            f"{truth}-{noise:g}".replace(" ", "-"), of, lambda t=truth, n=noise: measure(t, n, plan)
        )
        for truth in TRUTHS
        for noise in NOISE
    ]


STUDY = Study("landmarks", _tasks, tables)
