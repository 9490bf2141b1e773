"""Maps of one pose by different settings, side by side (Figures 2, 5 and 6)."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glid_nb.energies import Energy
from glid_nb.geometry import Triangulation, uniform_boundary_samples
from glid_nb.harmonic import HarmonicMap
from glid_nb.methods import MethodResult
from studies.comparisons import drawing
from studies.comparisons.cases import Case
from studies.comparisons.distortion import density_at
from studies.comparisons.runs import display_mesh, last_of, outcome, run
from studies.comparisons.store import Measurement

Array = NDArray[Any]

_BOUNDARY_SAMPLES = 4_000
_DISPLAY = 6_000
_RUNS = 3


@dataclass(frozen=True)
class Setting:
    """A method, its energy and what else it is told."""

    method: str = "newton"
    energy: Energy | None = None
    settings: Mapping[str, Any] = field(default_factory=dict)
    slow: bool = False
    """Run once, after two iterations that compile its programs."""


def measure_maps(
    case: Case, detail: Callable[[str], None], settings: Mapping[str, Setting]
) -> Measurement:
    """The map of each setting, after the rigid alignment, with its distortion."""
    display = display_mesh(case, _DISPLAY)
    arrays: dict[str, Array] = {
        "display": display.vertices,
        "display_triangles": display.triangles,
        "targets": case.problem.pose.targets,
    }
    measured = {}
    for name, setting in settings.items():
        detail(f"{case.name}: {name}")
        arguments = (setting.method, case, setting.energy)
        options = {"align": True, **setting.settings}
        if setting.slow:
            run(*arguments, **{**options, "max_iterations": 2})
        result = last_of(1 if setting.slow else _RUNS, *arguments, **options)
        map_ = result.map
        assert isinstance(map_, HarmonicMap)
        measured[name] = {**outcome(result), **_distortion(case, result, display)}
        arrays[f"images_{name}"] = map_(display.vertices)
        arrays[f"reached_{name}"] = np.asarray(map_(case.problem.pose.handles))
        arrays[f"k_{name}"] = map_.k(display.vertices[display.triangles].mean(axis=1))
    return {
        "name": case.name,
        "holes": case.problem.domain.n_holes,
        "runs": measured,
        "arrays": arrays,
    }


def _distortion(case: Case, result: MethodResult, display: Triangulation) -> dict[str, float]:
    """Mean over the boundary and maximum over the domain of the symmetric Dirichlet density."""
    map_ = result.map
    assert isinstance(map_, HarmonicMap)
    z = uniform_boundary_samples(case.problem.domain.cage, _BOUNDARY_SAMPLES).points
    boundary, inside = np.stack([np.real(z), np.imag(z)], axis=-1), display.vertices
    density = [density_at(map_, points) for points in (boundary, inside)]
    return {
        "mean": float(density[0].mean()),
        "most": float(max(d.max() for d in density)),
    }


def draw_one(
    axes: Any, data: Measurement, name: str, most: float, values: Array | None = None
) -> Any:
    """One of the maps, coloured by the symmetric Dirichlet density or by ``values``."""
    arrays = data["arrays"]
    pose = np.hstack([arrays["targets"], arrays[f"reached_{name}"]])
    return drawing.draw_map(
        axes,
        arrays["display"],
        arrays["display_triangles"],
        arrays[f"images_{name}"],
        pose,
        most,
        values,
    )
