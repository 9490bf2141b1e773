"""A deformation problem in the harmonic subspace, on the host."""

from __future__ import annotations

import functools
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from glid_nb._jax import jax, jnp
from glid_nb._runtime import compilation_clock, double_precision
from glid_nb.energies import Energy
from glid_nb.geometry import Domain
from glid_nb.harmonic import HarmonicMap
from glid_nb.methods.subspace import evaluation
from glid_nb.methods.subspace.evaluation import Curvature, Move, Point, Setting
from glid_nb.solvers import OptionError, Options, Pose
from glid_nb.solvers.align import aligned
from glid_nb.solvers.discretisation import discretise
from glid_nb.solvers.solve import constraints_of, map_from, real_coefficients
from glid_nb.solvers.start import check_proved
from glid_nb.solvers.unknowns import restrict_hessian, unknowns_of

Array = NDArray[Any]
T = TypeVar("T")


@dataclass
class Stopwatch:
    """Seconds of work and of compilation, apart: a call that compiled is run again to time it."""

    seconds: float = 0.0
    compile_time: float = 0.0

    def run(self, function: Callable[..., T], *arguments: Any, **named: Any) -> T:
        """Call a pure device function and wait for its result."""
        clock = compilation_clock()
        programs, began = clock.programs, time.perf_counter()
        result = jax.block_until_ready(function(*arguments, **named))
        elapsed = time.perf_counter() - began
        if clock.programs > programs:
            began = time.perf_counter()
            result = jax.block_until_ready(function(*arguments, **named))
            self.compile_time += elapsed
            elapsed = time.perf_counter() - began
        self.seconds += elapsed
        return result

    def lap(self) -> tuple[float, float]:
        """Seconds and compilation since the last lap."""
        result = self.seconds, self.compile_time
        self.seconds = self.compile_time = 0.0
        return result


class SubspaceProblem:
    """Domain, pose and energy, discretised; its state is the discretisation, which may be refined.

    Parameters
    ----------
    options : Options
        ``sampling``, ``certificate``, ``p2p_weight``, ``conformal`` and ``align`` count here.
    hessian_samples : int, optional
        Number of Hessian samples of the uniform sampling, ``|H|`` (Figure 8).

    Raises
    ------
    OptionError
        When ``hessian_samples`` is out of range.
    StartError
        When the map to start from is not proved locally injective.
    """

    @double_precision
    def __init__(
        self,
        domain: Domain,
        pose: Pose,
        energy: Energy,
        options: Options,
        start: HarmonicMap | None = None,
        *,
        hessian_samples: int | None = None,
    ) -> None:
        self.pose, self.energy, self.options = pose, energy, options
        self.watch = Stopwatch()
        self.discretisation = discretise(domain, options.sampling, options.certificate)
        self.hessian_samples = hessian_samples
        if hessian_samples is not None:
            self._check_hessian_samples(hessian_samples)
        basis = self.discretisation.basis
        self.unknowns = unknowns_of(basis, options.conformal)
        self.constraints = constraints_of(domain, pose, options.p2p_weight)
        self.setting = self._setting()
        map_ = HarmonicMap.identity(domain)
        if start is not None:
            check_proved(start)
            map_ = start
        if options.align:
            map_ = aligned(map_, pose)
        self.start = real_coefficients(basis, map_)

    @property
    def can_refine(self) -> bool:
        """Whether panels may be split."""
        return self.discretisation.can_refine

    @functools.cached_property
    def p2p_hessian(self) -> Array:
        """(4c, 4c) Hessian of the positional energy, fixed and tied unknowns left out."""
        matrix, weights = evaluation.p2p_rows(self.constraints)
        h = restrict_hessian(matrix.T @ (weights[:, None] * matrix), self.unknowns)
        # The identity on what is fixed is already in the isometric Hessian.
        return np.asarray(h) - np.diag(1 - self.unknowns.free)

    def evaluate(self, coefficients: Array) -> Point:
        """The point with these coefficients."""
        return self.watch.run(evaluation.evaluate, self.setting, jnp.asarray(coefficients))

    def hessian(self, point: Point, curvature: Curvature) -> Array:
        """(4c, 4c) Hessian of the isometric energy; the identity on what is fixed or tied."""
        h = self.watch.run(evaluation.hessian, self.setting, point, curvature=curvature)
        return np.asarray(h)

    def advance(self, point: Point, direction: Array, may_refine: bool) -> Move:
        """One step of the line search."""
        return self.watch.run(
            evaluation.advance,
            self.setting,
            point,
            jnp.asarray(direction),
            np.asarray(may_refine and self.can_refine),
        )

    def refine(self, refused: Array) -> bool:
        """Split the panels that refused a step; False when none can be."""
        wanted = self.discretisation.splittable(refused)
        if not wanted.any():
            return False
        began = time.perf_counter()
        self.discretisation = self.discretisation.refined(wanted)
        self.setting = self._setting()
        self.watch.seconds += time.perf_counter() - began
        return True

    def map_of(self, coefficients: Any) -> HarmonicMap:
        """The map with these padded coefficients."""
        return map_from(self.discretisation, coefficients)

    def _check_hessian_samples(self, count: int) -> None:
        panels = len(self.discretisation.panels)
        if self.options.sampling != "uniform":
            raise OptionError("hessian_samples needs sampling='uniform'")
        if not 1 <= count <= panels:
            raise OptionError(f"hessian_samples must be from 1 to {panels}, got {count}")

    @double_precision
    def _setting(self) -> Setting:
        disc = self.discretisation
        matrices = disc.matrices
        if self.hessian_samples is not None:
            index = np.linspace(0, len(disc.panels), self.hessian_samples, endpoint=False)
            index = index.astype(int)
            matrices = matrices._replace(
                hessian_index=jnp.asarray(index),
                hessian_weights=jnp.full(len(index), 1 / len(index)),
            )
        return Setting(
            matrices,
            disc.basis.singularities,
            self.unknowns,
            self.constraints,
            self.energy,
        )
