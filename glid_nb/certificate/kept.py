"""What the proof on a panel needs of the domain alone, kept from map to map.

The rows of the basis and the weights of a proof take most of a proof's time. They do not depend on
the map, so the proofs of other maps on the same panels of equal domains use them again. They are
found by the bits of the panels and of the singularities, so no result depends on what is kept.
"""

import functools
from typing import Any, NamedTuple

import numpy as np

from glid_nb._arrays import Array, read_only
from glid_nb.certificate.panels import PanelProof
from glid_nb.certificate.paper import beside
from glid_nb.harmonic.cauchy import Singularities
from glid_nb.harmonic.rounding import DerivativeRows, derivative_rows

# Chunks of panels (`_runtime.in_chunks`). One takes up to 4.2 MB, so all take at most 100 MB. The
# bundled gecko has 4 chunks, and each round of splitting adds one.
_MOST_CHUNKS = 24


class PanelRows(NamedTuple):
    """What depends on p panels and the domain, but not on the map. All arrays are read-only."""

    ends: DerivativeRows
    """At the (2 p,) ends: first all starts, then all ends."""
    proof: Any
    """A `PanelProof` on the panels."""
    beside: Array
    """(p, n) weights for panel ends beside their edge (:func:`~glid_nb.certificate.paper.beside`).
    """


def panel_rows(
    start: Array, end: Array, singularities: Singularities, kind: type[PanelProof]
) -> PanelRows:
    """The rows for panels with (p,) complex ends. Equal arguments of late give the same object.

    Any thread may call it. Two threads that miss the same panels compute them twice.
    """
    vertices, following, _, holes = singularities
    points = (np.asarray(array, dtype=complex).tobytes() for array in (start, end, vertices, holes))
    return _kept(kind, *points, np.asarray(following, dtype=np.intp).tobytes())


def forget() -> None:
    """Drop everything that is kept."""
    _kept.cache_clear()


@functools.lru_cache(maxsize=_MOST_CHUNKS)
def _kept(
    kind: type[PanelProof],
    start_bytes: bytes,
    end_bytes: bytes,
    vertex_bytes: bytes,
    hole_bytes: bytes,
    next_bytes: bytes,
) -> PanelRows:
    start, end, vertices, holes = (
        np.frombuffer(data, dtype=complex)
        for data in (start_bytes, end_bytes, vertex_bytes, hole_bytes)
    )
    following = np.frombuffer(next_bytes, dtype=np.intp)
    singularities = Singularities(vertices, following, np.argsort(following), holes)
    ends: Any = np.concatenate([start, end])
    proof: Any = kind.on(start, end, singularities)
    weights: Any = beside(start, end, singularities)
    rows = PanelRows(derivative_rows(ends, singularities), proof, weights)
    for array in (*rows.ends, *proof, weights):
        read_only(array)
    return rows
