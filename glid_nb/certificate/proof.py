"""The proof file: what a certificate claims, exactly, for a checker that shares no code with us.

``docs/checking.md`` documents the format, ``checker/glid_check.py`` reads it.
"""

import json
from collections.abc import Iterable
from typing import Any

import numpy as np

from glid_nb._arrays import Array
from glid_nb._json import json_text
from glid_nb.geometry import Panels

FORMAT = "glid_nb-proof"
FORMAT_VERSION = 1

_MOST_BISECTIONS = 60  # of an edge; more would be below rounding
_ROUNDING = 0.1  # how far rounding moves a panel's middle, in lengths of the panel


def exact_text(values: dict[str, Any]) -> str:
    """Plain values as JSON, with every float as the hexadecimal text of its 64 bits."""
    return json_text(json.loads(json_text(values), parse_float=lambda text: float(text).hex()))


def dyadic_panels(panels: Panels, loops: Iterable[Array]) -> list[list[list[int]]] | None:
    """Per edge of the cage, loop by loop, its pieces ``[k, d]`` from k/2^d to (k+1)/2^d.

    None if the panels do not come from bisecting the edges, such as uniform ones.
    """
    edges = []
    for number, loop in enumerate(loops):
        own = panels.loop == number
        first = np.flatnonzero(np.isin(panels.start[own], loop))
        for start, end, middles in zip(
            loop, np.roll(loop, -1), np.split(panels.middle[own], first[1:]), strict=True
        ):
            places = np.real((middles - start) / (end - start))
            pieces = _bisected(places, 0, 0)
            k, d = np.array(pieces, dtype=float).T
            if len(k) != len(places) or np.abs(places * 2**d - k - 0.5).max() > _ROUNDING:
                return None
            edges.append(pieces)
    return edges


def _bisected(middles: Array, k: int, d: int) -> list[list[int]]:
    """The piece ``[k, d]``, bisected until no part holds the middles of two panels."""
    if len(middles) <= 1 or d == _MOST_BISECTIONS:
        return [[k, d]]
    left = int(np.searchsorted(middles, (2 * k + 1) / 2 ** (d + 1)))
    return [*_bisected(middles[:left], 2 * k, d + 1), *_bisected(middles[left:], 2 * k + 1, d + 1)]
