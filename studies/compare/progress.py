"""How the solvers approach their minimum, by iterations and by time (Figures 1, 10 and 11)."""

from collections import defaultdict
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glid_nb.energies import SymmetricDirichlet
from glid_nb.geometry import MeshMap, Triangulation, triangulate
from glid_nb.harmonic import HarmonicMap
from glid_nb.methods import METHODS, available
from glid_nb.pose import Pose
from studies.cases import Case
from studies.compare.minimum import Minimum, NoMinimumError, mesh_minimum
from studies.compare.progress_figure import HARMONIC, MESH, draw
from studies.compare.shapes import all_shapes
from studies.distortion import harmonic_area_mean, mesh_area_mean
from studies.runs import (
    CRITERIA,
    ENDED,
    LIGHT_WEIGHT,
    MESH_VERTICES,
    P2P_WEIGHT,
    Watcher,
    apart,
    display_mesh,
    entries,
    outcome,
    reached,
    run,
    thumbnails,
)
from studies.store import Measurement
from studies.study import Plan, Study, on_cases
from studies.tables import Row, digits

Array = NDArray[Any]

LIMITS = {"lbfgs": 2000, "newton-eigen": 120}
"""Iteration limits of these methods. The paper's L-BFGS took 1,818 iterations."""
MESH_SECONDS = 40.0
"""Limit for a method on a mesh: total seconds of its steps."""
_FOLLOWED = ("newton", "newton-eigen")
_UNWATCHED = 2
_THUMBNAILS = 4


def measure(case: Case, plan: Plan) -> Measurement:
    """Run every method on one shape, from the identity as in the paper."""
    display = display_mesh(case)
    pose = case.problem.pose
    mesh = triangulate(case.problem.domain.cage, MESH_VERTICES, points=pose.handles)
    runs: dict[str, Any] = {}
    arrays = {
        "display": display.vertices,
        "display_triangles": display.triangles,
        "mesh": mesh.vertices,
        "mesh_triangles": mesh.triangles,
        "handles": pose.handles,
        "targets": pose.targets,
    }
    maps: dict[str, HarmonicMap] = {}
    for method in HARMONIC:
        plan.detail(f"{case.name}: {method}")
        found = _harmonic(method, case, display)
        runs[method], arrays[f"images_{method}"], maps[method] = found
    ours = maps["newton"]
    runs["newton"]["area_mean"] = harmonic_area_mean(ours, mesh)
    other: MeshMap | None = None
    for method in reversed(MESH):
        if method in available():
            runs[method], pictures, other = _on_mesh(method, case, mesh, other, plan)
            arrays[f"images_{method}"] = pictures
    plan.detail(f"{case.name}: other settings")
    aligned = run("newton", case, align=True)
    assert isinstance(aligned.map, HarmonicMap)
    return {
        "handles": len(pose),
        "runs": runs,
        "area_mean_below_ours": area_mean_below(ours, mesh, pose),
        "area_mean_aligned": harmonic_area_mean(aligned.map, mesh),
        "variants": _variants(case),
        "arrays": arrays,
    }


def _variants(case: Case) -> dict[str, Any]:
    """Further runs, which explain how the others end."""
    limits: dict[str, Any] = {"max_iterations": LIMITS["lbfgs"], "p2p_weight": LIGHT_WEIGHT}
    staged = run("newton-staged", case, sampling="graded", certificate="hermite")
    lbfgs = run("lbfgs", case, initial="dirichlet", **limits)
    return {
        "projected Hessian, our samples": outcome(staged),
        "L-BFGS, light targets": outcome(lbfgs),
    }


def _harmonic(
    method: str, case: Case, display: Triangulation
) -> tuple[dict[str, Any], Array, HarmonicMap]:
    """A method in the harmonic subspace: its numbers, images of some iterates, and its last map.

    Numbers and last map are those of the unwatched run; the watched run may end a little apart.
    """
    limit: dict[str, Any] = {"max_iterations": LIMITS.get(method)}
    watcher = Watcher(display.vertices)
    watched = run(method, case, callback=watcher, **limit) if method in _FOLLOWED else None
    result = run(method, case, runs=1 if method == "lbfgs" else _UNWATCHED, **limit)
    map_ = result.map
    assert isinstance(map_, HarmonicMap)
    measured, end = outcome(result), map_(display.vertices)
    if watched is not None and watched.status.ok:
        energy = [step.energy for step in entries(watched)]
        found = reached(watcher.distance(end), watcher.moved, energy, energy[-1], True)
        found = {n: None if i is None else min(i, result.iterations) for n, i in found.items()}
        measured["reached"] = _with_times(found, measured["time"])
    ended = ended_by(watcher.images, result.iterations, end)
    measured["thumbnails"], pictures = thumbnails(ended, _THUMBNAILS)
    return measured, pictures, map_


def _on_mesh(
    method: str, case: Case, mesh: Triangulation, other: MeshMap | None, plan: Plan
) -> tuple[dict[str, Any], Array, MeshMap | None]:
    """A method on a mesh, followed for :data:`MESH_SECONDS`: its numbers, images of some iterates,
    and the minimum to which it descends, or None. ``other`` is the minimum of another method."""
    plan.detail(f"{case.name}: {method}, followed for {MESH_SECONDS:.0f} s")
    settings: dict[str, Any] = {"mesh": mesh, "max_iterations": 1_000_000}
    watcher = Watcher(mesh.vertices, MESH_SECONDS)
    result = run(method, case, callback=watcher, **settings)
    map_ = result.map
    assert isinstance(map_, MeshMap)
    measured = outcome(result)
    ended = ended_by(watcher.images, result.iterations, map_.images)
    measured["thumbnails"], pictures = thumbnails(ended, _THUMBNAILS - 1)
    plan.detail(f"{case.name}: the minimum below {method}")
    try:
        minimum = minimum_below(method, map_, other, case.problem.pose)
    except NoMinimumError as error:
        return {**measured, "minimum": None, "reason": str(error)}, pictures, None
    distance, energy = watcher.distance(minimum.images), measured["energy"]
    found = reached(distance, watcher.moved, energy, minimum.energy, result.status.ok)
    plan.detail(f"{case.name}: {method}, timed")
    needed = max((i for i in found.values() if i is not None), default=0)
    timed = run(method, case, **{**settings, "max_iterations": needed})
    unwatched = [step.time for step in entries(timed)]
    time = np.cumsum([*unwatched, *measured["step_time"][len(unwatched) :]]).tolist()
    measured |= {
        "time": time,
        "reached": _with_times(found, time),
        "minimum": minimum.energy,
        "area_mean": mesh_area_mean(minimum.images, mesh),
        "left": apart(map_.images, minimum.images),
    }
    pictures = np.concatenate([pictures, minimum.images[None]])
    return measured, pictures, MeshMap(mesh, minimum.images)


def minimum_below(method: str, map_: MeshMap, other: MeshMap | None, pose: Pose) -> Minimum:
    """The minimum of a method's energy below its map. If none is found, because triangles are
    nearly flat, the minimum below ``other``. Raises a NoMinimumError if there is neither."""
    constraints = "hard" if method == "aqp" else "soft"
    try:
        return mesh_minimum(map_, pose, SymmetricDirichlet(), constraints, P2P_WEIGHT)
    except NoMinimumError:
        if other is None:
            raise
        return mesh_minimum(other, pose, SymmetricDirichlet(), constraints, P2P_WEIGHT)


def area_mean_below(map_: HarmonicMap, mesh: Triangulation, pose: Pose) -> float | None:
    """The distortion of the minimum of SLIM's energy below a harmonic map on the mesh; None if the
    mesh is too coarse for the map to be injective on it."""
    start = MeshMap(mesh, map_(mesh.vertices))
    try:
        return mesh_area_mean(minimum_below("slim", start, None, pose).images, mesh)
    except NoMinimumError:
        return None


def ended_by(images: dict[int, Array], iterations: int, end: Array) -> dict[int, Array]:
    """The iterates of a watched run before iteration ``iterations``, and ``end`` at that one."""
    return {**{i: image for i, image in images.items() if i < iterations}, iterations: end}


def _with_times(found: dict[str, int | None], time: list[float]) -> dict[str, Any]:
    """For each criterion its iteration and seconds, or ``None``."""
    return {
        name: None if (i := found[name]) is None else {"iteration": i, "time": time[i]}
        for name in CRITERIA
    }


def tables(found: list[Measurement]) -> dict[str, list[Row]]:
    """Iterations, times relative to ours, distortion, and variants."""
    titles = {name: method.label for name, method in METHODS.items()}
    rows: dict[str, list[Row]] = defaultdict(list)
    for data in found:
        runs, shape = data["runs"], {"shape": data["name"]}
        ours = runs["newton"]
        rows["iterations"].append({**shape, **{titles[m]: _ending(r) for m, r in runs.items()}})
        times = [ours["reached"][criterion]["time"] for criterion in CRITERIA]
        speed = {"ours, ms": " / ".join(digits(1e3 * t) for t in times)}
        for method in ("newton-eigen", *MESH):
            if method in runs:
                speed[titles[method]] = _ratios(runs[method], times)
        rows["speed"].append({**shape, **speed})
        means = {titles[m]: runs[m].get("area_mean") for m in ("newton", *MESH) if m in runs}
        means["mesh, from ours"] = data["area_mean_below_ours"]
        means["ours, aligned first"] = data["area_mean_aligned"]
        shown = {name: "" if value is None else f"{value:.3f}" for name, value in means.items()}
        rows["distortion"].append({**shape, **shown})
        variants = {name: _ending(run) for name, run in data["variants"].items()}
        rows["variants"].append({**shape, "handles": data["handles"], **variants})
    return rows


def _ending(one: dict[str, Any]) -> str:
    """Iterations until the end, with a + if it was not reached; on a mesh for each criterion."""
    if one.get("minimum") is not None:
        return " / ".join(
            f"{found['iteration']:,}" if found else f"{one['iterations']:,}+"
            for found in one["reached"].values()
        )
    if one["status"] in ("indefinite", "blocked"):
        return f"{one['status']} at {one['iterations']:,} ({one['energy'][-1]:.2g})"
    if one["status"] in ENDED:
        return f"{one['iterations']:,}"
    return f"{one['iterations']:,}+ ({one['energy'][-1]:.2g})"


def _ratios(one: dict[str, Any], ours: list[float]) -> str:
    """For each criterion, a method's time divided by ours."""
    if "reached" not in one:
        return "unconverged"
    return " / ".join(
        f"{digits(found['time'] / time, 2)}" if found else f"{digits(one['time'][-1] / time, 2)}+"
        for found, time in zip(one["reached"].values(), ours, strict=True)
    )


STUDY = Study("progress", on_cases(all_shapes, measure), tables, draw)
