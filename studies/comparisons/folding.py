"""Where linear methods fold, beside ours, which does not."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import scipy.sparse
import scipy.sparse.csgraph
from matplotlib.collections import PolyCollection
from matplotlib.patches import Circle
from numpy.typing import NDArray

from glid_nb.certificate import certify
from glid_nb.figures.style import CYAN, HAIRLINE, INK, SKY, SMALL, VERMILION
from glid_nb.geometry import Triangulation, triangulate
from glid_nb.harmonic import HarmonicMap
from glid_nb.methods import MeshMap, methods
from glid_nb.methods.linear.cauchy import cauchy_point_to_point
from studies.comparisons import drawing
from studies.comparisons.cases import Case
from studies.comparisons.runs import MESH_VERTICES, P2P_WEIGHT, run
from studies.comparisons.store import Measurement
from studies.comparisons.units import percent

Array = NDArray[Any]

# Least radius of a ring around a fold, relative to the picture, and the largest relative to that.
_RING, _LARGEST_RING = 0.03, 4

METHODS: Mapping[str, tuple[str, str, Mapping[str, Any]]] = {
    "newton": ("ours", "newton", {}),
    "mls": ("moving least squares", "mls", {}),
    "bbw": ("bounded biharmonic weights", "bbw", {}),
    "harmonic": ("harmonic weights", "harmonic-weights", {"power": 1}),
    "biharmonic": ("biharmonic weights", "harmonic-weights", {"power": 2}),
    "mean-value": ("mean value coordinates", "mean-value", {}),
    "cauchy": ("Cauchy coordinates", "cauchy", {}),
}
"""What the page calls it, the method, and its settings."""


def measure(case: Case, detail: Callable[[str], None]) -> Measurement:
    """Every method's images of one mesh, and what of it is turned over."""
    problem = case.problem
    mesh = triangulate(problem.domain.cage, MESH_VERTICES, points=problem.pose.handles)
    rest = MeshMap(mesh, mesh.vertices).areas
    known = methods(available=True)
    measured: dict[str, Any] = {}
    arrays = {
        "mesh": mesh.vertices,
        "triangles": mesh.triangles,
        "targets": problem.pose.targets,
    }
    for name, (title, method, settings) in METHODS.items():
        if method not in known:
            continue
        detail(f"{case.name}: {title}")
        result = run(method, case, triangulation=mesh, **settings)
        map_ = on_mesh(result.map, mesh)
        measured[name] = {
            "flips": int(map_.flipped.sum()),
            "share": float(rest[map_.flipped].sum() / rest.sum()),
            "proved": result.certificate.certified if result.certificate else None,
        }
        arrays[f"images_{name}"] = map_.images
    measured["cauchy"]["zeros"] = _zeros(case)
    return {
        "name": case.name,
        "triangles": len(mesh.triangles),
        "methods": measured,
        "arrays": arrays,
    }


def _zeros(case: Case) -> int | None:
    """Zeros of the derivative of the Cauchy coordinates' map, which is holomorphic.

    Its determinant ``|f'|^2`` is never negative: where it is not injective ``f'`` vanishes. The
    turns of ``f'`` along the boundary count them; ``None`` where it is not proved not to vanish on
    the boundary itself.
    """
    problem = case.problem
    proof = certify(cauchy_point_to_point(problem.domain, problem.pose, P2P_WEIGHT))
    return proof.winding if (proof.panels.sigma2_lower > 0).all() else None


def on_mesh(map_: HarmonicMap | MeshMap, mesh: Triangulation) -> MeshMap:
    """A map of the mesh, piecewise linear."""
    return map_ if isinstance(map_, MeshMap) else MeshMap(mesh, map_(mesh.vertices))


def draw(cases: list[Measurement], path: Path) -> None:
    """A row for each shape, a column for each method; what is turned over stands out."""
    names = [name for name in METHODS if all(name in data["methods"] for data in cases)]
    figure = drawing.figure(1.75 * len(names), 1.9 * len(cases))
    grid = figure.subplots(len(cases), len(names), squeeze=False)
    for row, data in zip(grid, cases, strict=True):
        for axes, name in zip(row, names, strict=True):
            _draw_folds(axes, data, name)
            found = data["methods"][name]
            count = f"{found['flips']:,} flipped, {percent(found['share'])}"
            title = f"{METHODS[name][0]}\n" if data is cases[0] else ""
            axes.set_title(title + (count if found["flips"] else "none flipped"), fontsize=SMALL)
        row[0].text(
            -0.04, 0.5, data["name"], transform=row[0].transAxes, fontsize=SMALL, rotation=90,
            ha="right", va="center",
        )  # fmt: skip
    drawing.save(figure, path)


def _draw_folds(axes: Any, data: Measurement, name: str) -> None:
    arrays = data["arrays"]
    images, triangles = arrays[f"images_{name}"], arrays["triangles"]
    map_ = MeshMap(Triangulation(arrays["mesh"], triangles, 0), images)
    corners = images[triangles]
    # Sheets show through one another; the turned-over ones lie on top, dark in grey as in colour.
    axes.add_collection(
        PolyCollection(list(corners[~map_.flipped]), facecolors=SKY, lw=0, alpha=0.45)
    )
    if map_.flipped.any():
        turned = corners[map_.flipped]
        axes.add_collection(PolyCollection(list(turned), facecolors=INK, edgecolors=INK, lw=0.2))
        # Folds can be slivers: a ring says where to look for one that would be overlooked.
        least = _RING * float(np.ptp(images, axis=0).max())
        group = _groups(triangles[map_.flipped])
        for part in (turned[group == i] for i in range(group.max() + 1)):
            middle = part.mean(axis=(0, 1))
            radius = max(least, 1.2 * float(np.linalg.norm(part - middle, axis=-1).max()))
            if radius < _LARGEST_RING * least:
                axes.add_patch(Circle(middle, radius, fill=False, edgecolor=VERMILION, lw=0.9))
    outline = _outline(triangles)
    axes.add_collection(
        PolyCollection(list(images[outline]), facecolors="none", edgecolors=INK, lw=HAIRLINE)
    )
    targets = arrays["targets"]
    axes.scatter(targets[:, 0], targets[:, 1], s=9, color=CYAN, edgecolors=INK, lw=0.4, zorder=3)
    # The box stays as it is, so that titles stand in a line.
    axes.set_aspect("equal", adjustable="datalim")
    axes.autoscale_view()
    axes.set_axis_off()


def _groups(triangles: Array) -> Array:
    """(t,) which triangles hang together by shared vertices, counted from 0."""
    used, corner = np.unique(triangles, return_inverse=True)
    corner = corner.reshape(triangles.shape)
    ends = (np.repeat(corner[:, 0], 2), corner[:, 1:].ravel())
    graph = scipy.sparse.coo_matrix((np.ones(len(ends[0])), ends), (len(used), len(used)))
    return scipy.sparse.csgraph.connected_components(graph, directed=False)[1][corner[:, 0]]


def _outline(triangles: Array) -> Array:
    """(e, 2) edges that belong to one triangle."""
    edges = np.sort(np.concatenate([triangles[:, [a, b]] for a, b in ((0, 1), (1, 2), (2, 0))]))
    unique, counts = np.unique(edges, axis=0, return_counts=True)
    return unique[counts == 1]
