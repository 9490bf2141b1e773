"""The shapes and poses on which methods are compared."""

import functools
import hashlib
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import shapely

from glid_nb import samples
from glid_nb._errors import InputFileError
from glid_nb._json import read_object
from glid_nb.geometry import Domain
from glid_nb.imaging import read_image, trace
from glid_nb.samples import PoseKind
from glid_nb.session.problem import Problem, load_pose


@dataclass(frozen=True)
class Case:
    """One problem with a name."""

    name: str
    problem: Problem

    @property
    def digest(self) -> str:
        """A hash of all bits of the cage, the handles and their targets."""
        digest = hashlib.sha256()
        pose = self.problem.pose
        for array in (*self.problem.domain.cage.loops, pose.handles, pose.targets):
            digest.update(np.ascontiguousarray(array, dtype=float).tobytes())
        return digest.hexdigest()

    @property
    def perimeter(self) -> float:
        """Length of the boundary, world units."""
        return sum(shapely.LinearRing(loop).length for loop in self.problem.domain.cage.loops)


@functools.cache
def sample_case(name: str, kind: PoseKind) -> Case:
    """A bundled picture, traced, with one of its poses."""
    domain = Domain.from_cage(trace(read_image(samples.path(name))).cage)
    return Case(f"{name}-{kind}", Problem(domain, load_pose(samples.pose_path(name, kind))))


def reference_cases(folder: Path) -> dict[str, Case]:
    """The problems in a folder's JSON files, by name in lower case; other files are ignored.

    Raises an InputFileError if no file holds a problem, or if a problem is not valid.
    """
    cases = {}
    for path in sorted(folder.glob("*.json")):
        data = read_object(path)
        if "handles" in data and "cage" in data:
            name = re.sub(r"[^a-z0-9]+", "-", path.stem.lower())
            cases[name] = Case(name, Problem.load(path))
    if not cases:
        raise InputFileError(f"{folder}: no JSON file in this folder holds a cage and handles")
    return cases
