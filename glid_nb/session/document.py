"""A document: everything that an editor holds, as one value and as one file."""

from __future__ import annotations

import json
import weakref
from collections.abc import Collection
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from glid_nb.certificate import Certificate, certify
from glid_nb.energies import Energy
from glid_nb.geometry import Cage, Domain
from glid_nb.harmonic import HarmonicMap, MapError
from glid_nb.harmonic.map import complex_from_pairs, complex_to_pairs
from glid_nb.imaging import Scribbles, TraceOptions
from glid_nb.imaging.read import MAX_SIDE
from glid_nb.methods import MethodChoice
from glid_nb.session import document_parts as parts
from glid_nb.session.archive import read_archive, write_archive
from glid_nb.session.json_file import InputFileError, check_points, require_keys
from glid_nb.solvers import Options, Pose, PoseError

T = TypeVar("T")

MOST_POSES = 1000
"""Most poses that a document may hold."""

FORMAT = "glid_nb-document"
FORMAT_VERSION = 2
_READABLE = (1, 2)

_LONGEST_NAME = 200
_JSON, _IMAGE = "document.json", "image.png"
_KEYS = (
    "format",
    "version",
    "image_size_px",
    "domain",
    "trace_options",
    "scribbles",
    "poses",
    "active",
)
_POSE_KEYS = ("name", "handles", "targets", "energy", "options", "method", "phi", "psi")
_KEYS_SINCE_2 = ("method",)
# Unpacked. A picture of MAX_SIDE squared has 256 MB of pixels; PNG adds a little to noise.
_MOST_BYTES = {
    _JSON: 64 << 20,
    _IMAGE: 5 * MAX_SIDE**2,
    **{parts.scribble_member(key): MAX_SIDE**2 for key in parts.STROKES},
}

# Maps are immutable, so each is proved once however often it is saved.
_certificates: weakref.WeakKeyDictionary[HarmonicMap, Certificate] = weakref.WeakKeyDictionary()


class DocumentError(InputFileError):
    """A document's parts do not fit together, or a file holds no valid document.

    The message names the culprit.
    """


@dataclass(frozen=True, eq=False)
class NamedPose:
    """A pose with a name and the certified map that was found for it.

    Parameters
    ----------
    name : str
        What the list of poses shows, 1 to 200 characters.
    pose : Pose
        Handles inside the map's domain, and targets.
    energy : Energy
        What was minimised.
    options : Options
        How.
    map : HarmonicMap
        The result; certified.
    method : MethodChoice
        By what. A method on a mesh leaves its result out of the document.

    Raises
    ------
    DocumentError
        For a bad name, or a handle outside the domain.
    """

    name: str
    pose: Pose
    energy: Energy
    options: Options
    map: HarmonicMap
    method: MethodChoice = field(default_factory=MethodChoice)

    def __post_init__(self) -> None:
        _checked("the name of a pose", self.name, str)
        if not 1 <= len(self.name) <= _LONGEST_NAME:
            raise DocumentError(
                f"the name of a pose must have 1 to {_LONGEST_NAME} characters, "
                f"not {len(self.name)}"
            )
        for key, kind in (
            ("pose", Pose),
            ("energy", Energy),
            ("options", Options),
            ("map", HarmonicMap),
            ("method", MethodChoice),
        ):
            _checked(f"{key} of the pose {self.name!r}", getattr(self, key), kind)
        try:
            self.pose.check_inside(self.map.domain)
        except PoseError as error:
            raise DocumentError(f"the pose {self.name!r}: {error}") from error


@dataclass(frozen=True, eq=False)
class Document:
    """A picture, its cage, and the poses that it was given.

    Parameters
    ----------
    image : (h, w, 4) uint8 array
        RGBA, straight alpha. Kept read-only; copied if it was writeable.
    cage : Cage
        As traced, with the edits by hand.
    domain : Domain
        The domain that all the maps share; ``domain.cage`` is ``cage``.
    trace_options : TraceOptions
        How the cage was traced. Its ``scribbles`` are None or this document's.
    scribbles : Scribbles or None
        What was painted, whether the tracing uses it or not.
    poses : tuple of NamedPose
        At most a thousand.
    active : int
        Which pose is shown; 0 when there are none.

    Raises
    ------
    DocumentError
        When the parts do not fit together; the message names the culprit.
    """

    image: NDArray[np.uint8]
    cage: Cage
    domain: Domain
    trace_options: TraceOptions
    scribbles: Scribbles | None
    poses: tuple[NamedPose, ...]
    active: int

    def __post_init__(self) -> None:
        object.__setattr__(self, "image", _checked_image(self.image))
        object.__setattr__(self, "poses", tuple(self.poses))
        _checked("cage", self.cage, Cage)
        _checked("domain", self.domain, Domain)
        _checked("trace_options", self.trace_options, TraceOptions)
        if self.scribbles is not None:
            _checked("scribbles", self.scribbles, Scribbles)
        if not self.cage.equals(self.domain.cage):
            raise DocumentError("cage: it is not the cage of the domain")
        if self.trace_options.scribbles not in (None, self.scribbles):
            raise DocumentError(
                "trace_options: its scribbles are not those of the document; pass the same object"
            )
        if len(self.poses) > MOST_POSES:
            raise DocumentError(f"poses: there are {len(self.poses)}; {MOST_POSES} are allowed")
        for i, pose in enumerate(self.poses):
            _checked(f"poses[{i}]", pose, NamedPose)
            if pose.map.domain is not self.domain:
                raise DocumentError(
                    f"poses[{i}] ({pose.name!r}): its map lives on another domain than the document"
                )
        last = max(len(self.poses) - 1, 0)
        if isinstance(self.active, bool) or not isinstance(self.active, int):
            raise DocumentError(f"active must be a whole number, not {self.active!r}")
        if not 0 <= self.active <= last:
            raise DocumentError(f"active must be 0 to {last}, not {self.active}")

    @property
    def active_pose(self) -> NamedPose | None:
        """The pose that is shown; None when there are none."""
        return self.poses[self.active] if self.poses else None


def save_document(document: Document, path: str | Path) -> None:
    """Write a document to one file, atomically: a zip of JSON and PNG.

    ``document.json`` holds everything but pixels, which are in ``image.png``; scribbled masks are
    in ``scribbles-*.png``. Numbers are written so that they read back bit for bit.

    Raises
    ------
    DocumentError
        When a map is not certified, or an energy is a Python function. Nothing is written then.
    OSError
        When the file cannot be written; what was there before stays.
    """
    members: dict[str, bytes] = {}
    scribbles = None
    if document.scribbles is not None:
        scribbles, members = parts.scribbles_to_dict(document.scribbles)
    height, width = document.image.shape[:2]
    data = {
        "format": FORMAT,
        "version": FORMAT_VERSION,
        "image_size_px": [width, height],
        "domain": document.domain.to_dict(),
        "trace_options": parts.trace_options_to_dict(document.trace_options),
        "scribbles": scribbles,
        "poses": [_pose_to_dict(i, pose) for i, pose in enumerate(document.poses)],
        "active": document.active,
    }
    text = json.dumps(data, allow_nan=False, default=np.generic.item).encode("utf-8")
    members = {_JSON: text, _IMAGE: parts.image_png(document.image), **members}
    write_archive(Path(path), members, stored=frozenset(members) - {_JSON})


def load_document(path: str | Path) -> Document:
    """Read a document that :func:`save_document` wrote; every map in it is proved anew.

    Raises
    ------
    DocumentError
        When the file is no valid document; the message names the file and the culprit.
    OSError
        When it cannot be read.
    """
    path = Path(path)
    try:
        return _from_members(read_archive(path, _MOST_BYTES))
    except InputFileError as error:
        raise DocumentError(f"{path}: {error}") from error


def _from_members(members: dict[str, bytes]) -> Document:
    for name in (_JSON, _IMAGE):
        if name not in members:
            raise DocumentError(f"{name} is missing; this is no glid_nb document")
    data = parts.parse_json(members[_JSON], _JSON)
    if data.get("format") != FORMAT:
        raise DocumentError(f'{_JSON}: the key "format" is not "{FORMAT}"')
    version = data.get("version")
    if version not in _READABLE or isinstance(version, bool | float):
        raise DocumentError(
            f"version {version!r:.20} of the format is not supported, only "
            f"{' and '.join(map(str, _READABLE))}; a newer glid_nb may have written it: update "
            "this one"
        )
    parts.check_known(data, _KEYS, _JSON)
    require_keys(data, tuple(key for key in _KEYS if key != "scribbles"))
    size = _size(data["image_size_px"])
    image = np.asarray(parts.read_png(members[_IMAGE], size, "RGBA", _IMAGE), dtype=np.uint8)
    scribbles = None
    if data.get("scribbles") is not None:
        scribbles = parts.scribbles_from_dict(
            parts.object_of(data["scribbles"], "scribbles"), members, size
        )
    domain = parts.domain_from_dict(parts.object_of(data["domain"], "domain"))
    options = parts.trace_options_from_dict(
        parts.object_of(data["trace_options"], "trace_options"), scribbles
    )
    given = parts.list_of(data["poses"], "poses")
    if len(given) > MOST_POSES:
        raise DocumentError(f"poses: there are {len(given)}; {MOST_POSES} are allowed")
    # Before version 2 there was one method.
    keys = [key for key in _POSE_KEYS if version > 1 or key not in _KEYS_SINCE_2]
    poses = tuple(_pose_from_dict(i, pose, domain, keys) for i, pose in enumerate(given))
    return Document(image, domain.cage, domain, options, scribbles, poses, data["active"])


def _size(value: Any) -> tuple[int, int]:
    if not (isinstance(value, list) and len(value) == 2 and all(type(n) is int for n in value)):
        raise DocumentError(f"image_size_px must be [width, height], not {value!r:.60}")
    width, height = value
    if not (1 <= width <= MAX_SIDE and 1 <= height <= MAX_SIDE):
        raise DocumentError(
            f"image_size_px is {width} x {height}; a side has 1 to {MAX_SIDE} pixels"
        )
    return width, height


def _pose_to_dict(index: int, pose: NamedPose) -> dict[str, Any]:
    where = f"poses[{index}] ({pose.name!r})"
    _check_proved(pose.map, where)
    try:
        energy = parts.energy_to_dict(pose.energy)
    except InputFileError as error:
        raise DocumentError(f"{where}: {error}") from error
    return {
        "name": pose.name,
        **pose.pose.to_dict(),
        "energy": energy,
        "options": asdict(pose.options),
        "method": parts.method_to_dict(pose.method),
        "phi": complex_to_pairs(pose.map.phi),
        "psi": complex_to_pairs(pose.map.psi),
    }


def _pose_from_dict(index: int, value: Any, domain: Domain, keys: Collection[str]) -> NamedPose:
    where = f"poses[{index}]"
    data = parts.object_of(value, where)
    try:
        parts.check_known(data, keys, "the pose")
        require_keys(data, keys)
        where = f"{where} ({data['name']!r:.60})"
        for key in ("handles", "targets"):
            check_points(data[key], key)
        map = HarmonicMap(
            domain,
            complex_from_pairs(data["phi"], "phi"),
            complex_from_pairs(data["psi"], "psi"),
        )
        method = MethodChoice()
        if "method" in keys:
            method = parts.method_from_dict(parts.object_of(data["method"], "method"))
        pose = NamedPose(
            data["name"],
            Pose.from_dict(data),
            parts.energy_from_dict(parts.object_of(data["energy"], "energy")),
            parts.options_from_dict(parts.object_of(data["options"], "options")),
            map,
            method,
        )
    except (InputFileError, MapError, PoseError) as error:
        raise DocumentError(f"{where}: {error}") from error
    _check_proved(map, where)
    return pose


def _check_proved(map: HarmonicMap, where: str) -> None:
    certificate = _certificates.get(map)
    if certificate is None:
        certificate = _certificates[map] = certify(map)
    if not certificate.certified:
        raise DocumentError(f"{where}: its map is not certified. {certificate.reason}")


def _checked(name: str, value: object, kind: type[T]) -> T:
    """``value``, or an error that calls it ``name`` if it is not of the class ``kind``."""
    if not isinstance(value, kind):
        raise DocumentError(f"{name} must be of the class {kind.__name__}, not {value!r:.60}")
    return value


def _checked_image(image: NDArray[np.uint8]) -> NDArray[np.uint8]:
    array = np.asarray(image)
    if array.dtype != np.uint8 or array.ndim != 3 or array.shape[2] != 4 or not array.size:
        raise DocumentError(
            f"image must be a uint8 array of the shape (h, w, 4), not {array.dtype} {array.shape}"
        )
    if array.flags.writeable:
        array = array.copy()
        array.setflags(write=False)
    return array
