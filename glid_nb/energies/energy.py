"""What an isometric energy is to the solver."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import fields
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Self, TypeVar

from glid_nb._errors import InputError
from glid_nb._jax import jax, once_loaded, settle

if TYPE_CHECKING:
    from jaxtyping import Array, Float

    Scalars = Float[Array, " *samples"]


class EnergyError(InputError):
    """An energy is unknown or its parameter is out of range."""


class Differentials(NamedTuple):
    """The five scalars of Table 1 at each sample (Equations (E.3) and (E.9))."""

    alpha1: Scalars  # dE/dx
    alpha2: Scalars  # dE/dy
    beta1: Scalars  # d2E/dx2
    beta2: Scalars  # d2E/dy2
    beta3: Scalars  # d2E/dxdy


class Energy(ABC):
    """A pointwise distortion measure ``E(x, y)`` of ``x = |f_z|^2`` and ``y = |f_zbar|^2``.

    Defined for orientation-preserving maps, ``x > y >= 0``; the solver treats every other sample
    as infinitely bad and never asks there.

    Subclasses are frozen dataclasses decorated with :func:`register_energy`, their parameters being
    leaves: another value of a parameter runs the same compiled program.
    """

    name: ClassVar[str]
    is_barrier: ClassVar[bool] = True
    """Whether it grows without bound where a map degenerates, and so keeps a solve from there."""
    indefinite_across_f_only: ClassVar[bool] = False
    """Whether, of the eigenvalues of ``K`` (23), ``lambda_1 = 2 alpha_1`` alone can be negative: a
    Hessian is then projected by a correction at a fifth of its own cost."""

    def __new__(cls, *_: Any, **__: Any) -> Self:
        settle()  # for who has imported JAX after this package
        return super().__new__(cls)

    @abstractmethod
    def density(self, x: Scalars, y: Scalars) -> Scalars:
        """``E(x, y)`` at each sample."""

    @abstractmethod
    def differentials(self, x: Scalars, y: Scalars) -> Differentials:
        """First and second derivatives of :meth:`density` at each sample."""


E = TypeVar("E", bound=Energy)


def register_energy(cls: type[E]) -> type[E]:
    """Class decorator: compiled programs take this energy, a frozen dataclass of numbers.

    Not JAX's ``register_dataclass``: jaxlib 0.10 takes trees of different dataclasses with the same
    fields for equal, and now and then runs for one energy what was compiled for another. Here the
    class is part of the tree's structure.
    """
    names = [field.name for field in fields(cls)]  # type: ignore[arg-type]

    def flatten(energy: E) -> tuple[tuple[Any, ...], type[E]]:
        return tuple(getattr(energy, name) for name in names), cls

    def unflatten(known: type[E], leaves: Any) -> E:
        return known(*leaves)

    once_loaded(lambda: jax.tree_util.register_pytree_node(cls, flatten, unflatten))
    return cls
