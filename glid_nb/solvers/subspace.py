"""A run of a method in the harmonic subspace: its problem, its map and its panels."""

import functools
from typing import Any

import numpy as np

from glid_nb._arrays import Array
from glid_nb._jax import jit
from glid_nb.certificate import Certificate, certify, proved_by
from glid_nb.geometry import Panels
from glid_nb.harmonic import HarmonicMap
from glid_nb.solvers import evaluation, problem
from glid_nb.solvers.discretisation import Discretisation, Matrices, discretise
from glid_nb.solvers.evaluation import Point
from glid_nb.solvers.loop import Descent, Ending, Reached
from glid_nb.solvers.method import Inputs, Method, StartError
from glid_nb.solvers.positional import measured_apart, positional_energy
from glid_nb.solvers.problem import SubspaceProblem, canonical, map_from, unknowns_of
from glid_nb.solvers.result import Iteration, Result, Status
from glid_nb.solvers.stiffness import stiff_matrices

# MOST_MEASUREMENTS: after this many measurements of angles and scales, their directions are fixed.
# KEPT: the damping that fixes them.
MOST_MEASUREMENTS, KEPT = 16, 1e9
# _FAR: a measurement has overshot if it differs from the last one by more than this, in radians.
# _DAMPING: then the damping is multiplied by this.
_FAR, _DAMPING = 0.2, 3.0


class SubspaceDescent(Descent):
    """A run of a method in the harmonic subspace, such as Algorithm 1. ``reduced``: the unknowns
    are whitened coordinates."""

    uses_lapack = True
    discretisation: Discretisation
    proved: tuple[Panels, Array, Array] | None = None
    """The proof of the last step: panels, bounds on sigma_2 and turnings."""
    just_split = 0  # panels split since the last iteration
    _measurements, _damping = 1, 1.0

    def __init__(self, method: Method, inputs: Inputs, reduced: bool) -> None:
        super().__init__(method, inputs)
        options, pose = inputs.options, inputs.pose
        map_, self.given, self.discretisation = _starting_point(method, inputs)
        self.start = problem.aligned(map_, pose) if options.align else map_
        self.point: Point | None = None
        """Where it is, with its energies; None until the first advance has evaluated the start."""
        self._start_coefficients = problem.real_coefficients(self.start)
        basis = self.discretisation.basis
        whitening = self.discretisation.matrices.whitening if reduced else None
        self.problem = SubspaceProblem(
            matrices=self.matrices,
            singularities=basis.singularities,
            unknowns=unknowns_of(basis, options.conformal, whitening),
            positional=positional_energy(self.start, pose, options.p2p_weight),
            energy=inputs.energy,
            anchor=problem.anchor_of(basis, self._start_coefficients),
        )

    @property
    def coefficients(self) -> Any:
        """Padded real coefficients of where it is."""
        return self._start_coefficients if self.point is None else self.point.coefficients

    @property
    def evaluated(self) -> Point:
        """Where it is, after the first advance."""
        assert self.point is not None, "the start is not evaluated yet"
        return self.point

    @property
    def matrices(self) -> Matrices:
        """The panels' matrices, with the weights of the pose's stiffness."""
        disc, stiffness = self.discretisation, self.inputs.pose.stiffness
        return stiff_matrices(disc, stiffness) if stiffness else disc.matrices

    def measure_turns(self, map: HarmonicMap) -> bool:
        """Measure angles and scales from this map. Returns whether this changes the objective."""
        inputs, before = self.inputs, self.problem.positional
        if not inputs.pose.oriented.any() or self._damping == KEPT:
            return False
        self._damping = KEPT if self._measurements == MOST_MEASUREMENTS else self._damping
        weight, damping = inputs.options.p2p_weight, self._damping
        now = positional_energy(map, inputs.pose, weight, damping)
        apart = measured_apart(before, now)
        self._damping *= _DAMPING if apart > _FAR and damping != KEPT else 1
        self._measurements += 1
        self.problem = self.problem._replace(positional=now)
        return apart > 0

    def reached(self) -> Reached:
        point, domain = self.evaluated, self.inputs.domain
        iso, p2p = float(point.energy_distortion), float(point.energy_p2p)
        entry = Iteration(
            energy_distortion=iso,
            energy_p2p=p2p,
            sigma2_lower=None if self.sigma2_lower is None else float(self.sigma2_lower.min()),
            panels=len(self.discretisation.panels),
            panels_split=self.just_split,
        )
        if self.proved is None:
            return Reached(entry, lambda: self.start_proof)
        proof = *self.proved, self.discretisation.certificate
        return Reached(entry, lambda: proved_by(map_from(domain, point.coefficients), *proof))

    def prove(self, sigma2_lower: Any, turning: Any) -> None:
        panels = self.discretisation.panels
        self.sigma2_lower, turns = (np.asarray(a)[: len(panels)] for a in (sigma2_lower, turning))
        self.proved = panels, self.sigma2_lower, turns

    @functools.cached_property
    def start_proof(self) -> Certificate:
        """The proof of the start; computed only if no step was taken. If rounding prevents the
        proof after the alignment, it is the proof of the map before the alignment."""
        if self.given is not None and self.given.belongs_to(self.start):
            return self.given
        certificate = certify(self.start)
        if not certificate.certified:
            identity = HarmonicMap.identity(self.inputs.domain)
            certificate = certify(identity) if self.given is None else self.given
        if not certificate.certified:
            raise StartError(f"the identity cannot be proved here: {certificate.reason}")
        return certificate

    def result(self, ending: Ending, compile_time: float, solve_time: float) -> Result:
        """The result; with the map before the alignment if the start itself cannot be proved."""
        if self.proved is None and not self.start_proof.belongs_to(self.start):
            ending = Ending(Status.UNPROVED)
            coefficients = problem.real_coefficients(self.start_proof.map)
            self.point = evaluated_at(self.problem, coefficients)
        return super().result(ending, compile_time, solve_time)

    def split(self, refused: Array) -> int:
        wanted = self.discretisation.splittable(refused)
        count = int(wanted.sum())
        if count:
            self.discretisation = self.discretisation.split(wanted)
            self.problem = self.problem._replace(matrices=self.matrices)
            self.just_split += count
        return count


evaluated_at = jit(evaluation.evaluated)


def _starting_point(
    method: Method, inputs: Inputs
) -> tuple[HarmonicMap, Certificate | None, Discretisation]:
    domain, options, start = inputs.domain, inputs.options, inputs.start
    fresh = functools.partial(discretise, domain, options.sampling, options.certificate)
    proof = method.proved_start(inputs)
    if proof is None:
        return HarmonicMap.identity(domain), None, fresh()
    map_ = proof.map
    if options.conformal and np.abs(map_.psi - map_.psi[0]).max() > 0:
        what = "the map to start from is not conformal (psi is not constant)"
        raise StartError(f"{what}; start from one that is, or turn the option conformal off")
    disc = start.discretisation if isinstance(start, Result) else None
    if disc is None or (disc.sampling, disc.certificate) != (options.sampling, options.certificate):
        disc = fresh()
    return canonical(HarmonicMap(domain, map_.phi, map_.psi)), proof, disc
