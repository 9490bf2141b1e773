"""A picture that the tests of the tracer share, and where its parts lie."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from glid_nb.session.tracing import TracingModel


def drawing() -> NDArray[np.uint8]:
    """A teal disc with two holes and a smaller disc beside it, on white."""
    y, x = np.mgrid[:120, :160] + 0.5
    shape = np.hypot(x - 60, y - 60) < 50
    shape &= np.hypot(x - 45, y - 60) > 12
    shape &= np.hypot(x - 80, y - 60) > 9
    shape |= np.hypot(x - 135, y - 60) < 15
    image = np.full((120, 160, 4), 255, np.uint8)
    image[shape] = (20, 130, 130, 255)
    return image


DRAWING = drawing()
IN_LARGE_HOLE, IN_SMALL_HOLE, IN_SMALL_DISC = (45.0, 60.0), (80.0, 60.0), (135.0, 60.0)


def far_vertex(model: TracingModel) -> int:
    """The exterior's leftmost vertex."""
    return int(np.argmin(model.loops[0][:, 0]))
