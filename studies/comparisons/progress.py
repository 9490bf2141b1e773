"""All methods from the identity to convergence (Figures 1, 10 and 11, the speed ratios)."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.ticker import NullFormatter
from numpy.typing import NDArray
from scipy.spatial import KDTree

from glid_nb.energies import SymmetricDirichlet
from glid_nb.figures.style import LINE, SMALL
from glid_nb.geometry import Triangulation, triangulate
from glid_nb.harmonic import HarmonicMap
from glid_nb.methods import MeshMap, methods
from glid_nb.solvers import Pose
from studies.comparisons import drawing
from studies.comparisons.cases import Case
from studies.comparisons.curvature import contraction, negative_eigenvalues
from studies.comparisons.distortion import densities, harmonic_area_mean, mesh_area_mean
from studies.comparisons.drawing import LOOK
from studies.comparisons.minimum import Minimum, NoMinimumError, mesh_minimum
from studies.comparisons.preparation import preparation
from studies.comparisons.runs import (
    CRITERIA,
    LIGHT_WEIGHT,
    MESH_VERTICES,
    P2P_WEIGHT,
    Watcher,
    apart,
    display_mesh,
    last_of,
    outcome,
    reached,
    run,
    thumbnails,
)
from studies.comparisons.store import Measurement
from studies.comparisons.units import seconds

Array = NDArray[Any]

HARMONIC = ("newton", "newton-paper", "newton-unmodified", "newton-eigen", "lbfgs")
MESH = ("slim", "aqp")
_FOLLOWED = ("newton", "newton-eigen")
ENDED = ("converged", "stationary")
"""How a run ends that got to its minimum."""
LIMITS = {"lbfgs": 2000, "newton-eigen": 120}
"""Iterations after which these end if they have not converged; the paper's L-BFGS took 1,818."""
MESH_SECONDS = 40.0
"""Seconds of its own steps after which a method on a mesh ends."""
_REPEATS = {"lbfgs": 1}
_UNWATCHED = 2
_THUMBNAILS = 4
_LABEL = 0.75  # width of a row's label, in pictures
_LEAST_GAP = 1e-9
_TITLE: dict[str, Any] = {"fontsize": SMALL - 1, "pad": 2}


def measure(case: Case, detail: Callable[[str], None]) -> Measurement:
    """Every method on one shape, started at the identity as in the paper."""
    display = display_mesh(case)
    mesh = triangulate(case.problem.domain.cage, MESH_VERTICES, points=case.problem.pose.handles)
    runs: dict[str, Any] = {}
    arrays = {
        "display": display.vertices,
        "display_triangles": display.triangles,
        "mesh": mesh.vertices,
        "mesh_triangles": mesh.triangles,
        "handles": case.problem.pose.handles,
        "targets": case.problem.pose.targets,
    }
    known = methods(available=True)
    minimum: HarmonicMap | None = None
    for method in HARMONIC:
        detail(f"{case.name}: {LOOK[method][0]}")
        runs[method], arrays[f"images_{method}"], map_ = _harmonic(method, case, display)
        if method == "newton":
            minimum = map_
    assert minimum is not None
    runs["newton"]["area_mean"] = harmonic_area_mean(minimum, mesh)
    detail(f"{case.name}: the minimum on the mesh below ours")
    below_ours = area_mean_below(minimum, mesh, case.problem.pose)
    other: MeshMap | None = None
    for method in reversed(MESH):
        if method in known:
            runs[method], pictures, other = _on_mesh(method, case, mesh, other, detail)
            arrays[f"images_{method}"] = pictures
    for method in ("newton", *MESH):
        if method in runs:
            detail(f"{case.name}: {LOOK[method][0]}, preparation")
            on_mesh = method in MESH
            runs[method]["preparation"] = preparation(method, case, on_mesh, MESH_VERTICES)
    detail(f"{case.name}: {LOOK['lbfgs'][0]}, light targets")
    light: dict[str, Any] = {"p2p_weight": LIGHT_WEIGHT}
    lbfgs = run("lbfgs", case, initial="dirichlet", max_iterations=LIMITS["lbfgs"], **light)
    detail(f"{case.name}: eigenvalues of Hessians")
    eigen = runs["newton-eigen"]
    if eigen["status"] not in ENDED:
        limit: dict[str, Any] = {"max_iterations": LIMITS["newton-eigen"]}
        eigen["negative"] = negative_eigenvalues(case, "newton-eigen", **limit)
        eigen["by_modulus"] = outcome(run("newton-eigen", case, absolute=True, **limit))
    detail(f"{case.name}: other settings of Newton's method")
    return {
        "name": case.name,
        "unknowns": case.unknowns,
        **other_settings(case, mesh),
        "area_mean_below_ours": below_ours,
        "handles": len(case.problem.pose),
        "runs": runs,
        "light": {
            "newton": outcome(last_of(_UNWATCHED, "newton", case, **light)),
            "lbfgs": outcome(lbfgs),
        },
        "negative": negative_eigenvalues(case),
        "contraction": contraction(case, minimum),
        "arrays": arrays,
    }


def other_settings(case: Case, mesh: Triangulation) -> dict[str, Any]:
    """Newton's method as Newton-Eigen is run but for the modification, and ours if it may align."""
    projected = run("newton-staged", case, sampling="graded", certificate="hermite")
    aligned = run("newton", case, align=True)
    assert isinstance(aligned.map, HarmonicMap)
    return {
        "projected": outcome(projected),
        "aligned": {**outcome(aligned), "area_mean": harmonic_area_mean(aligned.map, mesh)},
    }


def _harmonic(
    method: str, case: Case, display: Triangulation
) -> tuple[dict[str, Any], Array, HarmonicMap]:
    """A method in the harmonic subspace; its own last map is its minimum, if it converged.

    With the images of some iterates, of which the last is that of the run whose numbers count: the
    watched one returns to the host at each iteration and may end one earlier or later.
    """
    limit: dict[str, Any] = {"max_iterations": LIMITS.get(method)}
    watcher = Watcher(display.vertices)
    watched = run(method, case, callback=watcher, **limit) if method in _FOLLOWED else None
    result = last_of(_REPEATS.get(method, _UNWATCHED), method, case, **limit)
    map_ = result.map
    assert isinstance(map_, HarmonicMap)
    measured = outcome(result)
    end = map_(display.vertices)
    if watched is not None and watched.status.ok:
        energy = [step.energy for step in watched.history]
        found = reached(watcher.distance(end), watcher.moved, energy, energy[-1], True)
        found = {name: _at_most(i, result.iterations) for name, i in found.items()}
        measured["reached"] = _with_times(found, measured["time"])
    measured["thumbnails"], pictures = thumbnails(
        ended_by(watcher.images, result.iterations, end), _THUMBNAILS
    )
    return measured, pictures, map_


def _on_mesh(
    method: str,
    case: Case,
    mesh: Triangulation,
    other: MeshMap | None,
    detail: Callable[[str], None],
) -> tuple[dict[str, Any], Array, MeshMap | None]:
    """A method on a mesh, followed for a while, and the minimum that it descends to.

    That is returned last, ``None`` where there is none; ``other`` is that of another method.
    """
    detail(f"{case.name}: {LOOK[method][0]}, followed for {MESH_SECONDS:.0f} s")
    settings: dict[str, Any] = {"triangulation": mesh, "max_iterations": 1_000_000}
    watcher = Watcher(mesh.vertices, MESH_SECONDS)
    result = run(method, case, callback=watcher, **settings)
    map_ = result.map
    assert isinstance(map_, MeshMap)
    measured = outcome(result)
    measured["thumbnails"], pictures = thumbnails(
        ended_by(watcher.images, result.iterations, map_.images), _THUMBNAILS - 1
    )
    detail(f"{case.name}: the minimum below {LOOK[method][0]}")
    pose = case.problem.pose
    try:
        minimum, its_own = minimum_below(method, map_, other, pose)
    except NoMinimumError as error:
        return {**measured, "minimum": None, "reason": str(error)}, pictures, None
    if not its_own:
        measured["borrowed"] = True
    found = reached(
        watcher.distance(minimum.images),
        watcher.moved,
        measured["energy"],
        minimum.energy,
        result.status.ok,
    )
    detail(f"{case.name}: {LOOK[method][0]}, timed")
    needed = max((i for i in found.values() if i is not None), default=0)
    timed = run(method, case, **{**settings, "max_iterations": needed})
    unwatched = [step.time for step in timed.history]
    watched = measured["step_time"]
    step_time = [*unwatched, *watched[len(unwatched) :]]
    time = np.cumsum(step_time).tolist()
    measured |= {
        "step_time": step_time,
        "time": time,
        "reached": _with_times(found, time),
        "minimum": minimum.energy,
        "area_mean": mesh_area_mean(minimum.images, mesh),
        "left": apart(map_.images, minimum.images),
        # The start is left out: in the first run it waits for programs that are compiled.
        "watching": sum(watched[1 : len(unwatched)]) / sum(unwatched[1:]) if needed else None,
    }
    pictures = np.concatenate([pictures, minimum.images[None]])
    return measured, pictures, MeshMap(mesh, minimum.images)


def minimum_below(
    method: str, map_: MeshMap, other: MeshMap | None, pose: Pose
) -> tuple[Minimum, bool]:
    """The minimum of a method's energy below its map, or below another one, and which it is.

    Newton's method does not get down from a map whose triangles are next to flat. The minimum
    below another map is one of the same energy all the same.

    Raises
    ------
    NoMinimumError
        When there is none below either.
    """
    constraints = "hard" if method == "aqp" else "soft"
    try:
        return mesh_minimum(map_, pose, SymmetricDirichlet(), constraints, P2P_WEIGHT), True
    except NoMinimumError:
        if other is None:
            raise
        return mesh_minimum(other, pose, SymmetricDirichlet(), constraints, P2P_WEIGHT), False


def area_mean_below(map_: HarmonicMap, mesh: Triangulation, pose: Pose) -> float | None:
    """The distortion of the minimum of SLIM's energy to which a harmonic map leads on the mesh.

    ``None`` where there is none, as where the mesh is too coarse for the map to be injective on it.
    """
    start = MeshMap(mesh, map_(mesh.vertices))
    try:
        found = mesh_minimum(start, pose, SymmetricDirichlet(), "soft", P2P_WEIGHT)
    except NoMinimumError:
        return None
    return mesh_area_mean(found.images, mesh)


def _at_most(iteration: int | None, most: int) -> int | None:
    return None if iteration is None else min(iteration, most)


def _with_times(found: dict[str, int | None], time: list[float]) -> dict[str, Any]:
    """Iteration and seconds of each criterion, or ``None``."""
    return {
        name: None if (i := found[name]) is None else {"iteration": i, "time": time[i]}
        for name in CRITERIA
    }


def draw(data: Measurement, path: Path) -> None:
    """Rows of intermediate maps, and energies against iterations and time."""
    runs, arrays = data["runs"], data["arrays"]
    rows = [m for m in ("newton", "newton-eigen", "newton-unmodified", *MESH) if m in runs]
    figure = drawing.figure(13.0, 1.5 * len(rows))
    left, right = drawing.side_by_side(figure, (1.45, 1.0))
    ratios = (_LABEL, *(1.0,) * _THUMBNAILS)
    grid = left.subplots(len(rows), 1 + _THUMBNAILS, squeeze=False, width_ratios=ratios)
    final = densities(arrays["display"], arrays["display_triangles"], arrays["images_newton"][-1])
    most = float(np.clip(np.quantile(final, 0.97), 3.0, 12.0))
    colors = None
    for (label, *row), method in zip(grid, rows, strict=True):
        run = runs[method]
        kind = "mesh" if method in MESH else "display"
        rest, triangles = arrays[kind], arrays[f"{kind}_triangles"]
        handles = KDTree(rest).query(arrays["handles"])[1]  # they are among the vertices
        pictures = arrays[f"images_{method}"]
        titles = [f"iteration {i}" for i in run["thumbnails"]]
        if run.get("minimum") is not None:
            titles.append("its minimum")
        if len(titles) < len(row):
            titles, pictures = ["the start", *titles], np.concatenate([rest[None], pictures])
        for axes in (label, *row):
            axes.set_axis_off()
        # The last one under the last one, so that the ends of all methods stand in a column.
        for axes, title, images in zip(row[-len(titles) :], titles, pictures, strict=True):
            pose = np.hstack([arrays["targets"], images[handles]])
            colors = drawing.draw_map(axes, rest, triangles, images, pose, most)
            axes.set_title(f"{title}\n{_largest(rest, triangles, images)}", **_TITLE)
        label.text(
            0.0, 0.5, f"{LOOK[method][0]}\n{_note(run)}", transform=label.transAxes,
            fontsize=SMALL, va="center", color=LOOK[method][1],
        )  # fmt: skip
    if colors is not None:
        drawing.color_bar(left, colors, grid, "symmetric Dirichlet density")
    _draw_energies(right, runs)
    drawing.save(figure, path)


def ended_by(images: dict[int, Array], iterations: int, end: Array) -> dict[int, Array]:
    """The iterates of a watched run before the last iteration of another, and where that ended."""
    return {**{i: image for i, image in images.items() if i < iterations}, iterations: end}


def _largest(rest: Array, triangles: Array, images: Array) -> str:
    density = densities(rest, triangles, images)
    return f"maximum {density[np.isfinite(density)].max():.2g}"


def _note(run: dict[str, Any]) -> str:
    if run["status"] in ("indefinite", "blocked"):
        return f"halts after {run['iterations']} it."
    if "minimum" not in run:
        more = "" if run["status"] in ENDED else "+"
        return f"{run['iterations']}{more} it., {seconds(run['time'][-1])}"
    near = run["reached"]["energy"] if run["minimum"] is not None else None
    if near is None:
        return f"not within 1 %\nin {seconds(run['time'][-1])}"
    return f"within 1 %:\n{near['iteration']} it., {seconds(near['time'])}"


def _draw_energies(figure: Any, runs: dict[str, Any]) -> None:
    plots = figure.subplots(2, 2, sharey="row")
    shown = {}
    for axes_row, names, space in zip(
        plots, (HARMONIC, MESH), ("harmonic subspace", "triangle mesh"), strict=True
    ):
        for axes, against in zip(axes_row, ("iteration", "time"), strict=True):
            for method in names:
                if method in runs:
                    least = _least(runs, method)
                    line = _curve(axes, runs[method], method, against, least)
                    shown.setdefault(LOOK[method][0], line)
            axes.set_yscale("log")
            axes.set_xscale("log")
            axes.xaxis.set_minor_formatter(NullFormatter())
            unit = "seconds" if against == "time" else "iteration"
            drawing.label_axes(axes, unit, "energy above its minimum, relative", space)
    for axes in plots[:, 1]:
        axes.set_ylabel("")
    figure.legend(
        shown.values(), shown.keys(), loc="outside lower center", ncols=4, fontsize=SMALL,
        frameon=False,
    )  # fmt: skip


def _least(runs: dict[str, Any], method: str) -> float:
    """The minimum a method goes to: on its mesh, its own last where it converged, or ours.

    Samples differ between settings of Newton's method, and with them minima by some digits.
    """
    run = runs[method]
    if run.get("minimum") is not None:
        return run["minimum"]
    if method in MESH or run["status"] in ENDED:
        return run["energy"][-1]
    return runs["newton"]["energy"][-1]


def _curve(axes: Any, run: dict[str, Any], method: str, against: str, least: float) -> Any:
    """The relative energy gap; a cross where the method halted."""
    label, color, style = LOOK[method]
    gap = drawing.values_of(run["energy"]) / least - 1
    # The start, iteration 0, has no place on a logarithmic axis.
    x = np.arange(len(gap)) if against == "iteration" else np.array(run["time"])
    keep = np.isfinite(gap) & (gap > _LEAST_GAP) & (x > 0)
    (line,) = axes.plot(x[keep], gap[keep], style, color=color, lw=LINE, label=label)
    if keep.any() and run["status"] in ("indefinite", "blocked"):
        axes.plot(x[keep][-1], gap[keep][-1], "x", color=color, ms=5)
    return line
