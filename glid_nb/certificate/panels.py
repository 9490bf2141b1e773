"""Proofs on panels: input, result, and the protocol of a kind of proof."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol, Self, TypeVar

from numpy.typing import NDArray

from glid_nb._jax import jax, jnp
from glid_nb.geometry import Panels
from glid_nb.harmonic.cauchy import Singularities

if TYPE_CHECKING:
    from jaxtyping import Array, Bool, Complex, Float


class EndValues(NamedTuple):
    """A holomorphic function, ``f_z`` or ``conj(f_zbar)``, at the two ends of each panel.

    Slopes are derivatives along the panel: the complex derivative times ``end - start``.
    """

    start: Complex[Array, " p"]
    end: Complex[Array, " p"]
    slope_start: Complex[Array, " p"]
    slope_end: Complex[Array, " p"]


class PanelBounds(NamedTuple):
    """Bounds proved on the whole closed panel."""

    sigma2_lower: Float[Array, " p"]
    sigma1_upper: Float[Array, " p"]
    k_upper: Float[Array, " p"]
    turning_known: Bool[Array, " p"]
    """Whether the change of ``arg f_z`` along the panel is proved to be ``turning`` (29)."""
    turning: Float[Array, " p"]
    """Principal ``Arg`` of ``f_z(end) / f_z(start)``."""

    @property
    def injective(self) -> Bool[Array, " p"]:
        """Where ``|f_z| > |f_zbar|`` is proved and the turning is known (Conditions 4a, 5)."""
        return (self.sigma2_lower > 0) & self.turning_known


class PanelProof(Protocol):
    """A kind of proof; an instance holds the constants that depend on the panels only.

    Instances are JAX pytrees of arrays whose last axis runs over the panels. A solver computes them
    once for many maps.
    """

    @classmethod
    def on(
        cls, start: Complex[Array, " p"], end: Complex[Array, " p"], singularities: Singularities
    ) -> Self:
        """The proof's constants on the panels from ``start`` to ``end``."""
        ...

    def remainder(
        self, coefficients: Complex[Array, "k n"], singularities: Singularities
    ) -> Float[Array, "k p"]:
        """Bounds how far ``sum_j D_j coefficients_j`` departs from its estimate by the end values.

        The caller of :meth:`bounds` adds an allowance for rounding.
        """
        ...

    @staticmethod
    def bounds(fz: EndValues, fzb_conj: EndValues, remainder: Float[Array, "2 p"]) -> PanelBounds:
        """The bounds on each whole panel, from the remainders of both derivatives."""
        ...


T = TypeVar("T")


def split(
    panels: Panels, known: T, chosen: NDArray[Any], evaluate: Callable[..., T]
) -> tuple[Panels, T]:
    """Panels with the chosen, divisible ones halved, and what is known of each panel.

    ``known`` is a pytree of NumPy arrays over the panels; ``evaluate(start, end)`` makes it for the
    new ones.
    """
    finer, parent = panels.split(chosen)
    new = chosen[parent]

    def merged(values: NDArray[Any], fresh: NDArray[Any]) -> NDArray[Any]:
        result = values[parent]
        result[new] = fresh
        return result

    return finer, jax.tree.map(merged, known, evaluate(finer.start[new], finer.end[new]))


def modulus(z: Complex[Array, " *k"]) -> Float[Array, " *k"]:
    """``|z|`` without protection from overflow, which cannot occur here; compiles to less code."""
    return jnp.sqrt(jnp.real(z) ** 2 + jnp.imag(z) ** 2)
