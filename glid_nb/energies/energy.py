"""The interface of an isometric energy, and the registry of the energies by name."""

from __future__ import annotations

import math
import numbers
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

    Subclasses are frozen dataclasses decorated with :func:`register_energy`. Their fields are the
    parameters, positive numbers with a default; another value of a parameter runs the same compiled
    program.
    """

    name: ClassVar[str]
    """Its short name, as the command line and files write it."""
    label: ClassVar[str]
    """What a menu calls it."""
    shader: ClassVar[str | None] = None
    """:meth:`density` in GLSL, an expression of ``x``, ``y`` and the parameter ``s``."""
    is_barrier: ClassVar[bool] = True
    """Whether it grows without bound where a map degenerates, and so keeps a solve from there."""
    indefinite_across_f_only: ClassVar[bool] = False
    """Whether, of the eigenvalues of ``K`` (23), ``lambda_1 = 2 alpha_1`` alone can be negative: a
    Hessian is then projected by a correction at a fifth of its own cost."""

    def __new__(cls, *_: Any, **__: Any) -> Self:
        settle()  # JAX may have been imported by others since
        return super().__new__(cls)

    def __post_init__(self) -> None:
        for parameter in self.parameters():
            value = _checked_parameter(self.name, parameter, getattr(self, parameter))
            object.__setattr__(self, parameter, value)

    @classmethod
    def parameters(cls) -> tuple[str, ...]:
        """Names of the parameters."""
        return tuple(field.name for field in fields(cls))  # type: ignore[arg-type]

    @abstractmethod
    def density(self, x: Scalars, y: Scalars) -> Scalars:
        """``E(x, y)`` at each sample."""

    @abstractmethod
    def differentials(self, x: Scalars, y: Scalars) -> Differentials:
        """First and second derivatives of :meth:`density` at each sample."""


E = TypeVar("E", bound=Energy)

ENERGIES: dict[str, type[Energy]] = {}
"""The registered energies by name, in the order in which menus list them."""


def register_energy(cls: type[E]) -> type[E]:
    """Class decorator: a frozen dataclass of numbers becomes an energy with a name.

    Compiled programs take it, not by JAX's ``register_dataclass``: jaxlib 0.10 takes trees of
    different dataclasses with the same fields for equal, and now and then runs for one energy what
    was compiled for another. Here the class is part of the tree's structure.
    """
    names = cls.parameters()

    def flatten(energy: E) -> tuple[tuple[Any, ...], type[E]]:
        return tuple(getattr(energy, name) for name in names), cls

    def unflatten(known: type[E], leaves: Any) -> E:
        return known(*leaves)

    once_loaded(lambda: jax.tree_util.register_pytree_node(cls, flatten, unflatten))
    ENERGIES[cls.name] = cls
    return cls


def energy_by_name(name: str, s: float | None = None) -> Energy:
    """The energy called ``name``, such as "iso", "exp", "amips", "mips" or "arap".

    ``s`` is the parameter of ``exp`` and ``amips`` (default 1); the others have none and ignore it,
    but it must be positive all the same.

    Raises
    ------
    EnergyError
        For an unknown name, or an ``s`` that is not positive.
    """
    if not isinstance(name, str) or name not in ENERGIES:
        raise EnergyError(f"unknown energy {name!r}; choose one of {', '.join(ENERGIES)}")
    if s is None:
        return ENERGIES[name]()
    s = _checked_parameter(name, "s", s)
    return ENERGIES[name](*[s for _ in ENERGIES[name].parameters()])


def as_energy(energy: Energy | str | None) -> Energy:
    """An energy, or the one of that name, or the symmetric Dirichlet energy for None.

    Raises
    ------
    EnergyError
        For an unknown name, or something that is not an energy.
    """
    if isinstance(energy, str | None):
        return energy_by_name(energy or "iso")
    if not isinstance(energy, Energy):
        raise EnergyError(
            f"energy is {energy!r}; pass an energy, such as SymmetricDirichlet() or "
            f"CustomEnergy(function), or one of the names {', '.join(ENERGIES)}"
        )
    return energy


def _checked_parameter(energy: str, name: str, value: Any) -> Any:
    """A parameter as a positive finite float.

    Inside a traced program it is a JAX tracer, whose range was checked when it was stored; that
    passes through, and so do the placeholders, plain objects, around which JAX rebuilds values.
    """
    if isinstance(value, numbers.Real) and not isinstance(value, bool):
        number = float(value)
        if math.isfinite(number) and number > 0:
            return number
        raise EnergyError(
            f"{name} of the energy {energy!r} must be positive and finite, got {number}"
        )
    if type(value) is object or isinstance(value, jax.Array | jax.ShapeDtypeStruct):
        return value
    raise EnergyError(f"{name} of the energy {energy!r} must be a positive number, got {value!r}")
