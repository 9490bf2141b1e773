"""Maps within bounds on their distortion against ours without (Figure 2)."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from glid_nb.figures.style import BLUE, LINE, ORANGE, SMALL, VERMILION
from glid_nb.methods.bdhm.methods import TOLERANCE
from studies.comparisons import drawing, paper
from studies.comparisons.cases import Case
from studies.comparisons.store import Measurement
from studies.comparisons.two_maps import Setting, draw_one, measure_maps

BOUNDS = {"bdhm": paper.FIGURE_2["asked"], "tight": (0.25, 1.9, 0.45)}
"""k, sigma_1 and sigma_2 asked of BDHM: the paper's, and tighter ones."""
WITHIN = 0.95
"""The share of the way from an isometry to a bound from which on it binds."""
_TITLES = {
    "bdhm": ("BDHM", VERMILION),
    "tight": ("BDHM, tighter", ORANGE),
    "newton": ("ours, no bounds", BLUE),
}
_MOST = 4.0


def measure(case: Case, detail: Callable[[str], None]) -> Measurement:
    """BDHM within two sets of bounds, and our solver."""
    settings = {
        name: Setting(
            "bdhm",
            settings={"k": k, "sigma1": sigma1, "sigma2": sigma2, "tolerance": TOLERANCE},
            slow=True,
        )
        for name, (k, sigma1, sigma2) in BOUNDS.items()
    }
    measured = measure_maps(case, detail, {**settings, "newton": Setting()})
    return {**measured, "tolerance": TOLERANCE}


def draw(data: Measurement, path: Path) -> None:
    """The maps with the bounds that are asked for and proved, and the energies."""
    # High enough for the maps to be as wide as they can, whose titles are then not cut off.
    figure = drawing.figure(13.0, 3.7)
    axes = figure.subplots(1, 4, width_ratios=(1, 1, 1, 1))
    colors = None
    for ax, (name, (title, _)) in zip(axes, _TITLES.items(), strict=False):
        colors = draw_one(ax, data, name, _MOST)
        asked = _bounds(BOUNDS[name], "asked") if name in BOUNDS else "nothing asked"
        proved = _bounds(data["runs"][name]["bounds"], "proved")
        ax.set_title(f"{title}\n{asked}\n{proved}", fontsize=SMALL)
    drawing.color_bar(figure, colors, axes[:3], "symmetric Dirichlet density")
    for name, (title, color) in _TITLES.items():
        run = data["runs"][name]
        energy = drawing.values_of(run["energy"])
        excess = energy / energy.min() - 1
        keep = (excess > 0) & (np.arange(len(excess)) > 0)
        axes[3].semilogy(
            np.array(run["time"])[keep], excess[keep], color=color, lw=LINE, label=title,
            marker=".", ms=3,
        )  # fmt: skip
    axes[3].set_xscale("log")
    drawing.label_axes(axes[3], "seconds", "energy above its least, relative")
    axes[3].legend(fontsize=SMALL, frameon=False)
    drawing.save(figure, path)


def _bounds(values: tuple[float, float, float], verb: str) -> str:
    k, sigma1, sigma2 = (f"{value:.2f}" for value in values)
    return f"{verb}: $k \\leq {k}$, $\\sigma_1 \\leq {sigma1}$, $\\sigma_2 \\geq {sigma2}$"
