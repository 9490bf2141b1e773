"""Maps of one pose by different settings, side by side (Figures 2, 5 and 6)."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glid_nb.energies import AMIPS, Energy, ExponentialSymmetricDirichlet
from glid_nb.figures.style import SMALL
from glid_nb.geometry import Triangulation, uniform_panels
from glid_nb.harmonic import HarmonicMap
from studies import figures
from studies.cases import Case
from studies.compare.shapes import some
from studies.distortion import density_at
from studies.runs import display_mesh, outcome, run
from studies.store import Measurement
from studies.study import Plan, Study, on_cases
from studies.tables import Row, seconds

Array = NDArray[Any]

_BOUNDARY_SAMPLES = 4_000
_DISPLAY = 6_000
_RUNS = 3


@dataclass(frozen=True)
class Setting:
    """A method, its energy and its settings."""

    title: str
    method: str = "newton"
    energy: Energy | None = None
    settings: Mapping[str, Any] = field(default_factory=dict)
    slow: bool = False  # timed once only; two iterations before compile its programs


def _bdhm(title: str, k: float, sigma1: float, sigma2: float) -> Setting:
    bounds = {"k": k, "sigma1": sigma1, "sigma2": sigma2}
    return Setting(title, "bdhm", None, {**bounds, "tolerance": 1e-5}, slow=True)


BOUNDED_SETTINGS = {
    "bdhm": _bdhm("BDHM, the paper's bounds", 0.8, 5.0, 0.3),
    "tight": _bdhm("BDHM, tighter bounds", 0.25, 1.9, 0.45),
    "newton": Setting("ours"),
}
CONFORMAL_SETTINGS = {
    "amips": Setting("Advanced MIPS", energy=AMIPS(1.0)),
    "conformal": Setting("conformal, least isometric distortion", settings={"conformal": True}),
}
EXPONENTIAL_SETTINGS = {
    "iso": Setting("minimises $E_{iso}$"),
    "exp": Setting("minimises $E_{exp}$", energy=ExponentialSymmetricDirichlet(1.0)),
}


def measure_maps(case: Case, plan: Plan, settings: Mapping[str, Setting]) -> Measurement:
    """The map of each setting and its distortion, started from the rigid alignment."""
    display = display_mesh(case, _DISPLAY)
    arrays: dict[str, Array] = {
        "display": display.vertices,
        "display_triangles": display.triangles,
        "targets": case.problem.pose.targets,
    }
    measured = {}
    for name, setting in settings.items():
        plan.detail(f"{case.name}: {setting.title}")
        arguments = (setting.method, case, setting.energy)
        options = {"align": True, **setting.settings}
        if setting.slow:
            run(*arguments, **{**options, "max_iterations": 2})
        result = run(*arguments, runs=1 if setting.slow else _RUNS, **options)
        map_ = result.map
        assert isinstance(map_, HarmonicMap)
        measured[name] = {**outcome(result), **_distortion(map_, display.vertices)}
        arrays[f"images_{name}"] = map_(display.vertices)
        arrays[f"reached_{name}"] = np.asarray(map_(case.problem.pose.handles))
    return {"runs": measured, "arrays": arrays}


def _distortion(map_: HarmonicMap, inside: Array) -> dict[str, float]:
    """Mean over the boundary and maximum over the domain of the symmetric Dirichlet density."""
    z = uniform_panels(map_.domain.cage, _BOUNDARY_SAMPLES).start
    boundary = np.stack([np.real(z), np.imag(z)], axis=-1)
    density = [density_at(map_, points) for points in (boundary, inside)]
    return {"mean": float(density[0].mean()), "most": float(max(d.max() for d in density))}


def _rows(found: list[Measurement], settings: Mapping[str, Setting]) -> list[Row]:
    rows = []
    for data in found:
        for name, setting in settings.items():
            one = data["runs"][name]
            asked = [setting.settings.get(bound) for bound in ("k", "sigma1", "sigma2")]
            rows.append(
                {
                    "shape": data["name"],
                    "map": setting.title,
                    "asked (k, sigma_1, sigma_2)": _bounds(asked),
                    "proved": _bounds(one["bounds"]),
                    "mean of E_iso": f"{one['mean']:.3f}",
                    "its maximum": f"{one['most']:.2f}",
                    "iterations": one["iterations"],
                    "time": seconds(one["time"][-1]),
                }
            )
    return rows


def _bounds(values: list[float | None]) -> str:
    return ", ".join(f"{value if value > 1e-9 else 0:.2g}" for value in values if value is not None)


def _draw(name: str, settings: Mapping[str, Setting], data: Measurement, folder: Path) -> None:
    """The maps side by side, coloured by the symmetric Dirichlet density."""
    arrays, rows = data["arrays"], _rows([data], settings)
    most = float(np.clip(min(one["most"] for one in data["runs"].values()), 4.0, 12.0))
    figure = figures.figure(1.5 + 3.4 * len(settings), 3.7)
    axes = figure.subplots(1, len(settings))
    colors = None
    for ax, key, row in zip(axes, settings, rows, strict=True):
        pose = np.hstack([arrays["targets"], arrays[f"reached_{key}"]])
        mesh = Triangulation(arrays["display"], arrays["display_triangles"], 0)
        colors = figures.draw_map(ax, mesh, arrays[f"images_{key}"], pose, most)
        told = f"E_iso: mean {row['mean of E_iso']}, maximum {row['its maximum']}"
        told += f"\nk, sigma_1, sigma_2 proved: {row['proved']}"
        ax.set_title(f"{row['map']}\n{told}", fontsize=SMALL)
    figures.color_bar(figure, colors, axes, "symmetric Dirichlet density")
    figures.save(figure, folder / f"{name}.webp")


def _study(name: str, shapes: Any, settings: Mapping[str, Setting]) -> Study:
    return Study(
        name,
        on_cases(shapes, lambda case, plan: measure_maps(case, plan, settings)),
        lambda found: {name: _rows(found, settings)},
        lambda found, folder: _draw(name, settings, found[0], folder),
    )


BOUNDED = _study("bounded", lambda _: ["gecko-extreme"], BOUNDED_SETTINGS)
CONFORMAL = _study("conformal", some(("archery",), "frog-extreme"), CONFORMAL_SETTINGS)
EXPONENTIAL = _study("exponential", some(("colorbar",), "bar-extreme"), EXPONENTIAL_SETTINGS)
