"""Linear methods fold; ours does not."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.collections import PolyCollection
from numpy.typing import NDArray

from glid_nb.figures.style import CYAN, HAIRLINE, INK, SKY, SMALL, VERMILION
from glid_nb.geometry import MeshMap, Triangulation, triangulate
from glid_nb.harmonic import HarmonicMap
from glid_nb.methods import available
from studies import figures
from studies.cases import Case
from studies.compare.shapes import all_shapes
from studies.runs import MESH_VERTICES, run
from studies.store import Measurement
from studies.study import Plan, Study, on_cases
from studies.tables import Row, percent

Array = NDArray[Any]

METHODS: Mapping[str, tuple[str, str, Mapping[str, Any]]] = {
    "newton": ("ours", "newton", {}),
    "mls": ("moving least squares", "mls", {}),
    "bbw": ("bounded biharmonic weights", "bbw", {}),
    "harmonic": ("harmonic weights", "harmonic-weights", {"power": 1}),
    "biharmonic": ("biharmonic weights", "harmonic-weights", {"power": 2}),
    "mean-value": ("mean value coordinates", "mean-value", {}),
    "cauchy": ("Cauchy coordinates", "cauchy", {}),
}
"""For each: its title on the page, the method, and its settings."""


def measure(case: Case, plan: Plan) -> Measurement:
    """Every method's images of one mesh, and the flipped triangles."""
    problem = case.problem
    mesh = triangulate(problem.domain.cage, MESH_VERTICES, points=problem.pose.handles)
    rest = MeshMap(mesh, mesh.vertices).areas
    known = available()
    measured: dict[str, Any] = {}
    arrays = {"mesh": mesh.vertices, "triangles": mesh.triangles, "targets": problem.pose.targets}
    for name, (title, method, settings) in METHODS.items():
        if method not in known:
            continue
        plan.detail(f"{case.name}: {title}")
        result = run(method, case, mesh=mesh, **settings)
        map_ = result.map
        if isinstance(map_, HarmonicMap):
            map_ = MeshMap(mesh, map_(mesh.vertices))
        measured[name] = {
            "flips": int(map_.flipped.sum()),
            "share": float(rest[map_.flipped].sum() / rest.sum()),
            "proved": result.certificate.certified if result.certificate else None,
        }
        arrays[f"images_{name}"] = map_.images
    return {"triangles": len(mesh.triangles), "methods": measured, "arrays": arrays}


def draw(cases: list[Measurement], folder: Path) -> None:
    """A row for each shape, a column for each method; flipped triangles stand out."""
    names = [name for name in METHODS if all(name in data["methods"] for data in cases)]
    figure = figures.figure(1.75 * len(names), 1.9 * len(cases))
    grid = figure.subplots(len(cases), len(names), squeeze=False)
    for row, data in zip(grid, cases, strict=True):
        for axes, name in zip(row, names, strict=True):
            _draw_folds(axes, data, name)
            found = data["methods"][name]
            count = f"{found['flips']:,} flipped, {percent(found['share'])}"
            label = METHODS[name][0].replace(" weights", "\nweights")
            axes.set_title(f"{label}\n{count}" if data is cases[0] else count, fontsize=SMALL)
        row[0].annotate(data["name"], (-0.1, 0.5), xycoords="axes fraction", ha="right")
    figures.save(figure, folder / "folding.webp")


def _draw_folds(axes: Any, data: Measurement, name: str) -> None:
    arrays = data["arrays"]
    images, triangles = arrays[f"images_{name}"], arrays["triangles"]
    map_ = MeshMap(Triangulation(arrays["mesh"], triangles, 0), images)
    corners = images[triangles]
    # Sheets are transparent. Flipped triangles lie on top, and are dark in greyscale prints too.
    upright = list(corners[~map_.flipped])
    axes.add_collection(PolyCollection(upright, facecolors=SKY, lw=0, alpha=0.45))
    if map_.flipped.any():
        # Folds can be slivers, so their edges are drawn wide enough to be seen.
        turned = list(corners[map_.flipped])
        axes.add_collection(PolyCollection(turned, facecolors=INK, edgecolors=VERMILION, lw=1.2))
    outline = list(images[outline_of(triangles)])
    axes.add_collection(PolyCollection(outline, facecolors="none", edgecolors=INK, lw=HAIRLINE))
    targets = arrays["targets"]
    axes.scatter(targets[:, 0], targets[:, 1], s=9, color=CYAN, edgecolors=INK, lw=0.4, zorder=3)
    # The box keeps its size, so that the titles are in one line.
    axes.set_aspect("equal", adjustable="datalim")
    axes.autoscale_view()
    axes.set_axis_off()


def outline_of(triangles: Array) -> Array:
    """(e, 2) edges that belong to one triangle only."""
    edges = np.sort(np.concatenate([triangles[:, [a, b]] for a, b in ((0, 1), (1, 2), (2, 0))]))
    unique, counts = np.unique(edges, axis=0, return_counts=True)
    return unique[counts == 1]


def tables(found: list[Measurement]) -> dict[str, list[Row]]:
    """Numbers of flipped triangles, and their shares of the area."""
    rows: list[Row] = []
    for data in found:
        folds = {
            METHODS[name][0]: f"{one['flips']:,} ({percent(one['share'])})" if one["flips"] else "0"
            for name, one in data["methods"].items()
        }
        rows.append({"shape": data["name"], "triangles": f"{data['triangles']:,}", **folds})
    return {"folding": rows}


STUDY = Study("folding", on_cases(all_shapes, measure), tables, draw)
