"""A problem: a domain and a pose, as one value and as one JSON file."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from glid_nb._files import write_text_atomically
from glid_nb.geometry import Domain, GeometryError
from glid_nb.session.json_file import (
    InputFileError,
    check_loops,
    check_points,
    check_positive,
    read_json_object,
    require_keys,
)
from glid_nb.solvers import Pose, PoseError


@dataclass(frozen=True)
class Problem:
    """What a solver is given: where the map lives and what it should do.

    Parameters
    ----------
    domain : Domain
        The shape.
    pose : Pose
        Handles inside the shape, and their targets.

    Raises
    ------
    PoseError
        When a handle lies outside the domain.
    """

    domain: Domain
    pose: Pose

    def __post_init__(self) -> None:
        self.pose.check_inside(self.domain)

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Problem:
        """The problem in a JSON object.

        Parameters
        ----------
        data : mapping
            ``cage``, ``handles`` and ``targets`` are required, ``holes`` is optional, all in world
            coordinates. ``offset`` (a distance), ``offset_cage``, ``offset_holes`` and
            ``hole_points`` are used when given and chosen when not. Other keys are ignored.

        Raises
        ------
        InputFileError, GeometryError, PoseError
            When something is missing or not valid; the message names the key or the place.
        """
        require_keys(data, ("cage", "handles", "targets"))
        for key in ("cage", "handles", "targets", "offset_cage", "hole_points"):
            if data.get(key) is not None:
                check_points(data[key], key)
        for key in ("holes", "offset_holes"):
            if data.get(key) is not None:
                check_loops(data[key], key)
        if data.get("offset") is not None:
            check_positive(data["offset"], "offset")
        parts = ("cage", "holes", "offset", "offset_cage", "offset_holes", "hole_points")
        domain = Domain.from_dict({key: data[key] for key in parts if key in data})
        return cls(domain, Pose.from_dict(data))

    def to_dict(self) -> dict[str, Any]:
        """Plain JSON values under the keys that :meth:`from_dict` reads."""
        return {**self.domain.to_dict(), **self.pose.to_dict()}

    def save(self, path: str | Path) -> None:
        """Write the problem as JSON, atomically."""
        write_text_atomically(Path(path), json.dumps(self.to_dict()))

    @classmethod
    def load(cls, path: str | Path) -> Problem:
        """Read a problem from a JSON file.

        Raises
        ------
        InputFileError
            When the file does not hold a valid problem; the message names the file and the culprit.
        OSError
            When it cannot be read.
        """
        data = read_json_object(path)
        try:
            return cls.from_dict(data)
        except (InputFileError, GeometryError, PoseError) as error:
            raise InputFileError(f"{path}: {error}") from error


def load_pose(path: str | Path) -> Pose:
    """Read ``handles`` and ``targets`` from a JSON file; other keys are ignored.

    Raises
    ------
    InputFileError
        When the file does not hold a valid pose; the message names the file and the culprit.
    OSError
        When it cannot be read.
    """
    data = read_json_object(path)
    try:
        require_keys(data, ("handles", "targets"))
        for key in ("handles", "targets"):
            check_points(data[key], key)
        return Pose.from_dict(data)
    except (InputFileError, PoseError) as error:
        raise InputFileError(f"{path}: {error}") from error
