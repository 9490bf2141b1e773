"""The parts of a document as plain JSON values and PNG, and back; every surprise is named."""

from __future__ import annotations

import dataclasses
import io
import json
import math
import weakref
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from glid_nb.energies import CustomEnergy, Energy, EnergyError, energy_by_name
from glid_nb.geometry import Domain, GeometryError
from glid_nb.imaging import Scribbles, TraceError, TraceOptions
from glid_nb.methods import MethodChoice, MethodError
from glid_nb.session.json_file import InputFileError, check_loops, require_keys
from glid_nb.solvers import OptionError, Options

STROKES = ("foreground", "background")
_NEVER = "never"  # TraceOptions.max_edge == inf, which JSON cannot say
_PNG_SIGNATURE = b"\x89PNG\r\n\x1a\n"

# The PNG of the picture encoded last: an editor saves the same one again and again.
_last_png: tuple[weakref.ref[NDArray[np.uint8]], bytes] | None = None


def parse_json(data: bytes, name: str) -> dict[str, Any]:
    """The JSON object in the bytes of a member; NaN and Infinity, which are no JSON, are refused.

    Raises
    ------
    InputFileError
        When it holds something else; the message names the member.
    """

    def refuse(constant: str) -> None:
        raise InputFileError(f"{name} holds {constant}, which is no number")

    try:
        value = json.loads(data.decode("utf-8"), parse_constant=refuse)
    except InputFileError:
        raise
    except (ValueError, RecursionError) as error:
        raise InputFileError(f"{name} is not JSON: {error}") from error
    return object_of(value, name)


def object_of(value: Any, name: str) -> dict[str, Any]:
    """``value`` if it is a JSON object."""
    if not isinstance(value, dict):
        raise InputFileError(f"{name} must be an object {{...}}, not {value!r:.60}")
    return value


def list_of(value: Any, name: str) -> list[Any]:
    """``value`` if it is a JSON list."""
    if not isinstance(value, list):
        raise InputFileError(f"{name} must be a list, not {value!r:.60}")
    return value


def check_known(data: Mapping[str, Any], known: Iterable[str], name: str) -> None:
    """Raise for keys that this version does not know."""
    unknown = sorted(set(data) - set(known))
    if unknown:
        raise InputFileError(f"{name} holds the unknown key {unknown[0]!r:.60}")


def image_png(image: NDArray[np.uint8]) -> bytes:
    """A read-only (h, w, 4) uint8 picture as PNG, pixel for pixel, hidden colours included."""
    global _last_png
    if _last_png is not None and _last_png[0]() is image:
        return _last_png[1]
    data = png_bytes(image)
    _last_png = (weakref.ref(image), data)
    return data


def png_bytes(pixels: NDArray[Any]) -> bytes:
    """PNG, compressed lightly: a picture of 4 megapixels takes a tenth of a second."""
    buffer = io.BytesIO()
    Image.fromarray(pixels).save(buffer, format="PNG", compress_level=1)
    return buffer.getvalue()


def read_png(
    data: bytes, size: tuple[int, int], mode: str, name: str
) -> NDArray[np.uint8] | NDArray[np.bool_]:
    """The pixels of a PNG that must have the given (width, height) and mode; read-only.

    Raises
    ------
    InputFileError
        Before anything is decoded when it is another picture than announced.
    """
    if not data.startswith(_PNG_SIGNATURE):
        raise InputFileError(f"{name} is no PNG picture")
    try:
        with Image.open(io.BytesIO(data), formats=["PNG"]) as picture:
            if picture.size != size or picture.mode != mode:
                raise InputFileError(
                    f"{name} has {picture.width} x {picture.height} pixels of the mode "
                    f"{picture.mode}; announced were {size[0]} x {size[1]} of the mode {mode}"
                )
            # Pillow's own arrays of mode "1" hold the byte 255 for true.
            pixels = np.array(picture.convert("L")) > 0 if mode == "1" else np.array(picture)
    except InputFileError:
        raise
    except Exception as error:  # Pillow's decoder raises nearly anything for a damaged file
        raise InputFileError(f"{name} is damaged: {error}") from error
    pixels.setflags(write=False)
    return pixels


def trace_options_to_dict(options: TraceOptions) -> dict[str, Any]:
    """All fields; of the scribbles only whether they are used."""
    data = {f.name: getattr(options, f.name) for f in dataclasses.fields(options)}
    data["scribbles"] = options.scribbles is not None
    if data["max_edge"] == math.inf:
        data["max_edge"] = _NEVER
    return data


def trace_options_from_dict(data: dict[str, Any], scribbles: Scribbles | None) -> TraceOptions:
    """The options; fields that are missing keep their defaults."""
    check_known(data, (f.name for f in dataclasses.fields(TraceOptions)), "trace_options")
    used = data.get("scribbles", False)
    if not isinstance(used, bool):
        raise InputFileError("trace_options.scribbles must be true or false")
    if used and scribbles is None:
        raise InputFileError("trace_options uses scribbles, but the document has none")
    given = {**data, "scribbles": scribbles if used else None}
    if given.get("max_edge") == _NEVER:
        given["max_edge"] = math.inf
    try:
        return TraceOptions(**given)
    except (TraceError, TypeError, OverflowError) as error:
        raise InputFileError(f"trace_options: {error}") from error


def options_from_dict(data: dict[str, Any]) -> Options:
    """Settings of a solve; fields that are missing keep their defaults."""
    check_known(data, (f.name for f in dataclasses.fields(Options)), "options")
    try:
        return Options(**data)
    except (OptionError, TypeError, OverflowError) as error:
        raise InputFileError(f"options: {error}") from error


def energy_to_dict(energy: Energy) -> dict[str, Any]:
    """The name, and the parameter of an energy that has one."""
    if isinstance(energy, CustomEnergy):
        raise InputFileError(
            "its energy is a Python function, which cannot be saved; choose a named energy"
        )
    s = getattr(energy, "s", None)
    return {"name": energy.name} if s is None else {"name": energy.name, "s": s}


def energy_from_dict(data: dict[str, Any]) -> Energy:
    """The energy that :func:`energy_to_dict` described."""
    check_known(data, ("name", "s"), "energy")
    name = data.get("name")
    if not isinstance(name, str):
        raise InputFileError(f"energy.name must be text, not {name!r:.60}")
    try:
        return energy_by_name(name, data.get("s"))
    except (EnergyError, OverflowError) as error:
        raise InputFileError(f"energy: {error}") from error


def method_to_dict(method: MethodChoice) -> dict[str, Any]:
    """The name, and the settings that are not the method's own defaults."""
    return {"name": method.name, "settings": dict(method.settings)}


def method_from_dict(data: dict[str, Any]) -> MethodChoice:
    """The choice that :func:`method_to_dict` described, whether it can run here or not."""
    check_known(data, ("name", "settings"), "method")
    require_keys(data, ("name", "settings"))
    if not isinstance(data["name"], str):
        raise InputFileError(f"method.name must be text, not {data['name']!r:.60}")
    settings = object_of(data["settings"], "method.settings")
    try:
        return MethodChoice(data["name"], settings)
    except (MethodError, OverflowError) as error:
        raise InputFileError(f"method: {error}") from error


def domain_from_dict(data: dict[str, Any]) -> Domain:
    """The domain exactly as it was: nothing is chosen, reversed or left out on the way."""
    require_keys(data, ("cage", "holes", "offset_cage", "offset_holes", "hole_points", "notes"))
    try:
        domain = Domain.from_dict(data)
    except GeometryError as error:
        raise InputFileError(f"domain: {error}") from error
    if domain.to_dict() != data:
        # The coefficients of the maps are in the order of the loops' vertices.
        raise InputFileError("domain: its loops must run as saved, or it has unknown keys")
    return domain


def scribbles_to_dict(scribbles: Scribbles) -> tuple[dict[str, Any], dict[str, bytes]]:
    """Strokes as lists, masks as PNG members called after them."""
    data: dict[str, Any] = {}
    members: dict[str, bytes] = {}
    for key in STROKES:
        value = getattr(scribbles, key)
        if isinstance(value, np.ndarray):
            data[key] = "mask"
            members[scribble_member(key)] = png_bytes(value)
        else:
            data[key] = [stroke.tolist() for stroke in value]
    return data, members


def scribbles_from_dict(
    data: dict[str, Any], members: Mapping[str, bytes], size: tuple[int, int]
) -> Scribbles:
    """The scribbles that :func:`scribbles_to_dict` described."""
    check_known(data, STROKES, "scribbles")
    require_keys(data, STROKES)
    values: dict[str, Any] = {}
    for key in STROKES:
        if data[key] == "mask":
            name = scribble_member(key)
            if name not in members:
                raise InputFileError(f"scribbles: {name} is missing")
            values[key] = read_png(members[name], size, "1", name)
        else:
            check_loops(data[key], f"scribbles.{key}", each="stroke")
            values[key] = data[key]
    try:
        return Scribbles(**values)
    except (TraceError, ValueError, OverflowError) as error:
        raise InputFileError(str(error)) from error


def scribble_member(key: str) -> str:
    """Name of the member that holds a mask."""
    return f"scribbles-{key}.png"
