"""The interface of an isometric energy, the registry of the energies by name, and a user's own."""

import functools
import math
import weakref
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, field, fields
from numbers import Real
from typing import Any, ClassVar, NamedTuple, Self, TypeVar

from glid_nb._errors import InputError
from glid_nb._features import enable_x64
from glid_nb._jax import Array, Float, jax, jnp, once_loaded, settle
from glid_nb._runtime import double_precision

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

    It is defined for orientation-preserving maps, ``x > y >= 0``; the solver takes it as infinite
    elsewhere.

    Subclasses are frozen dataclasses decorated with :func:`register_energy`. Their fields are the
    parameters: positive finite numbers with a default. Anything else raises EnergyError. All values
    of a parameter share a compiled program.
    """

    name: ClassVar[str]
    """Short name, for the command line and files."""
    label: ClassVar[str]
    """Name in menus."""
    shader: ClassVar[str | None] = None
    """:meth:`density` in GLSL, an expression of ``x``, ``y`` and the parameter ``s``."""
    is_barrier: ClassVar[bool] = True
    """Whether it grows without bound as a map degenerates."""
    indefinite_across_f_only: ClassVar[bool] = False
    """Whether ``lambda_1 = 2 alpha_1`` is the only eigenvalue of ``K`` (23) that can be negative.
    Then a correction projects the Hessian (25), at a fifth of the cost of assembling it."""

    def __init_subclass__(cls, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        for name in ("density", "differentials"):
            if (method := vars(cls).get(name)) is not None:
                setattr(cls, name, _in_double_precision(method))

    def __new__(cls, *_: Any, **__: Any) -> Self:
        settle()  # other code may have imported JAX in the meantime
        return super().__new__(cls)

    def __post_init__(self) -> None:
        for name, value in list(vars(self).items()):
            vars(self)[name] = _checked_parameter(self.name, name, value)

    @classmethod
    def parameters(cls) -> tuple[str, ...]:
        """Names of the parameters."""
        return tuple(f.name for f in fields(cls))  # type: ignore[arg-type]

    @abstractmethod
    def density(self, x: Scalars, y: Scalars) -> Scalars:
        """``E(x, y)`` at each sample. Of numbers and NumPy arrays in double precision."""

    @abstractmethod
    def differentials(self, x: Scalars, y: Scalars) -> Differentials:
        """First and second derivatives of :meth:`density` at each sample."""


def _in_double_precision(method: Callable[[Any, Scalars, Scalars], Any]) -> Callable[..., Any]:
    """Wrap a method of ``x`` and ``y`` so that it computes numbers and NumPy arrays in 64 bits.

    JAX would use 32 bits for them, unless the caller has changed that. JAX's own arrays have a type
    already.
    """

    @functools.wraps(method)
    def wrapped(self: Energy, x: Scalars, y: Scalars) -> Any:
        if isinstance(x, jax.Array) or isinstance(y, jax.Array):
            return method(self, x, y)
        return double_precision(method)(self, x, y)

    return wrapped


E = TypeVar("E", bound=Energy)

ENERGIES: dict[str, type[Energy]] = {}
"""The registered energies by name, in the order in which menus list them."""


def register_energy(cls: type[E]) -> type[E]:
    """Class decorator: register a frozen dataclass of numbers in ENERGIES and as a JAX pytree.

    The class is part of the tree's structure. JAX's ``register_dataclass`` cannot be used: jaxlib
    0.10 treats different dataclasses with the same fields as equal, and may run the wrong program.
    """
    once_loaded(
        lambda: jax.tree_util.register_pytree_node(
            cls, lambda energy: (tuple(vars(energy).values()), cls), _rebuilt
        )
    )
    ENERGIES[cls.name] = cls
    return cls


def _rebuilt(cls: type[E], parameters: tuple[Any, ...]) -> E:
    energy = object.__new__(cls)
    vars(energy).update(zip(cls.parameters(), parameters, strict=True))
    return energy


def by_name(name: str, s: float | None = None) -> Energy:
    """The energy called ``name``, such as "iso", "exp", "amips", "mips" or "arap".

    ``s``, a positive number, is the parameter of ``exp`` and ``amips`` (default 1); the others
    ignore it. EnergyError lists the names if there is no such energy.
    """
    if not isinstance(name, str) or name not in ENERGIES:
        raise EnergyError(f"unknown energy {name!r}; choose one of {', '.join(ENERGIES)}")
    if s is None:
        return ENERGIES[name]()
    s = _checked_parameter(name, "s", s)
    return ENERGIES[name](*[s for _ in ENERGIES[name].parameters()])


def as_energy(energy: Energy | str | None) -> Energy:
    """The energy given as such or by name; the symmetric Dirichlet energy for None."""
    if isinstance(energy, str | None):
        return by_name(energy or "iso")
    if not isinstance(energy, Energy):
        wanted = f"SymmetricDirichlet(), CustomEnergy(function) or a name: {', '.join(ENERGIES)}"
        raise EnergyError(f"energy is {energy!r}; pass an energy, such as {wanted}")
    return energy


@functools.lru_cache
@double_precision
def isometry_energy(energy: Energy) -> float:
    """``E(1, 0)``, the density of an isometry."""
    return float(energy.density(jnp.ones(1), jnp.zeros(1))[0])


def _checked_parameter(energy: str, name: str, value: Any) -> Any:
    """A parameter as a positive finite float; JAX tracers are returned unchanged."""
    number = float(value) if isinstance(value, Real) and not isinstance(value, bool) else math.nan
    if 0 < number < math.inf:
        return number
    if isinstance(value, jax.Array):
        return value
    what = f"{name} of the energy {energy!r}"
    raise EnergyError(f"{what} must be positive and finite, got {value!r:.60}")


# JAX rebuilds energies often; each function is checked once.
_checked: weakref.WeakSet[Callable[..., Any]] = weakref.WeakSet()


@dataclass(frozen=True)
class CustomEnergy(Energy):
    """An energy given as one function ``E(x, y)`` of scalars, written with ``jax.numpy``.

    Its arguments are ``x = |f_z|^2 > y = |f_zbar|^2 >= 0``. JAX must be able to differentiate it
    twice, and its minimum must be at the isometry, ``E(1, 0)``. Use one function object for many
    solves, because each new one is compiled.

    An EnergyError says if the function does not make one number of two, cannot be differentiated,
    or is not finite at the isometry. The alphas and betas come from automatic differentiation, the
    projection of the Hessian from (23) and (24).

    >>> dirichlet = CustomEnergy(lambda x, y: (x + y) * (1 + 1 / (x - y) ** 2))
    """

    function: Callable[[Scalars, Scalars], Scalars] = field()

    name: ClassVar[str] = "custom"
    label: ClassVar[str] = "Your own"
    is_barrier: ClassVar[bool] = False

    def __post_init__(self) -> None:
        if not callable(self.function):
            raise EnergyError(f"a custom energy must be a function E(x, y), got {self.function!r}")
        if self.function in _checked:
            return
        try:
            with jax.ensure_compile_time_eval(), enable_x64():
                start = jnp.ones(1), jnp.zeros(1)
                values = {"value": self.density(*start), **self.differentials(*start)._asdict()}
        except (TypeError, ValueError) as error:  # which of them differs between versions of JAX
            wanted = "a function E(x, y) of two numbers that returns one, differentiable by JAX"
            raise EnergyError(f"the custom energy must be {wanted}; it gave: {error}") from error
        for name, value in values.items():
            if not jnp.isfinite(value).all():
                what = f"the custom energy's {name} at the isometry E(1, 0) is {float(value[0])}"
                raise EnergyError(f"{what}; its value and derivatives must be finite there")
        _checked.add(self.function)

    @classmethod
    def parameters(cls) -> tuple[str, ...]:
        """Empty: its parameters are constants of the function."""
        return ()

    def density(self, x: Scalars, y: Scalars) -> Scalars:
        return jnp.vectorize(self.function)(x, y)

    def differentials(self, x: Scalars, y: Scalars) -> Differentials:
        gradient = jax.grad(self.function, argnums=(0, 1))

        def at_one_sample(x: Scalars, y: Scalars) -> Differentials:
            alpha1, alpha2 = gradient(x, y)
            (beta1, beta3), (_, beta2) = jax.jacfwd(gradient, argnums=(0, 1))(x, y)
            return Differentials(alpha1, alpha2, beta1, beta2, beta3)

        return Differentials(*jnp.vectorize(at_one_sample)(x, y))


once_loaded(lambda: jax.tree_util.register_dataclass(CustomEnergy, [], ["function"]))
