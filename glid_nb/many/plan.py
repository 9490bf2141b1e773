"""What the poses of one shape share, and the keys by which processes and files know problems."""

import functools
import hashlib
import json
import pickle
from dataclasses import dataclass
from importlib.metadata import version
from typing import Any

import numpy as np

from glid_nb.energies import CustomEnergy, Energy
from glid_nb.geometry import Domain
from glid_nb.pose import Pose
from glid_nb.solvers.method import Method
from glid_nb.solvers.options import Options


@dataclass(frozen=True, eq=False)
class Plan:
    """Everything of a problem but its pose. A worker gets it once."""

    domain: Domain
    energy: Energy
    options: Options
    method: Method

    @functools.cached_property
    def key(self) -> str:
        """A hash of all values and of this package's version, the same in every process."""
        digest = hashlib.sha256(f"{our_version()}\n{_told(self.energy)}\n{self.options!r}".encode())
        digest.update(f"\n{_told(self.method)}\n{self.domain.notes!r}".encode())
        cages = self.domain.cage.loops, self.domain.offset_cage.loops
        for points in (*cages[0], *cages[1], self.domain.hole_points):
            digest.update(f"\n{len(points)}\n".encode())
            digest.update(np.ascontiguousarray(points, dtype="<f8").tobytes())
        return digest.hexdigest()

    @functools.cached_property
    def packed(self) -> Any:
        """The plan as bytes; itself if only the executor can pickle it, as cloudpickle does."""
        try:
            return pickle.dumps(self, protocol=5)
        except Exception:  # each class raises its own kind of error
            return self

    def problem_key(self, pose: Pose) -> str:
        """The hash of this plan with a pose."""
        values = {**pose.to_dict(), "names": pose.names.tolist()}
        return hashlib.sha256(f"{self.key}\n{json.dumps(values)}".encode()).hexdigest()

    def __getstate__(self) -> dict[str, Any]:
        """Without the key: the process that receives the plan computes the key itself."""
        names = ("domain", "energy", "options", "method")
        return {name: getattr(self, name) for name in names}


@functools.cache
def our_version() -> str:
    return version("glid-nb")


def _told(value: Energy | Method) -> str:
    """Class and parameters. A function is told by its name: its address differs by process."""
    kind = f"{type(value).__module__}.{type(value).__qualname__}"
    if isinstance(value, CustomEnergy):
        function = value.function
        name = getattr(function, "__qualname__", type(function).__qualname__)
        return f"{kind} {getattr(function, '__module__', '')}.{name}"
    return f"{kind} {value!r}"
