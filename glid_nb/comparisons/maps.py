"""Comparisons of two maps of one pose (Figures 2, 5 and 6)."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glid_nb.compare import MethodResult
from glid_nb.comparisons import drawing
from glid_nb.comparisons.cases import Case
from glid_nb.comparisons.runs import display_mesh, run_recorded, summary
from glid_nb.comparisons.store import Measurement
from glid_nb.energies import AMIPS, ExponentialSymmetricDirichlet
from glid_nb.geometry import Triangulation, uniform_boundary_samples
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging.style import LINE, SMALL

Array = NDArray[Any]

BDHM_BOUNDS = (0.8, 5.0, 0.3)
"""k, sigma_1 and sigma_2 of Figure 2."""
_BOUNDARY_SAMPLES = 4_000
_DISPLAY = 6_000


def measure_bounded(case: Case, detail: Callable[[str], None]) -> Measurement:
    """Figure 2: BDHM within bounds against ours without."""
    k, sigma1, sigma2 = BDHM_BOUNDS
    return _measure(
        case,
        detail,
        {
            "bdhm": (
                "bdhm",
                None,
                {"k": k, "sigma1": sigma1, "sigma2": sigma2, "tolerance": 1e-3, "align": True},
            ),
            "newton": ("newton", None, {"align": True}),
        },
    )


def measure_conformal(case: Case, detail: Callable[[str], None]) -> Measurement:
    """Figure 5: AMIPS against the conformal map of least isometric distortion."""
    return _measure(
        case,
        detail,
        {
            "amips": ("newton", AMIPS(1.0), {"align": True}),
            "conformal": ("newton", None, {"align": True, "conformal": True}),
        },
    )


def measure_exponential(case: Case, detail: Callable[[str], None]) -> Measurement:
    """Figure 6: the symmetric Dirichlet energy against its exponential."""
    return _measure(
        case,
        detail,
        {
            "iso": ("newton", None, {"align": True}),
            "exp": ("newton", ExponentialSymmetricDirichlet(1.0), {"align": True}),
        },
    )


def _measure(
    case: Case, detail: Callable[[str], None], runs: dict[str, tuple[str, Any, dict[str, Any]]]
) -> Measurement:
    display = display_mesh(case, _DISPLAY)
    arrays: dict[str, Array] = {
        "display": display.vertices,
        "display_triangles": display.triangles,
        "targets": case.problem.pose.targets,
    }
    measured = {}
    for name, (method, energy, settings) in runs.items():
        detail(f"{case.name}: {name}")
        result, images = run_recorded(
            method, case, display, display, energy, iterates=False, **settings
        )
        measured[name] = {**summary(result, images), **_distortion(case, result, display)}
        arrays[f"images_{name}"] = images[-1]
        arrays[f"reached_{name}"] = np.asarray(result.map(case.problem.pose.handles))
        assert isinstance(result.map, HarmonicMap)
        arrays[f"k_{name}"] = result.map.k(display.vertices[display.triangles].mean(axis=1))
    return {"name": case.name, "runs": measured, "arrays": arrays}


def _distortion(case: Case, result: MethodResult, display: Triangulation) -> dict[str, float]:
    """Mean over the boundary and maximum over the domain of the symmetric Dirichlet density."""
    map_ = result.map
    assert isinstance(map_, HarmonicMap)
    z = uniform_boundary_samples(case.problem.domain.cage, _BOUNDARY_SAMPLES).points
    boundary, inside = np.stack([np.real(z), np.imag(z)], axis=-1), display.vertices
    density = []
    for points in (boundary, inside):
        s1, s2 = map_.sigma1(points), map_.sigma2(points)
        density.append((s1**2 + s2**2 + s1**-2 + s2**-2) / 2)
    return {
        "mean": float(density[0].mean()),
        "mean_inside": float(density[1].mean()),
        "most": float(max(d.max() for d in density)),
    }


def draw_bounded(data: Measurement, path: Path) -> None:
    """Both maps with the bounds that are proved of them, and the energy of BDHM."""
    figure = drawing.figure(10.5, 3.4)
    axes = figure.subplots(1, 3, width_ratios=(1, 1, 0.9))
    titles = {"bdhm": "BDHM", "newton": "ours, no bounds asked for"}
    colors = None
    for ax, (name, title) in zip(axes, titles.items(), strict=False):
        run = data["runs"][name]
        colors = _draw_one(ax, data, name, 3.0)
        k, sigma1, sigma2 = run["bounds"]
        ax.set_title(
            f"{title}\n$k \\leq {k:.2f}$, $\\sigma_1 \\leq {sigma1:.2f}$, "
            f"$\\sigma_2 \\geq {sigma2:.2f}$ (proved)",
            fontsize=SMALL,
        )
    drawing.color_bar(figure, colors, axes[1], "symmetric Dirichlet density")
    for name in titles:
        run = data["runs"][name]
        label, color, style = drawing.LOOK[name]
        energy = drawing.gap(run["energy"])
        excess = energy - energy.min()
        keep = (excess > 0) & (np.arange(len(excess)) > 0)
        axes[2].semilogy(
            np.array(run["time"])[keep], excess[keep], style, color=color, lw=LINE, label=label,
            marker=".", ms=3,
        )  # fmt: skip
    axes[2].set_xscale("log")
    drawing.label_axes(axes[2], "seconds", "energy above its least (each its own)")
    axes[2].legend(fontsize=SMALL, frameon=False)
    drawing.save(figure, path)


def draw_conformal(data: Measurement, path: Path) -> None:
    """Both maps, coloured by the isometric and by the conformal distortion."""
    figure = drawing.figure(9.5, 6.6)
    axes = figure.subplots(2, 2)
    for column, (name, title) in enumerate(
        (("amips", "Advanced MIPS"), ("conformal", "conformal, least isometric distortion"))
    ):
        iso = _draw_one(axes[0][column], data, name, 4.0)
        run = data["runs"][name]
        axes[0][column].set_title(f"{title}\nmean $E_{{iso}}$ {run['mean']:.3f}", fontsize=SMALL)
        dilatation = _draw_one(axes[1][column], data, name, 0.5, data["arrays"][f"k_{name}"])
        axes[1][column].set_title(f"largest $k$: {run['bounds'][0]:.3g} (proved)", fontsize=SMALL)
        if column:
            drawing.color_bar(figure, iso, axes[0][column], "symmetric Dirichlet density")
            drawing.color_bar(figure, dilatation, axes[1][column], "little dilatation $k$")
    drawing.save(figure, path)


def draw_exponential(data: Measurement, path: Path) -> None:
    """Both maps with the mean and the maximum of the density."""
    figure = drawing.figure(9.5, 3.6)
    axes = figure.subplots(1, 2)
    most = min(1.02 * data["runs"]["iso"]["most"], 12.0)
    colors = None
    for ax, (name, title) in zip(axes, (("iso", "$E_{iso}$"), ("exp", "$E_{exp}$")), strict=True):
        colors = _draw_one(ax, data, name, most)
        run = data["runs"][name]
        ax.set_title(
            f"minimises {title}: mean {run['mean']:.3f}, maximum {run['most']:.2f}", fontsize=SMALL
        )
    drawing.color_bar(figure, colors, axes[1], "symmetric Dirichlet density")
    drawing.save(figure, path)


def _draw_one(
    axes: Any, data: Measurement, name: str, most: float, values: Array | None = None
) -> Any:
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
