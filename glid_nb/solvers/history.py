"""What a compiled call recorded, as entries of a result's history."""

from __future__ import annotations

import numpy as np

from glid_nb.solvers import newton
from glid_nb.solvers.result import Iteration


def entries(
    records: newton.Record, taken: int, before: int, panels: int, split: int, seconds: float
) -> list[Iteration]:
    """The ``taken`` iterations of one call.

    Parameters
    ----------
    records : newton.Record
        Arrays of at least ``taken`` values.
    taken, before : int
        How many iterations the call made, and how many there were before it.
    panels, split : int
        Panels of the boundary, and how many of them stem from splits just before the call.
    seconds : float
        Of the whole call, compilation left out; shared evenly.
    """
    rows = zip(*(np.asarray(values)[:taken] for values in records), strict=True)
    return [
        Iteration(
            before + i,
            float(iso + p2p),
            float(iso),
            float(p2p),
            float(step),
            float(decrement),
            float(sigma2),
            bool(modified),
            int(corrections),
            panels,
            split if i == 1 else 0,
            seconds / taken,
        )
        for i, (iso, p2p, step, decrement, sigma2, modified, corrections) in enumerate(
            rows, start=1
        )
    ]
