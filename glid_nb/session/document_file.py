"""Save and load documents: a zip of JSON and PNG that is read back bit for bit."""

import dataclasses
import io
import json
import math
import re
import weakref
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from glid_nb import _json, energies, methods
from glid_nb._errors import InputFileError, about
from glid_nb._files import read_file, write_atomically, zipped
from glid_nb.certificate import certificate_of
from glid_nb.energies import CustomEnergy
from glid_nb.geometry import Domain, as_points
from glid_nb.harmonic import HarmonicMap
from glid_nb.harmonic.map import DOMAIN_KEYS, complex_from_pairs
from glid_nb.imaging import Scribbles, TraceOptions
from glid_nb.imaging.read import MAX_SIDE, picture_format, png
from glid_nb.pose import Pose
from glid_nb.session.document import (
    AS_SEEN,
    MOST_PARTS,
    Document,
    DocumentError,
    DocumentPart,
    NamedPose,
    at_rest,
    check_room,
    is_identity,
)
from glid_nb.session.look import WHOLE_CAGE, Look
from glid_nb.session.names import free_name
from glid_nb.session.pin_marks import PinMarks
from glid_nb.session.timeline import Timeline
from glid_nb.solvers import Newton, Options

T = TypeVar("T")

FORMAT = "glid_nb-document"
FORMAT_VERSION = 7

_JSON, _IMAGE = "document.json", "image.png"
_MASKS = {key: f"scribbles-{key}.png" for key in ("foreground", "background")}
# Most bytes of each member, unpacked. A picture of MAX_SIDE squared has 256 MB of pixels. As a PNG,
# noise is a little larger.
_MOST_BYTES = {_JSON: 64 << 20, _IMAGE: 5 * MAX_SIDE**2}
_MOST_BYTES |= dict.fromkeys(_MASKS.values(), MAX_SIDE**2)
_MOST_TOGETHER = sum(_MOST_BYTES.values())  # all members, also those of several parts
_DIRECTORY_BYTES = 64 * 1024  # room for the zip directory of a few members
_KEYS = {
    **_json.keys("format", "version", "image_size_px", "domain", "active"),
    "trace_options": _json.check_object,
    "poses": _json.check_list,
}
_POSE_KEYS = {
    **_json.keys("name", "energy", "options", "phi", "psi"),
    "handles": _json.check_points,
    "targets": _json.check_points,
}
# The keys of a pose that each version added.
_ADDED = {
    3: ("depths",),
    4: ("angles", "scales", "weights", "names", "stiffness"),
    5: ("unsolved",),
}
_MOST_ITERATIONS = 200  # older files have this for max_iterations=None, the method's own limit
_RELATIVE_WEIGHT = (
    5  # since this version p2p_weight is relative to the cage's unit, not the world's
)
_PARTS = 7  # since this version a session may have several parts
_OF_PARTS = re.compile(r"(image|scribbles-foreground|scribbles-background)-\d{1,3}\.png")
_LOOK = 6  # since this version a picture may be drawn otherwise than as all inside its cage
_PINS = 7  # since this version pins may be locked, hidden or grouped
_MASK = "mask"  # written instead of strokes; another member holds the pixels
_NEVER = "never"  # stands for TraceOptions.max_edge == inf, which JSON cannot express

# The PNGs of pictures that still exist, by their ids: an editor saves the same pictures again and
# again.
_encoded: dict[int, tuple[weakref.ref[NDArray[np.uint8]], bytes]] = {}


def save_document(document: Document, path: str | Path) -> None:
    """Write `document_bytes` to a file, atomically. If that fails, the old file stays."""
    write_atomically(path, document_bytes(document))


def document_bytes(document: Document) -> bytes:
    """A document as one file: a zip of JSON and PNG that is read back bit for bit.

    Raises a DocumentError if a map is not certified or an energy is a Python function.
    """
    timeline = {} if document.timeline is None else {"timeline": vars(document.timeline)}
    look = {} if document.look == WHOLE_CAGE else {"look": vars(document.look)}
    shape, masks = _shape_to_dict(document)
    parts, members = _parts_to_members(document)
    shapes = document.parts or (document,)
    handles = (pose.pose.handles for each in shapes for pose in each.poses)
    marks = document.pins.only(handles)
    pins = {"pins": marks.to_list()} if marks else {}
    height, width = document.image.shape[:2]
    data = {
        "format": FORMAT,
        "version": FORMAT_VERSION,
        "image_size_px": [width, height],
        **shape,
        "active": document.active,
        **timeline,
        **look,
        **parts,
        **pins,
    }
    text = json.dumps(data, allow_nan=False, default=np.generic.item).encode("utf-8")
    pixels = {_IMAGE: _image_png(document.image), **masks, **members}
    return zipped({_JSON: text, **pixels}, stored=pixels)


def _shape_to_dict(
    shape: Document | DocumentPart, number: int | None = None
) -> tuple[dict[str, Any], dict[str, bytes]]:
    """Domain, options, scribbles and poses of a shape, and the members with its masks. The members
    of a part that is not edited have its number in their names."""
    scribbles, masks = _scribbles_to_members(shape.scribbles)
    given = shape.trace_options
    options = {**vars(given), "scribbles": given.scribbles is not None}
    options |= {"max_edge": _NEVER} if given.max_edge == math.inf else {}
    data = {
        "domain": shape.domain.to_dict(),
        "trace_options": options,
        "scribbles": scribbles,
        "poses": [_pose_to_dict(i, pose) for i, pose in enumerate(shape.poses)],
    }
    return data, {_numbered(name, number): mask for name, mask in masks.items()}


def _parts_to_members(document: Document) -> tuple[dict[str, Any], dict[str, bytes]]:
    """All parts, of which the document's other keys hold the edited one, and their members."""
    if not document.parts:
        return {}, {}
    parts: list[dict[str, Any]] = []
    members: dict[str, bytes] = {}
    names = [(document.image, _IMAGE)]  # of the pictures so far; parts may share one
    for number, part in enumerate(document.parts):
        entry: dict[str, Any] = {"name": part.name, "visible": part.visible}
        if number != document.part:
            with about(f"parts[{number}] ({part.name!r})", DocumentError):
                shape, masks = _shape_to_dict(part, number)
            member = next((name for image, name in names if image is part.image), None)
            if member is None:
                member = _numbered(_IMAGE, number)
                names.append((part.image, member))
                members[member] = _image_png(part.image)
            entry |= {"image": member, **shape}
            members |= masks
        parts.append(entry)
    return {"parts": parts, "part": document.part}, members


def _numbered(name: str, number: int | None) -> str:
    return name if number is None else name.replace(".png", f"-{number}.png")


def load_document(path: str | Path) -> Document:
    """Read a document that :func:`save_document` wrote. Every map in it is certified again.

    Raises a DocumentError that names the file and the wrong part if it is no valid document.
    """
    with about(path, DocumentError):
        members = _read_archive(path)
        for name in (_JSON, _IMAGE):
            if name not in members:
                raise DocumentError(f"{name} is missing; this is not a glid_nb document")
        data = _json.parse_json(members[_JSON], _JSON, "JSON", nan=False)
        version = _json.checked_version(data, "document", FORMAT_VERSION)
        optional = {"scribbles": _json.check_object}
        if version > 3:
            optional["timeline"] = _json.check_object
        if version >= _LOOK:
            optional["look"] = _json.check_object
        if version >= _PARTS:
            optional |= {"parts": _json.check_list, **_json.keys("part")}
        if version >= _PINS:
            optional["pins"] = _json.check_list
        _json.check_fields(data, _JSON, _KEYS, optional)
        size = _json.picture_size(data["image_size_px"], "image_size_px")
        if max(size) > MAX_SIDE:
            raise DocumentError(f"image_size_px is {size[0]} x {size[1]}; {MAX_SIDE} is the most")
        image = _read_png(members[_IMAGE], size, "RGBA", _IMAGE)
        domain, options, scribbles, poses = _shape_from_dict(data, members, size, version)
        given = data.get("timeline")
        timeline = None if given is None else _from_fields(Timeline, given, "timeline")
        look = _from_fields(Look, data["look"], "look") if "look" in data else WHOLE_CAGE
        marks = PinMarks.from_list(data.get("pins") or [], "pins")
        posed = poses, data["active"], timeline, look
        document = Document(image, domain.cage, domain, options, scribbles, *posed, pins=marks)
        if "parts" not in data:
            return document
        return _with_parts(document, data, members, version)


def _shape_from_dict(
    data: Any,
    members: Mapping[str, bytes],
    size: tuple[int, int],
    version: int,
    number: int | None = None,
) -> tuple[Domain, TraceOptions, Scribbles | None, tuple[NamedPose, ...]]:
    scribbles = _scribbles_from_members(data.get("scribbles"), members, size, number)
    domain = _domain_from_dict(data["domain"])
    options = _trace_options_from_dict(data["trace_options"], scribbles)
    check_room(data["poses"])
    poses = (_pose_from_dict(i, pose, domain, version) for i, pose in enumerate(data["poses"]))
    return domain, options, scribbles, tuple(poses)


def _with_parts(
    document: Document, data: Any, members: Mapping[str, bytes], version: int
) -> Document:
    """The document with the parts of its file."""
    if len(data["parts"]) > MOST_PARTS:
        raise DocumentError(f"parts: there are {len(data['parts'])}; {MOST_PARTS} are allowed")
    part = data.get("part")
    if type(part) is not int or not 0 <= part < len(data["parts"]):
        last = len(data["parts"]) - 1
        raise DocumentError(f"part must be 0 to {last}, not {part!r:.60}")
    shown = {"name": _json.check_text}
    posed = {key: _KEYS[key] for key in ("domain", "trace_options", "poses")}
    size = document.image.shape[1], document.image.shape[0]
    images = {_IMAGE: document.image}
    parts: list[DocumentPart] = []
    for i, entry in enumerate(data["parts"]):
        with about(where := f"parts[{i}]", DocumentError):
            if i == part:
                _json.check_fields(entry, where, shown, _json.keys("visible"))
                names = "image", "domain", "trace_options", "scribbles", "poses"
                shape = {name: getattr(document, name) for name in names}
            else:
                needed = {**shown, "image": _json.check_text, **posed}
                optional = {"scribbles": _json.check_object, **_json.keys("visible")}
                _json.check_fields(entry, where, needed, optional)
                if (member := entry["image"]) not in images:
                    if member not in members:
                        raise InputFileError(f"{member!r:.80} is missing")
                    images[member] = _read_png(members[member], size, "RGBA", member)
                domain, options, scribbles, poses = _shape_from_dict(
                    entry, members, size, version, i
                )
                shape = {"image": images[member], "domain": domain, "trace_options": options}
                shape |= {"scribbles": scribbles, "poses": poses}
            name, taken = entry["name"], [one.name for one in parts]
            if name in taken:  # no editor writes that, but such a session opens
                name = free_name(name, taken)
            parts.append(DocumentPart(name, **shape, visible=entry.get("visible", True)))
    return dataclasses.replace(document, parts=tuple(parts), part=part)


def _read_archive(path: str | Path) -> dict[str, bytes]:
    data = read_file(path, most=_MOST_TOGETHER + _DIRECTORY_BYTES)
    members: dict[str, bytes] = {}
    together = 0
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            for info in archive.infolist():
                _check_member(info)
                if info.filename in members:
                    raise InputFileError(f"it holds {info.filename} twice")
                together += info.file_size
                if together > _MOST_TOGETHER:
                    what = f"its members unpack to more than {_MOST_TOGETHER:,} bytes"
                    raise InputFileError(f"{what}, which are allowed together")
                members[info.filename] = archive.read(info)
    except InputFileError:
        raise
    except Exception as error:  # zipfile raises many kinds of errors for damaged headers
        if (kind := picture_format(data)) is not None:
            what = f"it is a {kind} picture; open it as the picture instead of as a session"
        elif zipfile.is_zipfile(io.BytesIO(data)):
            what = f"it is not an intact zip file: {error}"
        else:
            what = "it is not a saved session, which is a zip file, or only a part of one"
        raise InputFileError(what) from None
    return members


def _check_member(info: zipfile.ZipInfo) -> None:
    name, size = info.filename, info.file_size
    kind = re.sub(r"-\d+\.png$", ".png", name) if _OF_PARTS.fullmatch(name) else name
    if kind not in _MOST_BYTES:
        wanted = f"expected only {', '.join(_MOST_BYTES)}"
        raise InputFileError(f"it holds {name!r:.80}, which does not belong there; {wanted}")
    if info.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        raise InputFileError(f"{name} is compressed by a method that sessions do not use")
    # zipfile stops at this size, whatever the compressed data contain.
    if size > _MOST_BYTES[kind]:
        raise InputFileError(f"{name} unpacks to {size:,} bytes; {_MOST_BYTES[kind]:,} are allowed")


def _image_png(image: NDArray[np.uint8]) -> bytes:
    """A read-only (h, w, 4) uint8 picture as PNG, exactly, including hidden colours."""
    key = id(image)
    known = _encoded.get(key)  # read once: another thread may save another picture meanwhile
    if known is None or known[0]() is not image:
        reference = weakref.ref(image, lambda _: _encoded.pop(key, None))
        known = _encoded[key] = reference, png(image, compress_level=1)
    return known[1]


def _read_png(data: bytes, size: tuple[int, int], mode: str, name: str) -> NDArray[Any]:
    """The pixels of a PNG. Another (width, height) or mode raises an InputFileError before
    decoding.
    """
    if not data.startswith(b"\x89PNG\r\n\x1a\n"):
        raise InputFileError(f"{name} is not a PNG picture")
    try:
        with Image.open(io.BytesIO(data), formats=["PNG"]) as picture:
            if picture.size != size or picture.mode != mode:
                has = f"{name} has {picture.width} x {picture.height} pixels, mode {picture.mode}"
                raise InputFileError(
                    f"{has}; the document announces {size[0]} x {size[1]}, mode {mode}"
                )
            # Pillow's arrays of mode "1" hold the byte 255 for true.
            pixels = np.array(picture.convert("L")) > 0 if mode == "1" else np.array(picture)
    except InputFileError:
        raise
    except Exception as error:  # Pillow raises many kinds of errors for damaged files
        raise InputFileError(f"{name} is damaged: {error}") from None
    pixels.setflags(write=False)
    return pixels


def _pose_to_dict(index: int, pose: NamedPose) -> dict[str, Any]:
    with about(f"poses[{index}] ({pose.name!r})", DocumentError):
        _check_certified(pose.map)
        energy = pose.energy
        if isinstance(energy, CustomEnergy):
            why = "its energy is a Python function, which cannot be saved"
            raise DocumentError(f"{why}; choose a named energy")
    return {
        "name": pose.name,
        **pose.pose.to_dict(),
        "energy": {"name": energy.name, **{k: getattr(energy, k) for k in energy.parameters()}},
        "options": dataclasses.asdict(pose.options),
        "method": {"name": pose.method.name, "settings": pose.method.settings},
        "phi": as_points(pose.map.phi).tolist(),
        "psi": as_points(pose.map.psi).tolist(),
        # If the map is the identity, the loader recognises an unsolved pose itself.
        **({"unsolved": True} if pose.unsolved and not is_identity(pose.map) else {}),
    }


def _pose_from_dict(index: int, data: Any, domain: Domain, version: int) -> NamedPose:
    keys = _POSE_KEYS if version == 1 else {**_POSE_KEYS, **_json.keys("method")}
    optional = [key for since, added in _ADDED.items() if since <= version for key in added]
    with about(where := f"poses[{index}]", DocumentError):
        _json.check_fields(data, where, keys, _json.keys(*optional))
    with about(f"{where} ({data['name']!r:.60})", DocumentError):
        phi, psi = (complex_from_pairs(data[key], key) for key in ("phi", "psi"))
        energy, named = data["energy"], {"name": _json.check_text}
        with about("energy"):
            _json.check_fields(energy, "energy", named, _json.keys("s"))
            energy = energies.by_name(energy["name"], energy.get("s"))
        method = data.get("method", {"name": Newton.name, "settings": {}})
        with about("method"):
            _json.check_fields(method, "method", {**named, "settings": _json.check_object})
            method = methods.by_name(method["name"], **method["settings"])
        options = _from_fields(Options, data["options"], "options")
        if version < _RELATIVE_WEIGHT:
            weight = options.p2p_weight * domain.cage.unit**2
            options = dataclasses.replace(options, p2p_weight=weight)
        if options.max_iterations == _MOST_ITERATIONS:
            options = dataclasses.replace(options, max_iterations=None)
        map, posed = HarmonicMap(domain, phi, psi), Pose.from_dict(data)
        solution = None if _unsolved(data, posed, map) else AS_SEEN
        pose = NamedPose(data["name"], posed, energy, options, map, method, solution)
        _check_certified(map)
    return pose


def _unsolved(data: Any, pose: Pose, map: HarmonicMap) -> bool:
    """Whether a pose was saved before it was solved.

    This is also true if the map is the identity although the pins ask for another map. Versions
    before 5 wrote such poses, unmarked, after a change of the cage.
    """
    if not isinstance(said := data.get("unsolved") or False, bool):
        raise InputFileError("unsolved must be true or false")
    return said or (is_identity(map) and not at_rest(pose))


def _check_certified(map: HarmonicMap) -> None:
    certificate = certificate_of(map, alone=True)  # files do not contain the solver's panels
    if not certificate.certified:
        raise DocumentError(f"its map is not certified. {certificate.reason}")


def _domain_from_dict(data: Any) -> Domain:
    with about("domain"):
        _json.check_fields(data, "domain", _json.keys(*DOMAIN_KEYS, "notes"))
        domain = Domain.from_dict(data)
    if domain.to_dict() != data:
        # The coefficients of maps are in the order of the loops' vertices.
        raise InputFileError("domain: its loops must run as saved")
    return domain


def _trace_options_from_dict(data: Any, scribbles: Scribbles | None) -> TraceOptions:
    used = data.get("scribbles", False)
    if not isinstance(used, bool):
        raise InputFileError("trace_options.scribbles must be true or false")
    if used and scribbles is None:
        raise InputFileError("trace_options uses scribbles, but the document has none")
    changed: dict[str, Any] = {"scribbles": scribbles if used else None}
    if data.get("max_edge") == _NEVER:
        changed["max_edge"] = math.inf
    return _from_fields(TraceOptions, {**data, **changed}, "trace_options")


def _from_fields(kind: type[T], data: Any, name: str) -> T:
    fields = [field.name for field in dataclasses.fields(kind)]  # type: ignore[arg-type]
    _json.check_fields(data, name, {}, _json.keys(*fields))
    with about(name):
        return kind(**data)


def _scribbles_to_members(scribbles: Scribbles | None) -> tuple[Any, dict[str, bytes]]:
    if scribbles is None:
        return None, {}
    values = {key: getattr(scribbles, key) for key in _MASKS}
    masks = {key: value for key, value in values.items() if isinstance(value, np.ndarray)}
    strokes = {k: [s.tolist() for s in v] for k, v in values.items() if k not in masks}
    members = {_MASKS[key]: png(mask, compress_level=1) for key, mask in masks.items()}
    return {**strokes, **dict.fromkeys(masks, _MASK)}, members


def _scribbles_from_members(
    data: Any, members: Mapping[str, bytes], size: tuple[int, int], number: int | None = None
) -> Scribbles | None:
    if data is None:
        return None
    _json.check_fields(data, "scribbles", _json.keys(*_MASKS))
    values: dict[str, Any] = {}
    for key, name in _MASKS.items():
        member = _numbered(name, number)
        values[key] = data[key]
        if data[key] != _MASK:
            _json.check_loops(data[key], f"scribbles.{key}", each="stroke")
        elif member in members:
            values[key] = _read_png(members[member], size, "1", member)
        else:
            raise InputFileError(f"scribbles: {member} is missing")
    with about("scribbles"):
        return Scribbles(**values)
