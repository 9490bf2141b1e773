"""How a minimum moves with its problem, by the implicit function theorem.

At a minimum the gradient ``G`` of (20) vanishes, so ``H dx = -dG`` for a small change of the
problem. ``x`` are the solve's whitened coordinates, ``H`` is the exact Hessian of the whole
objective there, on all nodes of the energy and in double precision. It is not projected.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass
from numbers import Integral
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np
import scipy
from numpy.typing import ArrayLike

from glid_nb._arguments import unmet
from glid_nb._arrays import Array
from glid_nb._errors import InputError
from glid_nb._jax import jax, jit, jnp, lax
from glid_nb._runtime import double_precision, single_blas_thread
from glid_nb.energies import Energy
from glid_nb.harmonic import Basis, HarmonicMap, basis_of
from glid_nb.pose import Stiffness
from glid_nb.solvers import cholesky, evaluation, hessian
from glid_nb.solvers.discretisation import Discretisation, Matrices
from glid_nb.solvers.handle_energy import HandleEnergy, handle_energy
from glid_nb.solvers.problem import (
    Unknowns,
    anchor_of,
    expand,
    expand_rows,
    real_coefficients,
    restrict_gradient,
    restrict_hessian,
    restrict_rows,
    unknowns_of,
)
from glid_nb.solvers.step import LEAST_ENERGY
from glid_nb.solvers.stiffness import stiff_matrices
from glid_nb.solvers.whitening import coefficients, pulled_back, whitened

if TYPE_CHECKING:
    from glid_nb.solvers.result import Result

Of = Literal["targets", "weights", "handles", "angles", "scales", "s"]
"""What a minimum depends on: numbers of the pose, or the parameter of the energy."""

# A pivot below this share of the mean of the diagonal: singular as far as double precision tells.
_SINGULAR = 1e-13
# The map is no minimum if a Newton step would lower the energy by more than this share of it.
_FAR = 1e-6
# Up to this many systems are solved by conjugate gradients: to _SMALL of the first residual, in the
# norm of the solver's factor, within _MOST steps.
_FEW, _SMALL, _MOST = 2, 1e-13, 60


class SensitivityError(InputError):
    """A result has no derivative: it is no minimum, or not an isolated one."""


@dataclass(frozen=True, eq=False)
class Minimum:
    """A minimum of the whole objective, from which every derivative follows."""

    map: HarmonicMap
    energy: Energy
    discretisation: Discretisation
    unknowns: Unknowns
    handles: HandleEnergy
    last_factor: Any
    """The factor of the solver's last Hessian, on fewer nodes; None if it was not kept."""

    def changes(self, of: Of) -> Array:
        """(k, 4, n) derivatives of ``[Re phi, Im phi, Re psi, Im psi]``, one for each number.

        Targets and handles have two numbers each, x and y, so k = 2 h. Weights, angles and scales
        have one. ``s`` is one number. The derivative by an angle or a scale that is free is NaN.
        """
        return self.yielded(-self.gradients(of))

    @double_precision
    def gradients(self, of: Of) -> Array:
        """(k, 4, n) derivatives of the objective's gradient in the coefficients."""
        if of != "s":
            return self._own(getattr(self.handles, f"by_{of}")())
        if tuple(self.energy.parameters()) != ("s",):
            raise SensitivityError(f"the energy {self.energy.name!r} has no parameter s")
        return self._own(np.asarray(_by_parameter(self._matrices, self.energy, *self._at))[None])

    @double_precision
    @single_blas_thread()
    def yielded(self, forces: Array) -> Array:
        """(k, 4, n) changes of the coefficients under forces (k, 4, n), that is minus gradients.

        This linear map is symmetric. A few forces cost less by conjugate gradients, which the
        solver's last factor preconditions; for more the exact Hessian is factored, once.
        """
        full = np.zeros((len(forces), 4, self._basis.n_columns))
        full[:, :, self._basis.columns] = forces
        given = self._restricted(full.reshape(len(forces), -1))
        return self._coefficients(self._solved(given))

    @double_precision
    @single_blas_thread()
    def newton_step(self) -> Array:
        """(4, n) the exact Newton step that the solve has left out."""
        return self._coefficients(scipy.linalg.cho_solve(self.factor, -self._gradient)[None])[0]

    @functools.cached_property
    @double_precision
    @single_blas_thread()
    def factor(self) -> tuple[Array, bool]:
        """The Cholesky factor of the exact Hessian. Raises a SensitivityError if it has none."""
        m = _on_all_nodes(self.discretisation, self.handles.pose.stiffness)
        rows, weights = self._rows
        own = rows.T @ (weights[:, None] * rows)
        own[np.diag_indices_from(own)] += 1 - self.unknowns.free
        h: Any = _hessian(m, self.unknowns, self.energy, own, *self._at)
        mean = np.trace(h) / len(h)
        try:
            factor = scipy.linalg.cho_factor(np.asarray(h), lower=False, check_finite=False)
        except np.linalg.LinAlgError:
            factor = None
        if factor is None or np.diag(factor[0]).min() ** 2 < _SINGULAR * mean:
            what = "the Hessian there is not positive definite"
            raise SensitivityError(f"the map is no isolated minimum: {what}")
        return factor

    def check(self, energy: float) -> None:
        """Raise a SensitivityError if a Newton step would lower the ``energy`` notably."""
        g = self._gradient
        known = self.last_factor is not None
        step = np.asarray(_solve(self.last_factor, g)) if known else self._solved(g[None])[0]
        if not g @ step / 2 <= _FAR * max(abs(energy), LEAST_ENERGY):
            again = "solve again from it, with a smaller tolerance"
            raise SensitivityError(f"the map is not at the minimum of its energy; {again}")

    def _solved(self, given: Array) -> Array:
        """(k, 4u) solutions of ``H x = given``."""
        if len(given) <= _FEW and self.last_factor is not None and "factor" not in vars(self):
            found = []
            for b in given:
                more = self.unknowns, self.energy, *self._rows, self.last_factor, b
                x, converged = _conjugate_gradients(self._matrices, *self._at, *more)
                if not bool(converged):
                    break
                found.append(np.asarray(x))
            else:
                return np.stack(found)
        return scipy.linalg.cho_solve(self.factor, given.T, check_finite=False).T

    @property
    def _basis(self) -> Basis:
        return basis_of(self.map.domain)

    @functools.cached_property
    def _matrices(self) -> Matrices:
        disc, stiffness = self.discretisation, self.handles.pose.stiffness
        return stiff_matrices(disc, stiffness) if stiffness else disc.matrices

    @functools.cached_property
    def _at(self) -> tuple[Array, Array]:
        """The map's coefficients (4c,) and their anchor."""
        y = real_coefficients(self.map)
        return y, anchor_of(self._basis, y)

    @functools.cached_property
    def _rows(self) -> tuple[Array, Array]:
        rows, weights = self.handles.hessian_rows
        return self._restricted(rows), weights

    @functools.cached_property
    def _gradient(self) -> Array:
        isometric = np.asarray(_isometric_gradient(self._matrices, self.energy, *self._at))
        return self._restricted((isometric + self.handles.gradient())[None])[0]

    def _own(self, rows: Array) -> Array:
        return rows.reshape(len(rows), 4, -1)[:, :, self._basis.columns]

    def _restricted(self, rows: Array) -> Array:
        """(k, 4u) derivatives by the unknowns, of (k, 4c) ones by the coefficients."""
        return restrict_rows(pulled_back(rows, self.discretisation.whitening.t), self.unknowns)

    def _coefficients(self, x: Array) -> Array:
        """(k, 4, n) changes of the coefficients, of (k, 4u) ones of the unknowns."""
        t_re, t_im = self.discretisation.whitening.t
        re, im = np.moveaxis(expand_rows(x, self.unknowns).reshape(len(x), 2, 2, -1), 2, 0)
        parts = [re @ t_re.T - im @ t_im.T, re @ t_im.T + im @ t_re.T]
        return np.stack(parts, axis=2).reshape(len(x), 4, -1)[:, :, self._basis.columns]


@dataclass(frozen=True, eq=False)
class Sensitivity:
    """How a map moves with one handle of its pose, or with the parameter of its energy.

    The derivative of a harmonic map is a harmonic field. Fields are HarmonicMaps, and their images
    are velocities: world units of the image for each unit of what changes.
    """

    map: HarmonicMap
    """The map that moves."""
    of: Of
    """What changes: a handle's place among "targets" or "handles", its number among "weights",
    "angles" or "scales", or "s"."""
    handle: int | None
    fields: tuple[HarmonicMap, ...]
    """Two fields for a target or a handle, along x and along y; else one."""

    def __call__(self, points: ArrayLike) -> Array:
        """(k, 2, m) derivatives of the images of (k, 2) points, by the m numbers."""
        return np.stack([one(points) for one in self.fields], axis=-1)

    def along(self, direction: ArrayLike) -> HarmonicMap:
        """The field for a change in this direction: m numbers, such as [x, y] of a target."""
        numbers = np.atleast_1d(np.asarray(direction, dtype=float))
        if numbers.shape != (len(self.fields),):
            wanted = f"{len(self.fields)} number{'s' * (len(self.fields) > 1)}"
            raise SensitivityError(f"direction must be {wanted}, not {direction!r:.60}")
        if not np.isfinite(numbers).all():
            raise SensitivityError(f"direction must be finite, not {direction!r:.60}")
        phi = sum(c * one.phi for c, one in zip(numbers, self.fields, strict=True))
        psi = sum(c * one.psi for c, one in zip(numbers, self.fields, strict=True))
        return HarmonicMap(self.map.domain, phi, psi)

    def speed(self, points: ArrayLike) -> Array:
        """(k,) how far each image moves at most, for each unit of change."""
        return np.linalg.norm(self(points), ord=2, axis=(1, 2))


def sensitivity(minimum: Minimum, handle: int | None, of: Of) -> Sensitivity:
    """The derivative by one handle's numbers, or by ``s`` without a handle."""
    pose = minimum.handles.pose
    if unmet(Of, of):
        raise SensitivityError(f"of must be one of {', '.join(get_args(Of))}, not {of!r:.40}")
    if of == "s":
        made = minimum.changes(of)
    else:
        i = -1 if isinstance(handle, bool) or not isinstance(handle, Integral) else int(handle)
        if not 0 <= i < len(pose):
            many = f"the pose has {len(pose)} handles, numbered from 0"
            raise SensitivityError(f"there is no handle {handle!r:.40}; {many}")
        m = 2 if of in ("targets", "handles") else 1
        made = minimum.changes(of)[m * i : m * i + m]
        if np.isnan(made).any():
            raise SensitivityError(f"handle {i} has no derivative by its {of[:-1]}, which is free")
    fields = (HarmonicMap(minimum.map.domain, a + 1j * b, c + 1j * d) for a, b, c, d in made)
    return Sensitivity(minimum.map, of, None if of == "s" else handle, tuple(fields))


@double_precision
@single_blas_thread()
def minimum_of(result: Result) -> Minimum:
    """The minimum that a solve has reached. Raises a SensitivityError if it has reached none."""
    disc, map_, pose = result.discretisation, result.map, result.pose
    if disc is None or not isinstance(map_, HarmonicMap):
        method = f"the method {result.method.name!r}"
        raise SensitivityError(f"{method} has no derivative; solve by Newton's method")
    if not result.status.ok:
        raise SensitivityError(f"the solve has reached no minimum: {result.status.message}")
    if len(pose) < 2 and np.isnan(pose.angles).all():
        what = "energies ignore rotation, so fewer than two handles leave many minima"
        raise SensitivityError(f"{what}; pin a second handle, or give the handle an angle")
    options, basis = result.options, basis_of(map_.domain)
    unknowns = unknowns_of(basis, options.conformal, disc.whitening.t)
    handles = handle_energy(map_, pose, options.p2p_weight)
    size, last = len(unknowns.free), result.factor
    last = last if last is not None and np.shape(last) == (size, size) else None
    minimum = Minimum(map_, result.energy_measure, disc, unknowns, handles, last)
    minimum.check(result.energy)
    return minimum


@functools.lru_cache(maxsize=2)
@double_precision
def _on_all_nodes(disc: Discretisation, stiffness: Stiffness) -> Matrices:
    """The matrices of a solve, for the Hessian on all nodes of the energy, in double precision."""
    m = stiff_matrices(disc, stiffness) if stiffness else disc.matrices
    index = np.arange(len(m.weights))
    whole = whitened(m.nodes, index, m.whitening, np.float64)
    on_host = {"hessian_index": index, "whitened": whole}
    return m._replace(**jax.device_put(on_host), hessian_weights=m.weights)


_solve = jit(cholesky.solve)


@jit
def _isometric_gradient(m: Matrices, energy: Energy, y: Any, anchor: Any) -> Any:
    values = evaluation.products(m, y - anchor).values
    d = energy.differentials(*evaluation.squares(values))
    return evaluation.energy_gradient(m, values, d)


@jit
def _hessian(m: Matrices, unknowns: Unknowns, energy: Energy, own: Any, y: Any, anchor: Any) -> Any:
    """The exact Hessian in the unknowns, upper half. ``own`` is that of the handles' energy."""
    values = evaluation.products(m, y - anchor).values
    squares = evaluation.squares(values)
    local = hessian.local_hessian(energy.differentials(*squares), *squares)
    h = hessian.assemble(m.whitened, m.weights, *evaluation.directions(values), local)
    return restrict_hessian(h, unknowns, own)


@jit
def _by_parameter(m: Matrices, energy: Energy, y: Any, anchor: Any) -> Any:
    """The isometric gradient's derivative by the only parameter of the energy."""
    values = evaluation.products(m, y - anchor).values
    squares = evaluation.squares(values)
    leaves, kind = jax.tree.flatten(energy)

    def gradient(s: Any) -> Any:
        d = jax.tree.unflatten(kind, [s]).differentials(*squares)
        return evaluation.energy_gradient(m, values, d)

    (s,) = (jnp.asarray(leaf) for leaf in leaves)
    return jax.jvp(gradient, (s,), (jnp.ones_like(s),))[1]


@jit
def _conjugate_gradients(
    m: Matrices,
    y: Any,
    anchor: Any,
    unknowns: Unknowns,
    energy: Energy,
    rows: Any,
    weights: Any,
    factor: Any,
    b: Any,
) -> tuple[Any, Any]:
    """The solution of ``H x = b``, and whether it was found: not where ``H`` is not positive.

    A product with ``H`` costs as much as two gradients.
    """
    t, values = m.whitening, evaluation.products(m, y - anchor).values

    def gradient(values: Any) -> Any:
        d = energy.differentials(*evaluation.squares(values))
        return evaluation.energy_gradient(m, values, d)

    def product(v: Any) -> Any:
        change = evaluation.products(m, coefficients(expand(v, unknowns), t)).values
        _, along = jax.jvp(gradient, (values,), (change,))
        isometric = restrict_gradient(pulled_back(along, t), unknowns)
        return isometric + rows.T @ (weights * (rows @ v))

    def goes_on(state: tuple) -> Any:
        _, _, _, square, count, positive = state
        return positive & (square > _SMALL**2 * first) & (count < _MOST)

    def step(state: tuple) -> tuple:
        x, r, p, square, count, _ = state
        hp = product(p)
        curvature = p @ hp
        share = square / curvature
        x, r = x + share * p, r - share * hp
        z = cholesky.solve(factor, r)
        after = r @ z
        return x, r, z + (after / square) * p, after, count + 1, curvature > 0

    z = cholesky.solve(factor, b)
    first = b @ z
    start = jnp.zeros_like(b), b, z, first, 0, jnp.array(True)
    x, _, _, square, _, positive = lax.while_loop(goes_on, step, start)
    return x, positive & (square <= _SMALL**2 * first)
