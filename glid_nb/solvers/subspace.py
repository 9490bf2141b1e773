"""A method at work in the harmonic subspace: its problem, its map, and its panels."""

from __future__ import annotations

import functools
from typing import Any

from numpy.typing import NDArray

from glid_nb.harmonic import HarmonicMap
from glid_nb.solvers.discretisation import Discretisation, discretise
from glid_nb.solvers.evaluation import Point
from glid_nb.solvers.loop import Descent, Reached
from glid_nb.solvers.method import Inputs, Method
from glid_nb.solvers.problem import (
    Problem,
    handle_images,
    map_from,
    positional_energy,
    real_coefficients,
)
from glid_nb.solvers.result import Iteration, Result
from glid_nb.solvers.start import aligned, check_conformal, check_proved
from glid_nb.solvers.unknowns import canonical, unknowns_of

Array = NDArray[Any]


class SubspaceDescent(Descent):
    """A method at work on maps of the harmonic subspace.

    Parameters
    ----------
    method : Method
    inputs : Inputs
    reduced : bool
        Whether the unknowns are those of the columns that have any, or of all columns.

    Attributes
    ----------
    problem : Problem
    point : Point
        Where it is; known at the latest after the first advance.
    sigma2_lower : array or None
        (p,) certified bound per panel there.
    just_split : int
        Panels split since the last iteration.
    """

    uses_lapack = True
    discretisation: Discretisation
    point: Point
    sigma2_lower: Array | None = None

    def __init__(self, method: Method, inputs: Inputs, reduced: bool) -> None:
        super().__init__(method, inputs)
        options, pose = inputs.options, inputs.pose
        map_, self.discretisation = _starting_point(method, inputs)
        basis = self.discretisation.basis
        columns = basis.unknown_columns if reduced else None
        self.problem = Problem(
            matrices=self.discretisation.matrices,
            singularities=basis.singularities,
            unknowns=unknowns_of(basis, options.conformal, columns),
            positional=positional_energy(inputs.domain, pose, options.p2p_weight),
            energy=inputs.energy,
        )
        if options.align:
            images = handle_images(self.problem.positional, basis, map_)[: len(pose)]
            map_ = aligned(map_, pose, images)
        self.coefficients: Any = real_coefficients(basis, map_)
        self.just_split = 0

    def reached(self) -> Reached:
        """After the last advance."""
        point, domain = self.point, self.inputs.domain
        iso, p2p = float(point.energy_iso), float(point.energy_p2p)
        entry = Iteration(iteration=0, energy_iso=iso, energy_p2p=p2p, time=0.0)
        return Reached(entry, lambda: map_from(domain, point.coefficients), self.sigma2_lower)

    def split(self, refused: Array) -> int:
        """Split the panels that refused a step; 0 when none can be."""
        wanted = self.discretisation.splittable(refused)
        count = int(wanted.sum())
        if count:
            self.discretisation = self.discretisation.refined(wanted)
            self.problem = self.problem._replace(matrices=self.discretisation.matrices)
            self.just_split += count
        return count


def _starting_point(method: Method, inputs: Inputs) -> tuple[HarmonicMap, Discretisation]:
    """The map to start from, checked, and panels for it."""
    domain, options, start = inputs.domain, inputs.options, inputs.start
    fresh = functools.partial(discretise, domain, options.sampling, options.certificate)
    map_ = method.harmonic_start(inputs)
    if map_ is None:
        return HarmonicMap.identity(domain), fresh()
    if options.conformal:
        check_conformal(map_)
    if isinstance(start, Result):
        disc, wanted = start.discretisation, (options.sampling, options.certificate)
        if disc is None or (disc.sampling, disc.certificate) != wanted:
            disc = fresh()
        return canonical(map_), disc
    check_proved(map_)
    return canonical(HarmonicMap(domain, map_.phi, map_.psi)), fresh()
