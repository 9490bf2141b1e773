"""The symmetric Dirichlet energy against its exponential (Figure 6)."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from glid_nb.energies import ExponentialSymmetricDirichlet
from glid_nb.figures.style import SMALL
from studies.comparisons import drawing
from studies.comparisons.cases import Case
from studies.comparisons.store import Measurement
from studies.comparisons.two_maps import Setting, draw_one, measure_maps

_MOST = 12.0


def measure(case: Case, detail: Callable[[str], None]) -> Measurement:
    """Both maps."""
    settings = {"iso": Setting(), "exp": Setting(energy=ExponentialSymmetricDirichlet(1.0))}
    return measure_maps(case, detail, settings)


def draw(data: Measurement, path: Path) -> None:
    """Both maps with the mean and the maximum of the density."""
    figure = drawing.figure(9.5, 3.6)
    axes = figure.subplots(1, 2)
    most = min(1.02 * data["runs"]["iso"]["most"], _MOST)
    colors = None
    for ax, (name, title) in zip(axes, (("iso", "$E_{iso}$"), ("exp", "$E_{exp}$")), strict=True):
        colors = draw_one(ax, data, name, most)
        run = data["runs"][name]
        ax.set_title(
            f"minimises {title}: mean {run['mean']:.3f}, maximum {run['most']:.2f}", fontsize=SMALL
        )
    drawing.color_bar(figure, colors, axes, "symmetric Dirichlet density")
    drawing.save(figure, path)
