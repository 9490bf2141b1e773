"""Arguments of the wrong type, refused by name before anything is computed."""

from __future__ import annotations

from typing import Any


def check_type(name: str, value: Any, wanted: Any, hint: str) -> None:
    """Refuse an argument that is not what it should be.

    Parameters
    ----------
    name : str
        The argument's.
    value
    wanted
        A class or a union of classes.
    hint : str
        What to give instead.

    Raises
    ------
    TypeError
        When ``value`` is no instance of ``wanted``.
    """
    if not isinstance(value, wanted):
        known = getattr(wanted, "__args__", (wanted,))
        *others, last = ("None" if kind is type(None) else kind.__name__ for kind in known)
        text = f"{', '.join(others)} or {last}" if others else last
        raise TypeError(f"{name} must be {text}, not {type(value).__name__}; {hint}")
