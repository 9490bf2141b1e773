"""Strict checks of arguments. Error messages name the argument."""

import functools
import itertools
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import field, fields
from numbers import Integral, Real
from types import NoneType
from typing import Any, Literal, get_args, get_origin, get_type_hints

import numpy as np

from glid_nb._arrays import is_finite
from glid_nb._errors import did_you_mean


def check_type(
    name: str, value: Any, wanted: Any, hint: str, error: type[Exception] = TypeError
) -> None:
    """Raise ``error`` unless ``value`` is of the type ``wanted``, a class or a union. The message
    ends with ``hint``."""
    if not isinstance(value, wanted):
        known = getattr(wanted, "__args__", (wanted,))
        *others, last = ("None" if kind is type(None) else kind.__name__ for kind in known)
        text = f"{', '.join(others)} or {last}" if others else last
        raise error(f"{name} must be {text}, not {type(value).__name__}; {hint}")


def check_count(name: str, value: Any, least: int, unit: str) -> int:
    """``value`` as an int. Raises a TypeError if it is not whole, a ValueError if too small."""
    if isinstance(value, bool) or not isinstance(value, Integral):
        raise TypeError(f"{name} must be a whole number of {unit}, not {value!r:.60}")
    if value < least:
        raise ValueError(f"{name} is {value}; it must be at least {least} {unit}")
    return int(value)


def check_keywords(
    name: str, given: Iterable[str], known: Iterable[str], error: type[Exception] = TypeError
) -> None:
    """Raise ``error`` for a keyword that ``name``, for example a class, does not have."""
    known = list(known)
    for keyword in given:
        if keyword not in known:
            hint = did_you_mean(keyword, known) or f"; there are {', '.join(known)}"
            raise error(f"{name} has no argument {keyword!r:.60}{hint}")


def option(
    default: Any,
    help: str,
    label: str = "",
    choices: Mapping[str, str] | None = None,
    **limits: Any,
) -> Any:
    """A dataclass's field with metadata: texts for flags and controls, labels of the values, and
    the allowed range."""
    shown = {"help": help, "label": label, "choices": choices or {}}
    return field(default=default, metadata={**shown, **limits})


def plain(value: Any) -> Any:
    """Convert lists and arrays to tuples, and NumPy's numbers to Python's. Other values stay."""
    if isinstance(value, np.ndarray | np.generic):
        value = value.tolist()
    return tuple(map(plain, value)) if isinstance(value, list | tuple) else value


@functools.cache
def field_kinds(cls: type) -> dict[str, Any]:
    """The annotations of a dataclass's fields, resolved."""
    hints = get_type_hints(cls)
    return {field.name: hints[field.name] for field in fields(cls)}


def check_fields(
    settings: Any, error: type[Exception], called: Callable[[str], str] = lambda name: name
) -> None:
    """Raise ``error`` if the annotation or metadata of a dataclass's field does not allow its
    value.
    """
    kinds = field_kinds(type(settings))
    for known in fields(settings):
        value = getattr(settings, known.name)
        if expected := unmet(kinds[known.name], value, known.metadata):
            wanted = f"must be {expected}{known.metadata.get('why', '')}"
            raise error(f"{called(known.name)} {wanted}, got {value!r:.60}")


def unmet(kind: Any, value: Any, limits: Mapping[str, Any] | None = None) -> str:
    """A description of the allowed values if ``value`` is not allowed; empty if it is.

    ``kind`` is an annotation. ``limits`` may contain the ends of a number's range: "least", by
    default 0, and "most", or "above" and "below". For a tuple of numbers or a sequence it contains
    the "form", the description of the allowed values.
    """
    limits, allowed = limits or {}, get_args(kind)
    if get_origin(kind) is Literal:
        known = any(type(value) is type(one) and value == one for one in allowed)
        return "" if known else f"one of {', '.join(map(str, allowed))}"
    if get_origin(kind) in (tuple, Sequence):
        given = value if isinstance(value, tuple) else ()
        kinds = allowed if get_origin(kind) is tuple else allowed * len(given)
        fits = isinstance(value, tuple) and len(given) == len(kinds)
        fits = fits and not any(map(unmet, kinds, given, itertools.repeat(limits)))
        return "" if fits else limits["form"]
    if allowed:
        each = [unmet(one, value, limits) for one in allowed]
        return "" if "" in each else " or ".join(text for text in each if text != "None")
    if kind is NoneType:
        return "" if value is None else "None"
    if kind is bool:
        return "" if isinstance(value, bool | np.bool_) else "True or False"
    if kind not in (int, float):
        return "" if isinstance(value, kind) else f"a {kind.__name__}"
    least, most = limits.get("least", 0), limits.get("most")
    above, below = limits.get("above", -math.inf), limits.get("below")
    if (
        isinstance(value, Integral if kind is int else Real)
        and not isinstance(value, bool)
        and (is_finite(value) or value == most)
        and least <= value
        and above < value
        and (most is None or value <= most)
        and (below is None or value < below)
    ):
        return ""
    if kind is int:
        return f"a whole number {f'from {least} to' if most else 'of at least'} {most or least}"
    number = "a number" if most == math.inf else "a finite number"
    end = "" if most in (None, math.inf) else f" and at most {most:g}"
    end = end if below is None else f" and less than {below:g}"
    if "above" in limits:
        return f"{number} greater than {above:g}{end}"
    return f"{number} {'' if 'least' in limits else 'of '}at least {least:g}{end}"
