"""A deformation problem on a mesh."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glid_nb.energies import Energy
from glid_nb.harmonic import as_complex
from glid_nb.methods.mesh.map import MeshMap
from glid_nb.methods.mesh.operators import MeshOperators, flips
from glid_nb.methods.method import Inputs
from glid_nb.methods.recording import Snapshot
from glid_nb.methods.result import DeformationMap

Array = NDArray[Any]


@dataclass(frozen=True, eq=False)
class MeshProblem:
    """The mesh, its handles and targets, the energy."""

    operators: MeshOperators
    handles: Array
    """(h,) vertex indices."""
    targets: Array
    """(h,) complex."""
    energy: Energy
    p2p_weight: float
    start: Array
    """(v,) complex: the images to start from, rigidly moved if that was asked for."""

    @classmethod
    def of(cls, inputs: Inputs) -> MeshProblem:
        """The mesh problem of a method's inputs."""
        mesh, handles = inputs.mesh()
        operators = MeshOperators(mesh)
        targets = inputs.pose.targets @ np.array([1, 1j])
        start = _images(inputs.start, operators)
        if inputs.align and len(handles):
            start = _aligned(start, handles, targets)
        return cls(operators, handles, targets, inputs.energy, inputs.p2p_weight, start)

    def map_of(self, w: Array) -> MeshMap:
        """The map with these images."""
        return MeshMap(self.operators.mesh, np.stack([np.real(w), np.imag(w)], axis=-1))

    def snapshot(self, w: Array, seconds: float, step: float = math.nan) -> Snapshot:
        """The state of the record; none of this work is timed."""
        fz, fzb = self.operators.wirtinger(w)
        miss = w[self.handles] - self.targets
        return Snapshot(
            self.operators.energy(self.energy, fz, fzb),
            self.p2p_weight / 2 * float((np.abs(miss) ** 2).sum()),
            seconds,
            lambda: self.map_of(w),
            step=step,
            flips=flips(fz, fzb),
        )


def _images(map: DeformationMap | None, operators: MeshOperators) -> Array:
    """The images of the vertices, (v,) complex; by default they stay where they are."""
    if map is None:
        return operators.rest
    if isinstance(map, MeshMap) and map.triangulation is operators.mesh:
        return as_complex(map.images)
    return as_complex(map(operators.mesh.vertices))


def _aligned(w: Array, handles: Array, targets: Array) -> Array:
    """The rigid motion that brings the handles closest to their targets."""
    images = w[handles]
    middle, aim = images.mean(), targets.mean()
    correlation = np.vdot(images - middle, targets - aim)
    turn = correlation / abs(correlation) if abs(correlation) > 0 else 1.0
    return aim + turn * (w - middle)
