"""What every method returns, and what it shows while it works."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from dataclasses import dataclass, field

from glid_nb.certificate import Certificate, certify
from glid_nb.harmonic import HarmonicMap
from glid_nb.methods.mesh.map import MeshMap
from glid_nb.solvers import Pose, Status

DeformationMap = HarmonicMap | MeshMap


@dataclass(frozen=True)
class Step:
    """One iteration of a method, as it was after its step; the first entry is the start."""

    iteration: int
    """0 for the start, 1 for the first step."""
    energy: float
    """Total energy: the isometric part plus ``lambda / 2`` times the squared distances."""
    energy_iso: float
    """Isometric part: the mean of the density over the boundary, or over the mesh's area."""
    energy_p2p: float
    step: float
    """Step length along the method's own direction; NaN where there is none."""
    time: float
    """Seconds, without compilation and without what only serves this record; for the start, what
    its making took beyond preparing the domain."""
    flips: int | None
    """Triangles that are turned over or flat; ``None`` for a harmonic map, which is certified."""
    sigma2_lower: float
    """Certified lower bound on ``sigma_2`` of the whole domain; NaN where there is none."""

    @property
    def decrement(self) -> float:
        """NaN: what a method other than Newton's could call by this name does not compare."""
        return math.nan


@dataclass(frozen=True)
class MethodProgress:
    """What a callback sees after each iteration."""

    method: str
    history: tuple[Step, ...]
    _map: Callable[[], DeformationMap] = field(repr=False)

    @property
    def map(self) -> DeformationMap:
        """The map of this moment."""
        return self._map()


Callback = Callable[[MethodProgress], bool | None]
"""Called after the start and after each iteration; returning ``True`` stops the method there."""


@dataclass(frozen=True, eq=False)
class MethodResult:
    """The outcome of :func:`glid_nb.methods.run_method`, the same for every method."""

    method: str
    map: DeformationMap
    status: Status
    message: str
    """The outcome as a full sentence."""
    history: tuple[Step, ...]
    """The start, then one entry per iteration."""
    pose: Pose
    compile_time: float
    """Seconds spent compiling, counted in no step."""
    _certificate: Certificate | None = field(default=None, repr=False)

    @property
    def iterations(self) -> int:
        """Iterations taken."""
        return self.history[-1].iteration

    @property
    def energy(self) -> float:
        """Total energy of :attr:`map`."""
        return self.history[-1].energy

    @property
    def energy_iso(self) -> float:
        """Isometric part of :attr:`energy`."""
        return self.history[-1].energy_iso

    @property
    def energy_p2p(self) -> float:
        """Positional part of :attr:`energy`."""
        return self.history[-1].energy_p2p

    @property
    def solve_time(self) -> float:
        """Seconds of all steps together, the start included."""
        return sum(step.time for step in self.history)

    @functools.cached_property
    def certificate(self) -> Certificate | None:
        """The proof for a harmonic map, computed on first use; ``None`` for a mesh."""
        if self._certificate is not None:
            return self._certificate
        return certify(self.map) if isinstance(self.map, HarmonicMap) else None

    @property
    def flips(self) -> int | None:
        """Triangles that are turned over or flat; ``None`` for a harmonic map."""
        return self.history[-1].flips
