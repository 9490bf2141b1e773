"""Easing: how the time between two keyframes passes, as a monotone map of [0, 1] to itself.

Such a map only chooses when each map of a motion appears, so it adds no map to the motion.
"""

from collections.abc import Callable
from numbers import Real
from typing import Any, Literal, cast

import numpy as np

from glid_nb._arguments import unmet
from glid_nb._arrays import Array
from glid_nb.motion.errors import MotionError

Named = Literal["linear", "in", "out", "in-out", "hold"]
Handles = tuple[float, float, float, float]
Easing = Named | Handles
"""A name, or the handles (x1, y1, x2, y2) of a cubic Bezier curve from (0, 0) to (1, 1), as in CSS.

x is the share of the time that has passed, y the share of the way. Both handles lie in the unit
square, so x and y increase along the curve.
"""

_HELD = 0.99  # share of the time for which "hold" stays; then it moves evenly, through all maps
_HALVINGS = 53  # bits of a double
_NAMED: dict[Named, Callable[[float], float]] = {
    "linear": lambda s: s,
    "in": lambda s: s * s,
    "out": lambda s: s * (2 - s),
    "in-out": lambda s: s * s * (3 - 2 * s),
    "hold": lambda s: max(s - _HELD, 0.0) / (1 - _HELD),
}


def checked_easing(name: str, value: Any) -> Easing:
    """The easing, with its handles as floats; MotionError if it is not valid."""
    if not isinstance(value, list | tuple | np.ndarray):
        if wanted := unmet(Named, value):
            handles = "the handles (x1, y1, x2, y2) of a curve"
            raise MotionError(f"{name} is {value!r:.60}; it must be {wanted}, or {handles}")
        return value
    handles = list(value)
    if len(handles) != 4 or any(unmet(float, one, {"least": 0, "most": 1}) for one in handles):
        wanted = "four numbers from 0 to 1, the handles (x1, y1, x2, y2) of a curve"
        raise MotionError(f"{name} is {value!r:.60}; it must be {wanted}")
    return cast(Handles, tuple(map(float, handles)))


def checked_easings(given: Any, count: int) -> tuple[Easing, ...]:
    """One easing for each interval; a single one holds for all."""
    several = isinstance(given, list | tuple) and not (given and isinstance(given[0], Real))
    values = given if several else [given] * count
    if len(values) != count:
        raise MotionError(f"easing has {len(values)} values for {count} intervals; give {count}")
    return tuple(checked_easing(f"easing[{i}]", value) for i, value in enumerate(values))


def eased(easing: Easing, share: float) -> float:
    """The share of the way after a share of the time."""
    if isinstance(easing, str):
        return _NAMED[easing](share)
    x1, y1, x2, y2 = easing
    low, high = 0.0, 1.0
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        if _bezier(x1, x2, middle) < share:
            low = middle
        else:
            high = middle
    return min(max(_bezier(y1, y2, high), 0.0), 1.0) if 0 < share < 1 else share


def sample_times(easing: Easing, start: float, end: float, count: int) -> Array:
    """``count + 1`` times from where an interval begins to move to its end, denser where the easing
    is steep."""
    if easing == "hold":
        start += _HELD * (end - start)
    times = np.linspace(start, end, count + 1)
    if not isinstance(easing, str):
        shares = _bezier(easing[0], easing[2], np.linspace(0, 1, count + 1)[1:-1])
        times[1:-1] = start + shares * (end - start)
    return times


def _bezier(first: Any, second: Any, t: Any) -> Any:
    """A coordinate of the curve whose handles have these coordinates."""
    return t * (3 * (1 - t) * ((1 - t) * first + t * second) + t * t)
