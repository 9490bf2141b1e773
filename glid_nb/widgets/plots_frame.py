"""The layout of a solve's plots, and a placeholder without matplotlib."""

from __future__ import annotations

from typing import NamedTuple

from glid_nb.figures.style import FAINT, GREY

# CSS pixels. A plot's legend is above it; ticks and the axis's name are below.
_LEFT, _RIGHT, _ABOVE, _BELOW = 44, 8, 20, 32
_ABOVE_UPPER = 31
_BETWEEN = 46  # room for the right plot's ticks
_TIME_GAP = 17
_UPPER_SHARE, _TIME_SHARE = 0.56, 0.28
_TEXT = 11


class Box(NamedTuple):
    """The inside of a plot's axes, CSS pixels from the upper left."""

    x: float
    y: float
    width: float
    height: float


class Boxes(NamedTuple):
    """Energy on the left, steps and times on the right; the certificate below them."""

    energy: Box
    steps: Box
    times: Box
    certificate: Box


def plot_boxes(width: int, height: int) -> Boxes:
    """The place of each plot in a picture of this size in CSS pixels."""
    inside = height - _ABOVE_UPPER - _ABOVE - 2 * _BELOW
    upper = _UPPER_SHARE * inside
    column = (width - _LEFT - _RIGHT - _BETWEEN) / 2
    right = _LEFT + column + _BETWEEN
    times = _TIME_SHARE * upper
    steps = upper - times - _TIME_GAP
    lower = _ABOVE_UPPER + upper + _BELOW + _ABOVE
    return Boxes(
        Box(_LEFT, _ABOVE_UPPER, column, upper),
        Box(right, _ABOVE_UPPER, column, steps),
        Box(right, _ABOVE_UPPER + steps + _TIME_GAP, column, times),
        Box(_LEFT, lower, width - _LEFT - _RIGHT, height - _BELOW - lower),
    )


def placeholder(width: int, height: int) -> bytes:
    """Empty axes with their names, as an SVG of this size in CSS pixels."""
    names = ("energy", "steps", "time per iteration", "certificate")
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
        f'font-family="sans-serif" font-size="{_TEXT}" text-anchor="middle">'
        '<rect width="100%" height="100%" fill="#fff"/>'
    ]
    for box, name in zip(plot_boxes(width, height), names, strict=True):
        parts.append(
            f'<path d="M{box.x:g} {box.y:g}v{box.height:g}h{box.width:g}" fill="none" '
            f'stroke="{FAINT}"/><text x="{box.x + box.width / 2:g}" '
            f'y="{box.y + box.height / 2 + _TEXT / 3:g}" fill="{GREY}">{name}</text>'
        )
    return "".join([*parts, "</svg>"]).encode()
