"""Proofs on panels: their input, their result, and the protocol of a kind of proof."""

from collections.abc import Callable
from typing import Any, NamedTuple, Protocol, Self, TypeVar
from typing import Any as Array  # of NumPy or of JAX

import numpy as np
from numpy.typing import NDArray

from glid_nb._jax import Bool, Complex, Float, jax
from glid_nb.certificate.rounding import UNIT_ROUNDOFF
from glid_nb.geometry import Cage, GeometryError, Panels, loop_name, place
from glid_nb.geometry._loops import next_index
from glid_nb.harmonic.cauchy import Singularities

Ends = Complex[Array, " p"]
PerPanel = Float[Array, " p"]
Rows = Complex[Array, "k n"]


class EndValues(NamedTuple):
    """``f_z`` or ``conj(f_zbar)`` at both ends of panels; slopes are times ``end - start``."""

    start: Ends
    end: Ends
    slope_start: Ends
    slope_end: Ends


class PanelBounds(NamedTuple):
    """What is proved on each panel: bounds as in (4b), (4c), (4d), the turning of Theorem 8.1."""

    sigma2_lower: PerPanel
    sigma1_upper: PerPanel
    k_upper: PerPanel
    turning_known: Bool[Array, " p"]  # whether arg f_z is proved to change by turning (29)
    turning: PerPanel  # principal Arg of f_z(end) / f_z(start)

    @property
    def injective(self) -> Bool[Array, " p"]:
        """Where ``|f_z| > |f_zbar|`` (5) is proved, and the turning of ``f_z``, which (4a) sums."""
        return (self.sigma2_lower > 0) & self.turning_known


class PanelProof(Protocol):
    """A kind of proof: a pytree of arrays, which depend on the panels only. Panels come last."""

    slack_share: int  # how many times the error of the end values enters the remainder

    @classmethod
    def on(cls, start: Ends, end: Ends, singularities: Singularities) -> Self: ...

    def remainder(self, coefficients: Rows, singularities: Singularities) -> Float[Array, "k p"]:
        """Bounds the error of the estimate of ``sum_j D_j coefficients_j``, without rounding."""
        ...

    @staticmethod
    def bounds(
        fz: EndValues, fzb_conj: EndValues, remainder: Float[Array, "2 p"]
    ) -> PanelBounds: ...


T = TypeVar("T")

# How far a panel's end may be off its edge, relative to the largest coordinate. The package's own
# panels are off by at most half of it.
_OFF = 24 * UNIT_ROUNDOFF


def check_tiling(panels: Panels, cage: Cage) -> None:
    """Raise a :class:`GeometryError` unless the panels are the boundary, loop by loop in order."""
    largest = float(np.abs(cage.loops_complex[0]).max())
    whole = np.array_equal(np.unique(panels.loop), np.arange(1 + cage.n_holes))
    whole = whole and bool((np.diff(panels.loop) >= 0).all())
    if not whole or not np.array_equal(panels.next, next_index(panels.loop)):
        raise _not_tiled("they do not run along its loops in order")
    joined = panels.end == panels.start[panels.next]
    for i, corners in enumerate(cage.loops_complex):
        own = np.flatnonzero(panels.loop == i)
        start, end = panels.start[own], panels.end[own]
        is_corner = np.isin(start, corners)
        if not np.array_equal(start[is_corner], corners) or not is_corner[0]:
            raise _not_tiled(f"vertices of the {loop_name(i)} are not panel ends, or not in order")
        edge = np.cumsum(is_corner) - 1
        origin, along = corners[edge], (np.roll(corners, -1) - corners)[edge]
        direction = along / np.abs(along)
        first, last = ((z - origin) * direction.conj() for z in (start, end))
        off = np.maximum(np.abs(first.imag), np.abs(last.imag)) > _OFF * largest
        wrong = off | (last.real - first.real <= -_OFF * largest) | ~joined[own]
        if wrong.any():
            raise _not_tiled(f"they leave its edges near {place(start[wrong][0])}")


def _not_tiled(what: str) -> GeometryError:
    which = "the panels do not tile the boundary of this map's cage"
    return GeometryError(f"{which}: {what}; leave them out, or take graded_panels(map.domain)")


def split(panels: Panels, known: T, chosen: Array, evaluate: Callable[..., T]) -> tuple[Panels, T]:
    """With chosen, divisible panels halved, and the pytree over panels that ``evaluate`` makes."""
    finer, parent = panels.split(chosen)
    new = chosen[parent]

    def merged(values: NDArray[Any], fresh: NDArray[Any]) -> NDArray[Any]:
        result = values[parent]
        result[new] = fresh
        return result

    return finer, jax.tree.map(merged, known, evaluate(finer.start[new], finer.end[new]))


def modulus(z: Complex[Array, " *k"]) -> Float[Array, " *k"]:
    """``|z|`` without protection from overflow, which cannot occur here; compiles to less code."""
    xp = z.__array_namespace__()
    return xp.sqrt(xp.real(z) ** 2 + xp.imag(z) ** 2)
