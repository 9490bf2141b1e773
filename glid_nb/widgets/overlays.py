"""The overlays of the canvas: names, ranges, colours."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from glid_nb._arrays import Array
from glid_nb._jax import jnp
from glid_nb.energies import Energy, isometry_energy
from glid_nb.figures.style import COLORS, FULL_MARGIN

# Green, orange, vermilion: visible on white, on black and beside the overlays' colours.
MARGIN_COLORS = (
    *("#009e73", "#339e59", "#669e40", "#999f26", "#cc9f0d"),
    *("#e49800", "#e08a00", "#dd7b00", "#d96c00", "#d55e00"),
)  # the colours of the certificate, from a wide margin to none

N_COLORS = len(COLORS)  # stops of the colour map in the shader

PANEL_LEGEND = {  # the colour bar of the boundary's panels, for the page
    "title": "Certified σ₂ on the boundary",
    "moving": "σ₂ on the boundary now",
    "colors": list(MARGIN_COLORS),
    "ticks": [f"≥ {FULL_MARGIN:g}", f"{FULL_MARGIN / 2:g}", "0"],
    "about": "The value proved on each panel of the boundary; where it is 0, the map might fold",
}

_MOST_DIGITS = 22  # of all labels of a colour bar together
_SHARE = 0.98  # of the boundary, where distortion is largest, is within a colour map's range


@dataclass(frozen=True)
class Overlay:
    """One way to colour the shape."""

    number: int  # its number in ``picture.frag``
    label: str  # its name in menus
    values: Callable[[Array, Array], Array] | None = None
    """The shown value as a function of ``|f_z|`` and ``|f_zbar|``; None if nothing is computed."""
    start: float = 0.0  # the value of an isometry
    ends: tuple[float, ...] = (1.0,)  # possible ends of the colour map, the narrowest range first
    limits: tuple[float, ...] = ()
    """Ends beyond which no map without folds has values. At another end, the last colour is also
    that of all values beyond it."""


OVERLAYS: dict[str, Overlay] = {
    "texture": Overlay(0, "Picture"),
    "mesh": Overlay(1, "Picture and grid"),
    "sigma1": Overlay(
        2, "Stretch σ₁", lambda r, g: np.maximum(r + g, 1), 1.0, (1.25, 1.5, 2.0, 3.0, 5.0, 10.0)
    ),
    "sigma2": Overlay(
        3, "Stretch σ₂", lambda r, g: np.minimum(r - g, 1), 1.0, (0.8, 0.5, 0.0), (0.0,)
    ),
    "k": Overlay(
        4, "Dilatation k", lambda r, g: g / np.maximum(r, 1e-6), 0.0, (0.1, 0.2, 0.5, 1), (0, 1)
    ),
    "energy": Overlay(5, "Energy density"),
}
"""The overlays by the values of ``DeformCanvas.overlay``. That of "energy" depends on the energy.
"""

# Possible ends for energies, above the energy of an isometry and relative to it.
_ENERGY_ENDS = (0.1, 0.25, 0.5, 1, 2, 4, 10, 50, 200)


def _overlay(name: str, energy: Energy) -> Overlay:
    if name != "energy":
        return OVERLAYS[name]

    def density(r: Array, g: Array) -> Array:
        return np.asarray(energy.density(jnp.asarray(r**2), jnp.asarray(g**2)))

    least = isometry_energy(energy)
    ends = tuple(least + max(least, 1.0) * end for end in _ENERGY_ENDS)
    values = None if energy.shader is None else density
    return replace(OVERLAYS[name], values=values, start=least, ends=ends, limits=(least,))


def color_range(
    name: str,
    energy: Energy,
    fz: Array | None = None,
    fzb: Array | None = None,
    least: tuple[float, float] | None = None,
) -> tuple[float, float]:
    """The colour map's ends: the narrowest of a few round ranges that contains nearly all values
    and is not narrower than ``least``. With few ranges, colours rarely change their meaning."""
    overlay = _overlay(name, energy)
    start, ends = overlay.start, overlay.ends
    wanted = 0.0 if least is None else abs(least[1] - start)
    if overlay.values is not None and fz is not None and fzb is not None:
        away = np.abs(overlay.values(np.abs(fz), np.abs(fzb)) - start)
        wanted = max(wanted, float(np.quantile(away, _SHARE)))
    # ``least`` is one of the ranges, up to rounding.
    return start, next((end for end in ends if abs(end - start) >= wanted - 1e-9), ends[-1])


def legend(name: str, energy: Energy, range_: tuple[float, float]) -> dict[str, Any]:
    """The colour bar for the page; empty if the overlay has none."""
    if OVERLAYS[name].number < 2 or (name == "energy" and energy.shader is None):
        return {}
    overlay, count = _overlay(name, energy), 5 if name == "energy" else 3
    about = "Colours of the shape: pale where nothing is distorted, dark where most is"
    return {
        "title": overlay.label,
        "colors": list(COLORS),
        "ticks": _ticks(*range_, overlay.limits, count),
        "about": about,
    }


def _ticks(low: float, high: float, limits: tuple[float, ...], count: int) -> list[str]:
    """Labels at equal distances, as many as fit beside each other. Those of the ends say which
    values share their colours."""
    texts = [f"{float(f'{value:.3g}'):g}" for value in np.linspace(low, high, count)]
    before, after = ("≤ ", "≥ ") if low < high else ("≥ ", "≤ ")
    if low not in limits:
        texts[0] = before + texts[0]
    if high not in limits:
        texts[-1] = after + texts[-1]
    fits = len("".join(texts)) <= _MOST_DIGITS
    return texts if fits else _ticks(low, high, limits, count - 1)
