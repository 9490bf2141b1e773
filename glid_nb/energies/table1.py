"""The isometric energies of Section 6 and Table 1, in the order in which menus list them."""

from dataclasses import dataclass
from typing import ClassVar

from glid_nb._jax import jnp
from glid_nb.energies.energy import Differentials, Energy, Scalars, register_energy


@register_energy
@dataclass(frozen=True)
class SymmetricDirichlet(Energy):
    """``E_iso = (sigma_1^2 + sigma_1^-2 + sigma_2^2 + sigma_2^-2) / 2`` (10a), (10b).

    In Wirtinger terms ``(x + y) (1 + (x - y)^-2)`` (Table 1, first row). It is 2 at an isometry
    and infinite where the map degenerates.
    """

    name: ClassVar[str] = "iso"
    label: ClassVar[str] = "Symmetric Dirichlet"
    shader: ClassVar[str] = "(x + y) * (1.0 + 1.0 / ((x - y) * (x - y)))"
    indefinite_across_f_only: ClassVar[bool] = True

    def density(self, x: Scalars, y: Scalars) -> Scalars:
        return (x + y) * (1 + (x - y) ** -2)

    def differentials(self, x: Scalars, y: Scalars) -> Differentials:
        inverse = 1 / (x - y)
        cube, fourth = inverse**3, inverse**4
        return Differentials(
            1 - (x + 3 * y) * cube,
            1 + (3 * x + y) * cube,
            2 * (x + 5 * y) * fourth,
            2 * (5 * x + y) * fourth,
            -6 * (x + y) * fourth,
        )


@register_energy
@dataclass(frozen=True)
class ExponentialSymmetricDirichlet(Energy):
    """``E_exp = exp(s E_iso)`` (Table 1, second row)."""

    s: float = 1.0
    """Sharpness, positive: the larger, the lower the greatest distortion (Figure 6)."""

    name: ClassVar[str] = "exp"
    label: ClassVar[str] = "Exponential sym. Dirichlet"
    shader: ClassVar[str] = f"exp(s * ({SymmetricDirichlet.shader}))"
    indefinite_across_f_only: ClassVar[bool] = True

    def density(self, x: Scalars, y: Scalars) -> Scalars:
        return jnp.exp(self.s * SymmetricDirichlet().density(x, y))

    def differentials(self, x: Scalars, y: Scalars) -> Differentials:
        s = self.s
        a1, a2, b1, b2, b3 = SymmetricDirichlet().differentials(x, y)
        factor = s * self.density(x, y)
        return Differentials(
            factor * a1,
            factor * a2,
            factor * (b1 + s * a1**2),
            factor * (b2 + s * a2**2),
            factor * (b3 + s * a1 * a2),
        )


@register_energy
@dataclass(frozen=True)
class AMIPS(Energy):
    """``exp(s (sigma_1/sigma_2 + sigma_2/sigma_1) + sigma_1 sigma_2 + 1/(sigma_1 sigma_2))``.

    In Wirtinger terms ``exp((2 s (x + y) + 1) / (x - y) + x - y)`` (Table 1, third row); the
    parameter balances angle preservation against area preservation [Fu et al. 2015].
    """

    s: float = 1.0
    """Weight of the angles, positive."""

    name: ClassVar[str] = "amips"
    label: ClassVar[str] = "AMIPS"
    shader: ClassVar[str] = "exp((2.0 * s * (x + y) + 1.0) / (x - y) + x - y)"

    def density(self, x: Scalars, y: Scalars) -> Scalars:
        det = x - y
        return jnp.exp((2 * self.s * (x + y) + 1) / det + det)

    def differentials(self, x: Scalars, y: Scalars) -> Differentials:
        s = self.s
        inverse = 1 / (x - y)
        square, cube = inverse**2, inverse**3
        a1 = 1 - (4 * s * y + 1) * square
        a2 = -1 + (4 * s * x + 1) * square
        energy = self.density(x, y)
        return Differentials(
            a1 * energy,
            a2 * energy,
            (a1**2 + 2 * (4 * s * y + 1) * cube) * energy,
            (a2**2 + 2 * (4 * s * x + 1) * cube) * energy,
            (a1 * a2 - (4 * s * (x + y) + 2) * cube) * energy,
        )


@register_energy
@dataclass(frozen=True)
class MIPS(Energy):
    """``(sigma_1 / sigma_2 + sigma_2 / sigma_1) / 2`` [Hormann and Greiner 2000].

    In Wirtinger terms ``(x + y) / (x - y)``. It is 1 at every conformal map of any scale, and
    infinite where the map degenerates. Parts may shrink towards a point while it falls to 1; a
    solve then ends as BLOCKED.
    """

    name: ClassVar[str] = "mips"
    label: ClassVar[str] = "MIPS (conformal)"
    shader: ClassVar[str] = "(x + y) / (x - y)"

    def density(self, x: Scalars, y: Scalars) -> Scalars:
        return (x + y) / (x - y)

    def differentials(self, x: Scalars, y: Scalars) -> Differentials:
        inverse = 1 / (x - y)
        square, cube = inverse**2, inverse**3
        return Differentials(
            -2 * y * square, 2 * x * square, 4 * y * cube, 4 * x * cube, -2 * (x + y) * cube
        )


@register_energy
@dataclass(frozen=True)
class ARAP(Energy):
    """``E_ARAP = (sigma_1 - 1)^2 + (sigma_2 - 1)^2`` (Section 6).

    For an orientation-preserving map it is ``2 (x + y) - 4 sqrt(x) + 2``. It stays finite where the
    map degenerates, so only the certificate prevents folds.
    """

    name: ClassVar[str] = "arap"
    label: ClassVar[str] = "ARAP"
    shader: ClassVar[str] = "2.0 * (x + y) - 4.0 * sqrt(x) + 2.0"
    is_barrier: ClassVar[bool] = False
    indefinite_across_f_only: ClassVar[bool] = True

    def density(self, x: Scalars, y: Scalars) -> Scalars:
        return 2 * (x + y) - 4 * jnp.sqrt(x) + 2

    def differentials(self, x: Scalars, y: Scalars) -> Differentials:  # noqa: ARG002
        root = 1 / jnp.sqrt(x)
        zero = jnp.zeros_like(x)
        return Differentials(2 - 2 * root, zero + 2, root**3, zero, zero)
