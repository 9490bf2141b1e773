"""A user's own energy, differentiated automatically."""

import weakref
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, ClassVar

from glid_nb._jax import jax, jnp, once_loaded
from glid_nb.energies.energy import Differentials, Energy, EnergyError, Scalars

# JAX rebuilds energies often; each function is checked once.
_checked: weakref.WeakSet[Callable[..., Any]] = weakref.WeakSet()


@dataclass(frozen=True)
class CustomEnergy(Energy):
    """An energy given as one function ``E(x, y)`` of scalars, written with ``jax.numpy``.

    ``x = |f_z|^2 > y = |f_zbar|^2 >= 0``. The function is twice differentiable by JAX, with its
    minimum at the isometry ``E(1, 0)``. Use one function object for many solves; each new one is
    compiled anew. An EnergyError says so if it does not make one number of two, cannot be
    differentiated, or is not finite at the isometry. The alphas and betas come from automatic
    differentiation; the projection of the Hessian from Equations (23)-(24).

    Examples
    --------
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
            with jax.ensure_compile_time_eval(), jax.enable_x64(True):
                start = jnp.ones(1), jnp.zeros(1)
                values = {"value": self.density(*start), **self.differentials(*start)._asdict()}
        except TypeError as error:
            raise EnergyError(
                "the custom energy must be a function E(x, y) of two numbers that returns one "
                f"and that JAX can differentiate; trying it out gave: {error}"
            ) from error
        for name, value in values.items():
            if not jnp.isfinite(value).all():
                raise EnergyError(
                    f"the custom energy's {name} at the isometry E(1, 0) is {float(value[0])}; it "
                    "must be finite there, with finite first and second derivatives"
                )
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
