"""What the canvas can show over the picture: names, ranges, colours."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glid_nb.energies import AMIPS, ARAP, Energy, ExponentialSymmetricDirichlet, SymmetricDirichlet
from glid_nb.solvers.restarts import isometry_energy

# Ten evenly spaced colours of `imaging.style.distortion_colors`; the first canvas does not wait for
# matplotlib to say so.
_COLORS = (
    "#fcf4b6",
    "#fecc8f",
    "#fea16e",
    "#f8765c",
    "#e75263",
    "#c43c75",
    "#a02f7f",
    "#7b2382",
    "#57157e",
    "#331067",
)
N_COLORS = len(_COLORS)
"""Stops of the colour map in the shader."""

FULL_MARGIN = 0.5
"""A certified sigma_2 from which on a panel of the boundary has the palest colour."""

# The kinds that picture.frag knows.
_KINDS: dict[type[Energy], int] = {
    SymmetricDirichlet: 0,
    ExponentialSymmetricDirichlet: 1,
    AMIPS: 2,
    ARAP: 3,
}


@dataclass(frozen=True)
class Overlay:
    """One way to colour the shape."""

    number: int
    """As ``picture.frag`` counts them."""
    label: str
    """What a menu calls it."""


OVERLAYS: dict[str, Overlay] = {
    "texture": Overlay(0, "Picture"),
    "mesh": Overlay(1, "Picture and grid"),
    "sigma1": Overlay(2, "Stretch σ₁"),
    "sigma2": Overlay(3, "Stretch σ₂"),
    "k": Overlay(4, "Dilatation k"),
    "energy": Overlay(5, "Energy density"),
}
"""By the name of the trait ``DeformCanvas.overlay``."""


def energy_kind(energy: Energy) -> tuple[float, float] | None:
    """The kind of an energy in the shader and its parameter; None for a user's own function."""
    kind = _KINDS.get(type(energy))
    return None if kind is None else (float(kind), float(getattr(energy, "s", 1.0)))


def color_range(name: str, energy: Energy) -> tuple[float, float]:
    """The values at the pale and at the dark end of the colour map.

    Fixed, so that colours mean the same from frame to frame and from picture to picture.
    """
    if name == "sigma1":
        return 1.0, 3.0
    if name == "sigma2":
        return 1.0, 0.0
    if name == "k":
        return 0.0, 1.0
    if name == "energy":
        least = isometry_energy(energy)
        return least, least + 4.0 * max(least, 1.0)
    return 0.0, 1.0


def color_stops() -> NDArray[np.float64]:
    """(n, 3) colours, evenly spaced, from isometric to distorted."""
    return np.array([[int(color[i : i + 2], 16) / 255 for i in (1, 3, 5)] for color in _COLORS])


def legend(name: str, energy: Energy) -> dict[str, Any]:
    """The colour bar as the page draws it; empty where there is nothing to explain."""
    if OVERLAYS[name].number < 2 or (name == "energy" and energy_kind(energy) is None):
        return {}
    low, high = color_range(name, energy)
    ticks = np.linspace(low, high, 5 if name == "energy" else 3)
    return {
        "title": OVERLAYS[name].label,
        "colors": list(_COLORS),
        "ticks": [f"{value:.3g}" for value in ticks],
    }


def panel_legend() -> dict[str, Any]:
    """The colour bar of the boundary's panels, as the page draws it."""
    return {
        "title": "Certified σ₂ on the boundary",
        "colors": list(_COLORS),
        "ticks": [f"≥ {FULL_MARGIN:g}", f"{FULL_MARGIN / 2:g}", "0"],
    }
