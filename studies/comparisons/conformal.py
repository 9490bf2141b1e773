"""Advanced MIPS against the conformal map of least isometric distortion (Figure 5)."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from glid_nb.energies import AMIPS
from glid_nb.figures.style import SMALL
from studies.comparisons import drawing
from studies.comparisons.cases import Case
from studies.comparisons.store import Measurement
from studies.comparisons.two_maps import Setting, draw_one, measure_maps

_MOST, _MOST_K = 4.0, 0.5
_TITLES = {"amips": "Advanced MIPS", "conformal": "conformal, least isometric distortion"}


def measure(case: Case, detail: Callable[[str], None]) -> Measurement:
    """Both maps."""
    settings = {
        "amips": Setting(energy=AMIPS(1.0)),
        "conformal": Setting(settings={"conformal": True}),
    }
    return measure_maps(case, detail, settings)


def draw(data: Measurement, path: Path) -> None:
    """Both maps, coloured by the isometric and by the conformal distortion."""
    figure = drawing.figure(11.0, 3.7)
    axes = figure.subplots(1, 4)
    pairs = (axes[:2], axes[2:])
    iso = dilatation = None
    for left, right, (name, title) in zip(*pairs, _TITLES.items(), strict=True):
        run = data["runs"][name]
        iso = draw_one(left, data, name, _MOST)
        left.set_title(
            f"{title}\n$E_{{iso}}$: mean {run['mean']:.3f}, maximum {run['most']:.1f}",
            fontsize=SMALL,
        )
        dilatation = draw_one(right, data, name, _MOST_K, data["arrays"][f"k_{name}"])
        right.set_title(f"{title}\n$k \\leq$ {run['bounds'][0]:.2g} (proved)", fontsize=SMALL)
    drawing.color_bar(figure, iso, pairs[0], "symmetric Dirichlet density")
    drawing.color_bar(figure, dilatation, pairs[1], "little dilatation $k$")
    drawing.save(figure, path)
