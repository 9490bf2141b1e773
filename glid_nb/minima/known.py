"""What a search for a lower minimum knows: the problem, the results, and how maps turn lines."""

import functools
from dataclasses import replace

from glid_nb.energies import isometry_energy
from glid_nb.minima.handle_turns import HandleTurns, handle_turns
from glid_nb.solvers.method import Inputs
from glid_nb.solvers.result import Result, Status

# Energies are compared with multiples of an isometry's energy, which is taken as at least this.
LEAST_ISOMETRY = 0.5
# Below this multiple no other way is tried.
LOW_ENERGY = 1.02
# Above this multiple an energy is high, and more ways are tried.
HIGH_ENERGY = 2.5
# Above this multiple the first map counts as hopeless and every way is tried. Below it the last
# resorts (staged weights) never helped.
HIGHEST_ENERGY = 25.0
# A way must gain at least this share of the best energy. Of 256 good poses 89 try other ways.
_GAIN = 0.015
# Energies closer than this, relative, are those of one minimum.
SAME_ENERGY = 1e-6
# With a smaller limit of iterations the caller wants to look at them, not to find the minimum.
_FEW_ITERATIONS = 20


class Known:
    """The state of a search: the results so far, the best of them, and the turns of their maps."""

    def __init__(self, first: Result, inputs: Inputs) -> None:
        self.first = first
        self.inputs = inputs
        self.best = first
        self.tried: list[tuple[str, Result]] = [("direct", first)]
        self.isometry = isometry_energy(inputs.energy)
        self.high = is_above(first, HIGH_ENERGY)
        self.hopeless = is_above(first, HIGHEST_ENERGY)
        self.better: HandleTurns | None = None
        """How the best map turns lines, once one with other turns than the first is the best."""

    @functools.cached_property
    def turns(self) -> HandleTurns:
        """How the first map turns lines."""
        return handle_turns(self.first.map, self.inputs.pose)

    @property
    def all_turns(self) -> list[HandleTurns]:
        """Of the first map and, if that is known, of a better one with other turns."""
        return [self.turns] if self.better is None else [self.turns, self.better]

    @property
    def excess(self) -> float:
        """The best energy above that of an isometry."""
        return self.best.energy - self.isometry

    def gains(self, share: float) -> bool:
        """Whether a map would be better by `_GAIN` if its energy above an isometry's were this
        share of the best map's."""
        predicted = self.isometry + share * self.excess
        return is_above(self.best, predicted / (1 - _GAIN) / max(self.isometry, LEAST_ISOMETRY))

    def add(self, name: str, result: Result) -> None:
        """Keep a result, and as the best one if it is: it must be of the pose that was asked for,
        not of a waypoint at which its way was given up."""
        self.tried.append((name, result))
        ended = result.pose is self.inputs.pose
        if ended and result.energy < self.best.energy * (1 - SAME_ENERGY):
            self.best = result

    def stop(self, name: str, result: Result) -> None:
        """Keep the result of a way that the callback stopped."""
        self.tried.append((name, result))
        lower = min(self.best, result, key=lambda r: r.energy)
        self.best = replace(lower, status=Status.STOPPED)


def is_above(result: Result, multiple: float) -> bool:
    """Whether another way may end lower: the solve has not converged, or its energy is above a
    multiple of an isometry's."""
    if result.status in (Status.STOPPED, Status.INDEFINITE):
        return False
    if result.status is Status.MAX_ITERATIONS and result.iterations < _FEW_ITERATIONS:
        return False
    isometry = max(isometry_energy(result.energy_measure), LEAST_ISOMETRY)
    return not result.status.ok or result.energy > multiple * isometry
