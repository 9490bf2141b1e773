"""A problem: a domain and a pose, as one value and as one JSON file."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

from glid_nb import _json
from glid_nb._arrays import Array
from glid_nb._errors import about
from glid_nb.geometry import Domain
from glid_nb.imaging import PixelFrame
from glid_nb.pose import Pose, PoseError

_POSE = {"handles": _json.check_points, "targets": _json.check_points}
_CHOSEN_WHEN_MISSING = {
    "holes": _json.check_loops,
    "offset": _json.check_positive,
    "offset_cage": _json.check_points,
    "offset_holes": _json.check_loops,
    "hole_points": _json.check_points,
}


@dataclass(frozen=True)
class Problem:
    """A domain and a pose. Raises a PoseError if a handle lies outside the domain."""

    domain: Domain
    pose: Pose
    """Handles inside the domain, and their targets."""

    def __post_init__(self) -> None:
        self.pose.check_inside(self.domain)

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Self:
        """The problem in a JSON object.

        The keys ``cage``, ``handles`` and ``targets`` are required, ``holes`` is optional. All are
        in world coordinates. If ``offset`` (a distance), ``offset_cage``, ``offset_holes`` and
        ``hole_points`` are missing, they are chosen automatically. ``depths``, ``angles``,
        ``scales`` and ``weights`` are as in :class:`~glid_nb.Pose`. Other keys are ignored.

        Raises an InputFileError, GeometryError or PoseError if something is missing or not valid.
        The message names the key or the place.
        """
        required = {"cage": _json.check_points, **_POSE}
        _json.check_fields(data, "a problem", required, _CHOSEN_WHEN_MISSING, others=True)
        shape = {key: data.get(key) for key in ("cage", *_CHOSEN_WHEN_MISSING)}
        domain, pose = Domain.from_dict(shape), Pose.from_dict(data)
        outside = not domain.cage.contains(pose.handles).all()
        if outside and (size := data.get("image_size_px")) is not None:
            frame = PixelFrame(*_json.picture_size(size, "image_size_px"))
            _refuse_pixels(domain, pose.handles, frame)
        return cls(domain, pose)

    def to_dict(self) -> dict[str, Any]:
        """Plain JSON values under the keys that :meth:`from_dict` reads."""
        return {**self.domain.to_dict(), **self.pose.to_dict()}

    def save(self, path: str | Path) -> None:
        """Write the problem as JSON, atomically."""
        _json.write_json(path, self.to_dict())

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Read a problem from a JSON file.

        Raises an InputFileError that names the file and the wrong part if the problem is not valid.
        """
        with about(path):
            return cls.from_dict(_json.read_object(path))


def _refuse_pixels(domain: Domain, handles: Array, frame: PixelFrame) -> None:
    """Raise a PoseError if the handles lie inside the domain when read as pixels of the picture."""
    for order, name in ((slice(None), "(x, y)"), (slice(None, None, -1), "(row, column)")):
        if domain.cage.contains(frame.to_world(handles[:, order])).all():
            xmin, ymin, xmax, ymax = frame.bounds
            world = f"x from {xmin:g} to {xmax:g} and y, upwards, from {ymin:g} to {ymax:g}"
            picture = f"the picture of {frame.width} x {frame.height} pixels spans {world}"
            index = "" if name == "(x, y)" else "[:, ::-1]"
            call = f"PixelFrame({frame.width}, {frame.height}).to_world(handles{index})"
            what = (
                f"handles and targets are pixels {name}, not world coordinates, in which {picture}"
            )
            raise PoseError(f"{what}; convert both: {call}")


def load_pose(path: str | Path) -> Pose:
    """Read a pose, as `Pose.to_dict` writes it, from a JSON file. Other keys are ignored.

    Raises an InputFileError that names the file and the wrong part if the pose is not valid.
    """
    with about(path):
        data = _json.read_object(path)
        _json.check_fields(data, "a pose", _POSE, others=True)
        return Pose.from_dict(data)
