"""A method at work in the harmonic subspace: its problem, its map, and its panels."""

from __future__ import annotations

import functools
from typing import Any

import numpy as np

from glid_nb._arrays import Array
from glid_nb._errors import InputError
from glid_nb.certificate import certify
from glid_nb.geometry import Domain
from glid_nb.harmonic import HarmonicMap, as_complex
from glid_nb.solvers.discretisation import Discretisation, discretise
from glid_nb.solvers.evaluation import Point
from glid_nb.solvers.loop import Descent, Reached
from glid_nb.solvers.method import Inputs, Method
from glid_nb.solvers.pose import Pose, rigid_motion
from glid_nb.solvers.problem import (
    Problem,
    handle_images,
    map_from,
    positional_energy,
    real_coefficients,
)
from glid_nb.solvers.result import Iteration, Result
from glid_nb.solvers.unknowns import canonical, unknowns_of


class StartError(InputError):
    """The map to start from cannot be used."""


def check_belongs(map: HarmonicMap, domain: Domain) -> None:
    """Raise :class:`StartError` for a map of another domain; equal domains are the same."""
    if map.domain is not domain and map.domain.to_dict() != domain.to_dict():
        raise StartError(
            "the map to start from belongs to another domain; start from a map of this one"
        )


class SubspaceDescent(Descent):
    """A method at work on maps of the harmonic subspace.

    ``reduced``: the unknowns are those of the whitened coordinates, not of all columns.

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
        self.problem = Problem(
            matrices=self.discretisation.matrices,
            singularities=basis.singularities,
            unknowns=unknowns_of(
                basis,
                options.conformal,
                self.discretisation.matrices.whitening if reduced else None,
            ),
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
    if options.conformal and np.abs(map_.psi - map_.psi[0]).max() > 0:
        raise StartError(
            "the map to start from is not conformal (psi is not constant); start from a conformal "
            "map or turn the option conformal off"
        )
    if isinstance(start, Result):
        disc, wanted = start.discretisation, (options.sampling, options.certificate)
        if disc is None or (disc.sampling, disc.certificate) != wanted:
            disc = fresh()
        return canonical(map_), disc
    certificate = certify(map_)
    if not certificate.certified:
        raise StartError(f"the map to start from is not certified: {certificate.reason}")
    return canonical(HarmonicMap(domain, map_.phi, map_.psi)), fresh()


def aligned(map: HarmonicMap, pose: Pose, images: Array | None = None) -> HarmonicMap:
    """The map followed by the rigid motion that brings its handles closest to their targets.

    A rigid motion changes neither the isometric energy nor the certificate. ``images`` (h, 2) are
    the handles' images under the map, when they are known.
    """
    if not len(pose):
        return map
    known = map(pose.handles) if images is None else images
    turn, middle, aim = rigid_motion(as_complex(known), as_complex(pose.targets))
    phi, psi = map.phi * turn, map.psi * np.conj(turn)
    phi[: len(map.domain.offset_cage.loops_complex[0])] += aim - turn * middle
    return HarmonicMap(map.domain, phi, psi)
