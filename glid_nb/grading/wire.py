"""Values between the referee and the process of the answers, as JSON.

Reading them runs no code of the sender: they are numbers, texts, lists, arrays of numbers, poses,
expressions, and references, which are numbers.
"""

from __future__ import annotations

import base64
import math
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from glid_nb._errors import InputError
from glid_nb.geometry import Cage, Domain
from glid_nb.harmonic import HarmonicMap
from glid_nb.pose import Pose

_POSE = ("handles", "targets", "depths", "angles", "scales", "weights")
_KINDS = "biufc"  # of arrays: numbers only


class WireError(InputError):
    """A value cannot leave the process of the answers."""


def encoded(value: Any, reference: Callable[[Any], int] | None = None) -> Any:
    """A value as JSON. What is no data is sent as a reference, if there is a ``reference``.

    Raises a WireError for other values.
    """
    if value is None or isinstance(value, bool | str):
        return value
    if type(value) in (int, float):
        return value
    if value is ...:
        return {"is": "ellipsis"}
    if type(value) is complex:
        return {"is": "complex", "parts": [value.real, value.imag]}
    if type(value) in (list, tuple):
        name = "list" if type(value) is list else "tuple"
        return {"is": name, "items": [encoded(item, reference) for item in value]}
    if isinstance(value, Path):
        return {"is": "path", "path": str(value)}
    if isinstance(value, Pose):
        fields = {name: encoded(np.asarray(getattr(value, name))) for name in _POSE}
        return {"is": "pose", "fields": fields}
    if isinstance(value, np.ndarray | np.generic) or hasattr(value, "__array_namespace__"):
        array = np.asarray(value)
        if array.dtype.kind in _KINDS:
            return {
                "is": "array" if isinstance(value, np.ndarray | np.generic) else "jax",
                "dtype": array.dtype.str,
                "shape": list(array.shape),
                "bytes": base64.b64encode(array.tobytes()).decode(),
            }
    if reference is None:
        raise WireError(f"an answer is made of numbers, arrays and poses, not {type(value)!r:.80}")
    if isinstance(value, HarmonicMap | Domain | Cage):  # only towards the answers
        return {"is": "pickle", "bytes": base64.b64encode(pickle.dumps(value)).decode()}
    return {"is": "reference", "number": reference(value)}


def decoded(data: Any, reference: Callable[[int], Any], *, trusted: bool = False) -> Any:
    """The value. Pickles are read only from a ``trusted`` sender. Raises a WireError."""
    try:
        return _decoded(data, reference, trusted)
    except WireError:
        raise
    except (AttributeError, KeyError, TypeError, ValueError, RecursionError) as error:
        raise WireError(f"this is no value: {error}") from None


def _decoded(data: Any, reference: Callable[[int], Any], trusted: bool) -> Any:
    if data is None or isinstance(data, bool | int | float | str):
        return data
    kind = data["is"]
    if kind == "ellipsis":
        return ...
    if kind == "complex":
        return complex(*map(float, data["parts"]))
    if kind in ("list", "tuple"):
        items = [_decoded(item, reference, trusted) for item in data["items"]]
        return items if kind == "list" else tuple(items)
    if kind == "path":
        return Path(str(data["path"]))
    if kind == "pose":
        fields = {name: _decoded(data["fields"][name], reference, trusted) for name in _POSE}
        return Pose(**fields)
    if kind in ("array", "jax"):
        return _array(data)
    if kind == "reference":
        return reference(int(data["number"]))
    if kind == "pickle" and trusted:
        return pickle.loads(base64.b64decode(data["bytes"]))
    raise WireError(f"a value of the kind {kind!r:.40} is not read here")


def _array(data: Any) -> Any:
    dtype = np.dtype(str(data["dtype"]))
    shape = tuple(int(n) for n in data["shape"])
    if dtype.kind not in _KINDS or any(n < 0 for n in shape):
        raise WireError("an array holds numbers only")
    raw = base64.b64decode(data["bytes"])
    if len(raw) != dtype.itemsize * math.prod(shape):
        raise WireError("an array has another size than it says")
    array = np.frombuffer(raw, dtype).reshape(shape).copy()
    return array[()] if not shape else array
