"""A harmonic map within JAX: its coefficients may be traced."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from glid_nb._features import is_traced
from glid_nb._jax import jax, jnp, once_loaded
from glid_nb.geometry import Domain
from glid_nb.harmonic.basis import basis_of
from glid_nb.harmonic.map import HarmonicMap, MapError, first, images, on_jax


@dataclass(frozen=True, eq=False)
class TracedMap:
    """A harmonic map whose coefficients are an array of JAX.

    It is the value of a :func:`glid_nb.differentiable` solve. It is a pytree with one leaf, so it
    goes through ``jax.jit``, ``jax.grad`` and ``jax.vmap``. A map that ``jax.vmap`` has made holds
    many; call it within ``jax.vmap``, too. Points are (..., 2) coordinates or complex numbers,
    lists or arrays; they can be traced as well. Everything is computed in double precision.
    """

    domain: Domain
    coefficients: Any = field(repr=False)
    """(4, n): real and imaginary part of phi, then of psi (see :class:`HarmonicMap`)."""

    @property
    def phi(self) -> Any:
        """(n,) complex coefficients."""
        return self.coefficients[0] + 1j * self.coefficients[1]

    @property
    def psi(self) -> Any:
        """(n,) complex coefficients."""
        return self.coefficients[2] + 1j * self.coefficients[3]

    def __call__(self, points: Any) -> Any:
        """(..., 2) images of points, world coordinates."""
        return self._evaluated(images, points)

    def wirtinger(self, points: Any) -> tuple[Any, Any]:
        """Wirtinger derivatives ``f_z`` and ``f_zbar``, complex, (...) each."""
        fz, fzb_conj = self._evaluated(first, points)
        return fz, fzb_conj.conj()

    def sigma1(self, points: Any) -> Any:
        """Large singular value of the Jacobian (2)."""
        fz, fzb = self.wirtinger(points)
        return abs(fz) + abs(fzb)

    def sigma2(self, points: Any) -> Any:
        """Small singular value ``|f_z| - |f_zbar|`` (2)."""
        fz, fzb = self.wirtinger(points)
        return abs(fz) - abs(fzb)

    @property
    def map(self) -> HarmonicMap:
        """The map as a value, outside JAX. Raises a MapError while JAX traces it."""
        if is_traced(self.coefficients):
            raise MapError("JAX traces this map, so it has no numbers yet; return it instead")
        re_phi, im_phi, re_psi, im_psi = np.asarray(self.coefficients)
        return HarmonicMap(self.domain, re_phi + 1j * im_phi, re_psi + 1j * im_psi)

    def _evaluated(self, program: Any, points: Any) -> Any:
        if self.coefficients.ndim != 2:
            raise MapError("these are many maps; call each of them, within jax.vmap")
        at = jnp.asarray(points)
        at = at.astype(complex if at.dtype.kind == "c" else float)
        basis = basis_of(self.domain)
        rows = jnp.zeros((2, basis.n_columns), complex)
        rows = rows.at[:, basis.columns].set(jnp.stack([self.phi, self.psi]))
        return on_jax(self.domain, rows, program, at)


once_loaded(
    lambda: jax.tree_util.register_pytree_node(
        TracedMap,
        lambda map: ((map.coefficients,), map.domain),
        lambda domain, leaves: TracedMap(domain, *leaves),
    )
)
