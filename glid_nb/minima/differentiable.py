"""A solve as a function of JAX: of targets, handles, weights and the energy's parameter."""

from __future__ import annotations

import functools
import os
import threading
from collections import defaultdict
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from glid_nb._arguments import check_type
from glid_nb._arrays import Array
from glid_nb._errors import InputError
from glid_nb._features import is_traced
from glid_nb._jax import jax, jnp, lax
from glid_nb.energies import Energy, as_energy
from glid_nb.geometry import Domain
from glid_nb.harmonic import HarmonicMap, TracedMap
from glid_nb.minima.solve import solve
from glid_nb.pose import Pose
from glid_nb.solvers.options import Options
from glid_nb.solvers.result import Result
from glid_nb.solvers.sensitivity import Minimum, Of, SensitivityError

_KEPT = 32  # results with their factors; more than that in one jax.vmap are solved twice
_NUMBERS: tuple[Of, ...] = ("targets", "handles", "weights", "s")


@dataclass(frozen=True, eq=False)
class DifferentiableSolve:
    """The solves of one domain as a function of JAX; :func:`glid_nb.differentiable` makes it."""

    domain: Domain
    pose: Pose
    energy: Energy
    options: Options
    start: HarmonicMap | Result | None = field(repr=False)
    throw: bool

    def __call__(
        self, targets: Any = None, *, handles: Any = None, weights: Any = None, s: Any = None
    ) -> TracedMap:
        """The map for (h, 2) targets; and for (h, 2) handles, (h,) weights and the parameter ``s``.

        What is None is the pose's or the energy's own. Raises a SensitivityError if JAX computes in
        single precision, if a shape is wrong, or if the energy has no parameter ``s``; and a
        PoseError for numbers that no pose has, unless JAX traces them.
        """
        if jnp.zeros((), float).dtype != np.float64:
            remedy = 'call jax.config.update("jax_enable_x64", True) before'
            raise SensitivityError(
                f"a differentiable solve needs JAX in double precision; {remedy}"
            )
        if s is not None and not self._has_s:
            raise SensitivityError(f"the energy {self.energy.name!r} has no parameter s")
        own = (self.pose.targets, self.pose.handles, self.pose.weights, self._s)
        numbers = []
        for name, value, default in zip(_NUMBERS, (targets, handles, weights, s), own, strict=True):
            array = jnp.asarray(default if value is None else value, float)
            if array.shape != np.shape(default):
                shapes = f"{array.shape}; they must have the shape {np.shape(default)}"
                raise SensitivityError(f"the {name} have the shape {shapes}")
            numbers.append(array)
        if not any(map(is_traced, numbers)):  # an error of the host's function loses its type
            self._pose(targets=targets, handles=handles, weights=weights).check_inside(self.domain)
        return TracedMap(self.domain, self._coefficients(*numbers))

    @property
    def _has_s(self) -> bool:
        return tuple(self.energy.parameters()) == ("s",)

    @property
    def _s(self) -> float:
        return getattr(self.energy, "s", 1.0) if self._has_s else 1.0

    def result(
        self, targets: Any = None, *, handles: Any = None, weights: Any = None, s: Any = None
    ) -> Result:
        """The result of the solve behind the map of these numbers, outside JAX."""
        pose = self._pose(targets=targets, handles=handles, weights=weights)
        energy = self.energy if s is None else replace(self.energy, s=float(s))  # type: ignore[type-var]
        return solve(self.domain, pose, energy, self.options, self.start)

    def _pose(self, **given: Any) -> Pose:
        """The pose with these numbers in place of its own; None keeps its own."""
        known = {name: np.asarray(value) for name, value in given.items() if value is not None}
        return replace(self.pose, **known)

    @functools.cached_property
    def _coefficients(self) -> Any:
        """(4, n) coefficients, as a function of all numbers with its derivative."""
        function = jax.custom_jvp(lambda *numbers: self._called((), *numbers)[0])
        function.defjvp(self._with_tangents, symbolic_zeros=True)
        return function

    def _called(self, wanted: tuple[Of, ...], *numbers: Any) -> Any:
        """The coefficients (4, n) and, for each wanted kind of number, (k, 4, n) derivatives of
        the objective's gradient."""
        sizes = dict(zip(_NUMBERS, (np.size(number) for number in numbers), strict=True))
        shapes = [self._shape(), *(self._shape(sizes[name]) for name in wanted)]
        return self._on_host(functools.partial(self._solved, wanted), tuple(shapes), *numbers)

    def _with_tangents(self, numbers: Any, tangents: Any) -> tuple[Any, Any]:
        """The derivative's rule: ``dx = -H^-1 dG``, a symmetric system, which JAX transposes.

        The product with ``H`` is never asked for, as no second derivative is taken.
        """
        moved: list[tuple[Of, Any]] = [
            (name, tangent)
            for name, tangent in zip(_NUMBERS, tangents, strict=True)
            if not isinstance(tangent, jax.custom_derivatives.SymbolicZero)
        ]
        wanted: tuple[Of, ...] = tuple(name for name, _ in moved)
        value, *slopes = self._called(wanted, *numbers)
        force = jnp.zeros_like(value)
        for (_, tangent), slope in zip(moved, slopes, strict=True):
            force -= jnp.tensordot(jnp.ravel(tangent), slope, axes=1)

        def yielded(_: Any, force: Any) -> Any:
            return self._on_host(self._yielded, (self._shape(),), *numbers, force)[0]

        change = lax.custom_linear_solve(lambda v: v, force, yielded, symmetric=True)
        return value, change

    def _shape(self, *leading: int) -> Any:
        return jax.ShapeDtypeStruct((*leading, 4, self.domain.n_coefficients), np.float64)

    @staticmethod
    def _on_host(function: Any, shapes: tuple[Any, ...], *numbers: Any) -> Any:
        """``function`` of arrays on the host; once for each entry of leading axes."""
        plain = [np.ndim(number) for number in numbers]

        def call(*arrays: Any) -> tuple[Array, ...]:
            _check_processors()
            arrays = tuple(np.asarray(a) for a in arrays)
            batch = arrays[0].shape[: arrays[0].ndim - plain[0]]
            flat = [a.reshape(-1, *a.shape[len(batch) :]) for a in arrays]
            joined = [np.stack(parts) for parts in zip(*function(*flat), strict=True)]
            return tuple(part.reshape(*batch, *part.shape[1:]) for part in joined)

        return jax.pure_callback(call, shapes, *numbers, vmap_method="broadcast_all")

    def _solved(self, wanted: tuple[Of, ...], *numbers: Array) -> list[tuple[Array, ...]]:
        """The value and what depends on it, for each entry of the numbers."""
        made = []
        for each in zip(*numbers, strict=True):
            map_ = self._known(*each).map
            assert isinstance(map_, HarmonicMap)
            value = np.stack([part(c) for c in (map_.phi, map_.psi) for part in (np.real, np.imag)])
            sizes = [each[_NUMBERS.index(name)].size for name in wanted]
            nothing = [np.full((size, *value.shape), np.nan) for size in sizes]
            minimum = self._minimum(*each) if wanted else None
            slopes = nothing if minimum is None else [minimum.gradients(name) for name in wanted]
            made.append((value, *slopes))
        return made

    def _yielded(self, *arrays: Array) -> list[tuple[Array]]:
        """The changes under forces, the last array; forces on one map are solved for together."""
        *numbers, forces = arrays
        made, together = np.full(forces.shape, np.nan), defaultdict[Any, list[int]](list)
        for i, each in enumerate(zip(*numbers, strict=True)):
            together[tuple(number.tobytes() for number in each)].append(i)
        for places in together.values():
            minimum = self._minimum(*(number[places[0]] for number in numbers))
            if minimum is not None:
                made[places] = minimum.yielded(forces[places])
        return [(one,) for one in made]

    def _minimum(self, *numbers: Array) -> Minimum | None:
        """The minimum for these numbers; None if there is none and nothing is thrown."""
        try:
            minimum = self._known(*numbers).minimum
        except SensitivityError:
            if self.throw:
                raise
            return None
        return minimum

    def _known(self, *numbers: Array) -> Result:
        """The result for these numbers. The last few are kept, for derivatives follow values."""
        key = tuple(number.tobytes() for number in numbers)
        if (result := self._kept.get(key)) is None:
            given: dict[str, Any] = dict(zip(_NUMBERS, numbers, strict=True))
            s = given.pop("s")
            result = self.result(**given, s=s if self._has_s else None)
            if self.throw and not result.status.ok:
                raise SensitivityError(f"the solve has reached no minimum: {result.message}")
            self._kept[key] = result
            for old in list(self._kept)[:-_KEPT]:
                self._kept.pop(old, None)
        return result

    @functools.cached_property
    def _kept(self) -> dict[Any, Result]:
        return {}


def _check_processors() -> None:
    """Raise a SensitivityError where JAX would wait for ever: its only thread waits for us."""
    known = getattr(os, "sched_getaffinity", None)
    count = len(known(0)) if known is not None else os.cpu_count()
    if count == 1 and threading.current_thread().name.startswith("Dummy"):  # a thread of JAX
        remedy = "call it without jax.jit, or let the process use two processors"
        raise SensitivityError(f"within jax.jit a solve needs two processors; {remedy}")


def differentiable(
    domain: Domain,
    pose: Pose,
    energy: Energy | str | None = None,
    options: Options | None = None,
    start: HarmonicMap | Result | None = None,
    *,
    throw: bool = True,
) -> DifferentiableSolve:
    """:func:`glid_nb.solve` as a function of JAX, with its derivative.

    ``f = differentiable(domain, pose)`` gives ``f(targets)``, the map as a :class:`TracedMap`. It
    is called at points within JAX. ``f`` also takes ``handles``, ``weights`` and the energy's
    parameter ``s``. It works under ``jax.jit``, ``jax.grad``, ``jax.jacfwd``, ``jax.jacrev`` and
    ``jax.vmap``, once: second derivatives are refused. The derivative is that of the implicit
    function theorem, with the exact Hessian at the minimum. Angles, scales and stiff areas of the
    pose stay as they are.

    The rule is Optimistix's ``ImplicitAdjoint``. JAX must compute in double precision:
    ``jax.config.update("jax_enable_x64", True)``. The context ``jax.enable_x64`` is not enough,
    because it does not reach the threads of JAX. Each value is a solve on the host, from ``start``;
    with a result of the same domain as the start a solve takes few iterations. Within ``jax.jit``
    this needs two processors, because the solve runs JAX itself while JAX waits for it; on one an
    error says so. The value is that of :func:`glid_nb.solve`, so it is certified. Where
    :func:`glid_nb.solve` jumps from one minimum to another, the derivative is that of the minimum
    which was reached.

    With ``throw``, a solve that does not converge or has no isolated minimum raises a
    SensitivityError, which reaches you inside JAX's own JaxRuntimeError, with its words. With
    ``throw=False`` the value is then the certified map that was reached, and its derivatives are
    NaN. Fewer than two handles without an angle leave a rotation free, so there is no derivative.

    Raises a TypeError that names an argument of the wrong type, an EnergyError for an unknown
    energy, a PoseError when a handle lies outside the domain.
    """
    check_type("domain", domain, Domain, "make one with Domain.from_cage(cage)")
    check_type("pose", pose, Pose, "make one with Pose(handles, targets)")
    check_type("options", options, Options | None, "write Options(p2p_weight=...)")
    check_type("start", start, HarmonicMap | Result | None, "an earlier result or its map")
    check_type("throw", throw, bool, "True raises, False gives NaN")
    pose.check_inside(domain)
    if len(pose) == 0:
        raise InputError("the pose has no handles, so there is nothing to differentiate by")
    return DifferentiableSolve(domain, pose, as_energy(energy), options or Options(), start, throw)
