"""A document: everything that the editor saves, as one value."""

import functools
from collections.abc import Sized
from dataclasses import dataclass, field, replace
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from glid_nb._arguments import check_fields
from glid_nb._arrays import read_only
from glid_nb._errors import InputFileError, about
from glid_nb.energies import Energy
from glid_nb.geometry import Cage, Domain
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging import Scribbles, TraceOptions
from glid_nb.pose import Pose
from glid_nb.session.look import WHOLE_CAGE, Look
from glid_nb.session.names import LONGEST_NAME
from glid_nb.session.pin_marks import PinMarks
from glid_nb.session.timeline import Timeline
from glid_nb.solvers import Iteration, Method, Newton, Options, Status

_MOST_POSES = 1000
MOST_PARTS = 100  # of a session
_ASKED = ("pose", "energy", "options", "method")  # the fields that a solve depends on


class DocumentError(InputFileError):
    """A document's parts do not fit together, or a file holds no valid document."""


@dataclass(frozen=True, eq=False)
class Solution:
    """How a solve ended. It is small, because an undo history holds many."""

    status: Status
    message: str
    history: tuple[Iteration, ...]  # the latest iterations of the gesture
    starts: tuple[int, ...]  # numbers of the iterations at which the targets had moved

    @property
    def ended(self) -> bool:
        """Whether the solver ended by itself, not by a stop."""
        return self.status is not Status.STOPPED


AS_SEEN = Solution(Status.STOPPED, "The map is as it was recorded or saved.", (), ())
"""The solution of poses that stay as they are until they are edited."""


@dataclass(frozen=True, eq=False)
class NamedPose:
    """A pose with a name and the certified map that was found for it.

    Raises a DocumentError for a wrong name or a handle outside the domain.
    """

    name: str
    """The name in the list of poses, 1 to 200 characters."""
    pose: Pose
    """Handles inside the map's domain, and targets."""
    energy: Energy
    """The minimised energy."""
    options: Options
    """The options of the solve."""
    map: HarmonicMap
    """The resulting map; certified."""
    method: Method = field(default_factory=Newton)
    """The method of the solve. The map of a method on a mesh is not kept."""
    solution: Solution | None = AS_SEEN
    """How the solve that gave ``map`` ended; None if the pose has changed since."""

    def __post_init__(self) -> None:
        check_fields(self, DocumentError, lambda field: f"{field} of the pose {self.name!r:.60}")
        if not 1 <= (count := len(self.name)) <= LONGEST_NAME:
            wanted = f"the name of a pose must have 1 to {LONGEST_NAME} characters"
            raise DocumentError(f"{wanted}, not {count}")
        with about(f"the pose {self.name!r}", DocumentError):
            self.pose.check_inside(self.map.domain)

    @property
    def solved(self) -> bool:
        """Whether a solve ended with ``map``; never for a method on a mesh."""
        return self.solution is not None and self.solution.ended

    @functools.cached_property
    def unsolved(self) -> bool:
        """Whether the pose or the cage has changed since ``map`` was computed."""
        return self.solution is None and not (is_identity(self.map) and at_rest(self.pose))

    def changed(self, **changes: Any) -> Self:
        """A copy with another pose, energy, options, map or method. It is not solved."""
        return replace(self, solution=None, **changes)

    def asks_the_same(self, other: Self) -> bool:
        """Whether pose, energy, options and method are the same objects."""
        return all(getattr(self, key) is getattr(other, key) for key in _ASKED)


@dataclass(frozen=True, eq=False)
class DocumentPart:
    """One of several shapes of a document. Its fields are as in `Document`.

    Raises a DocumentError that names the wrong field if the fields do not fit together.
    """

    name: str
    """1 to 200 characters."""
    image: NDArray[np.uint8]
    domain: Domain
    trace_options: TraceOptions
    scribbles: Scribbles | None
    poses: tuple[NamedPose, ...]
    """One for each keyframe of the document."""
    visible: bool = True
    """Whether it is shown on the canvas and in exports."""

    @property
    def cage(self) -> Cage:
        """The cage of the domain."""
        return self.domain.cage

    def __post_init__(self) -> None:
        if not isinstance(self.name, str) or not 1 <= len(self.name) <= LONGEST_NAME:
            wanted = f"the name of a part must have 1 to {LONGEST_NAME} characters"
            raise DocumentError(f"{wanted}, not {self.name!r:.60}")
        if not isinstance(self.visible, bool):
            raise DocumentError(f"visible must be true or false, not {self.visible!r:.60}")
        vars(self).update(image=_checked_image(self.image), poses=tuple(self.poses))
        _check_kind("domain", self.domain, Domain)
        _check_kind("trace_options", self.trace_options, TraceOptions)
        _check_shape(self.domain, self.poses, self.trace_options, self.scribbles)


@dataclass(frozen=True, eq=False)
class Document:
    """A picture, its cage and its poses.

    Raises a DocumentError that names the wrong part if the parts do not fit together.
    """

    image: NDArray[np.uint8]
    """(h, w, 4) RGBA, straight alpha. Kept read-only; copied if it was writeable."""
    cage: Cage
    """The cage as traced and edited by hand."""
    domain: Domain
    """The domain of all maps; ``domain.cage`` is ``cage``."""
    trace_options: TraceOptions
    """How the cage was traced. Its ``scribbles`` are None or this document's."""
    scribbles: Scribbles | None
    """The painted strokes, also if the tracing does not use them."""
    poses: tuple[NamedPose, ...]
    """The poses, at most a thousand."""
    active: int
    """Index of the shown pose; 0 if there are no poses."""
    timeline: Timeline | None = None
    """The times of the poses in an animation; by default one second apart."""
    look: Look = WHOLE_CAGE
    """What is drawn of the picture, and what lies behind it."""
    parts: tuple[DocumentPart, ...] = ()
    """All shapes of a session with several, the rearmost first. Empty for one shape."""
    part: int = 0
    """Index of the edited part. Its image, domain and poses are those of the document."""
    pins: PinMarks = field(default_factory=PinMarks)
    """Which pins are locked, hidden or grouped in the editor."""

    def __post_init__(self) -> None:
        image = _checked_image(self.image)
        vars(self).update(image=image, poses=tuple(self.poses), parts=tuple(self.parts))
        kinds = {"cage": Cage, "domain": Domain, "trace_options": TraceOptions, "look": Look}
        kinds |= {"pins": PinMarks}
        kinds |= {} if self.scribbles is None else {"scribbles": Scribbles}
        for key, kind in kinds.items():
            _check_kind(key, getattr(self, key), kind)
        if not self.cage.equals(self.domain.cage):
            raise DocumentError("cage: it is not the cage of the domain")
        _check_shape(self.domain, self.poses, self.trace_options, self.scribbles)
        last = max(len(self.poses) - 1, 0)
        if type(self.active) is not int or not 0 <= self.active <= last:
            raise DocumentError(f"active must be 0 to {last}, not {self.active!r}")
        if self.timeline is not None and len(self.timeline) != (count := len(self.poses)):
            raise DocumentError(f"timeline has {len(self.timeline)} keyframes for {count} poses")
        if self.parts:
            self._check_parts()

    def _check_parts(self) -> None:
        count = len(self.parts)
        if not 2 <= count <= MOST_PARTS:
            raise DocumentError(f"parts: there are {count}; 2 to {MOST_PARTS} are allowed")
        if type(self.part) is not int or not 0 <= self.part < count:
            raise DocumentError(f"part must be 0 to {count - 1}, not {self.part!r}")
        names: set[str] = set()
        for i, part in enumerate(self.parts):
            _check_kind(f"parts[{i}]", part, DocumentPart)
            if part.name in names:
                raise DocumentError(f"parts[{i}]: another part has the name {part.name!r:.80}")
            names.add(part.name)
            if part.image.shape != self.image.shape:
                raise DocumentError(f"parts[{i}] ({part.name!r}): its picture has another size")
            if len(part.poses) != len(self.poses):
                has = f"it has {len(part.poses)} poses for {len(self.poses)} keyframes"
                raise DocumentError(f"parts[{i}] ({part.name!r}): {has}")
        edited = self.parts[self.part]
        if edited.domain is not self.domain or edited.poses != self.poses:
            raise DocumentError("part: the edited part is not the document's shape")

    def of_part(self, index: int) -> Self:
        """A document with one of the parts as its only shape; itself without parts."""
        if not self.parts:
            return self
        part = self.parts[index]
        shape = {"image": part.image, "cage": part.cage, "domain": part.domain}
        traced = {"trace_options": part.trace_options, "scribbles": part.scribbles}
        return replace(self, **shape, **traced, poses=part.poses, parts=(), part=0)

    @property
    def unsolved(self) -> tuple[NamedPose, ...]:
        """The poses that are not yet solved on this cage (`NamedPose.unsolved`)."""
        poses = [pose for part in self.parts for pose in part.poses] or self.poses
        return tuple(pose for pose in poses if pose.unsolved)

    @property
    def active_pose(self) -> NamedPose | None:
        """The shown pose; None if there are no poses."""
        return self.poses[self.active] if self.poses else None


def check_room(poses: Sized) -> None:
    """Raise a DocumentError for more poses than a document may hold."""
    if len(poses) > _MOST_POSES:
        raise DocumentError(f"poses: there are {len(poses)}; {_MOST_POSES} are allowed")


def at_rest(pose: Pose) -> bool:
    """Whether the identity meets all pins. Then the identity is a minimum."""
    in_place = np.array_equal(pose.targets, pose.handles)
    unturned = not (np.nan_to_num(pose.angles, nan=0.0)).any()
    return in_place and unturned and bool((np.nan_to_num(pose.scales, nan=1.0) == 1).all())


def is_identity(map: HarmonicMap) -> bool:
    """Whether the map has exactly the coefficients of ``HarmonicMap.identity``."""
    return not map.psi.any() and np.array_equal(map.phi, HarmonicMap.identity(map.domain).phi)


def _checked_image(image: Any) -> NDArray[np.uint8]:
    image = np.asarray(image)
    if image.dtype != np.uint8 or image.ndim != 3 or image.shape[2] != 4 or not image.size:
        wanted = "image must be a uint8 array of the shape (h, w, 4)"
        raise DocumentError(f"{wanted}, not {image.dtype} {image.shape}")
    return read_only(image.copy()) if image.flags.writeable else image


def _check_shape(
    domain: Domain,
    poses: tuple[NamedPose, ...],
    options: TraceOptions,
    scribbles: Scribbles | None,
) -> None:
    if options.scribbles not in (None, scribbles):
        raise DocumentError("trace_options: its scribbles are not those of the document")
    check_room(poses)
    for i, pose in enumerate(poses):
        _check_kind(f"poses[{i}]", pose, NamedPose)
        if pose.map.domain is not domain:
            raise DocumentError(f"poses[{i}] ({pose.name!r}): its map is of another domain")


def _check_kind(name: str, value: object, kind: type) -> None:
    if not isinstance(value, kind):
        raise DocumentError(f"{name} must be of the class {kind.__name__}, not {value!r:.60}")
