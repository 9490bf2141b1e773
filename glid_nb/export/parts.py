"""Checks of the shapes that an export of several takes."""

import itertools
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any, TypeVar

from glid_nb._arguments import check_type
from glid_nb._errors import InputError

T = TypeVar("T")


def checked_parts(parts: Iterable[T], kind: type[T]) -> list[T]:
    """The parts as a list. Raises an InputError unless there is at least one, all of a kind."""
    wanted = f"pass a list of {kind.__name__}, the rearmost first"
    check_type("parts", parts, Iterable, wanted, InputError)
    given = list(parts)
    if not given:
        raise InputError(f"there are no parts; {wanted}")
    for i, part in enumerate(given):
        check_type(f"parts[{i}]", part, kind, wanted, InputError)
    return given


def named_parts(parts: Iterable[T], kind: type[T]) -> list[T]:
    """Like `checked_parts`, each with a name of its own. One of several without a name gets its
    number."""
    given: list[Any] = checked_parts(parts, kind)
    names: set[str] = set()
    for i, part in enumerate(given):
        check_type(f"the name of parts[{i}]", part.name, str, 'for example "arm"', InputError)
        if part.name and part.name in names:
            what = f"two parts have the name {part.name!r:.80}"
            raise InputError(f"{what}; give each a name of its own")
        names.add(part.name)
    if len(given) == 1:
        return given
    named: list[T] = []
    for number, part in enumerate(given, 1):
        numbered = (f"Part {n}" for n in itertools.count(number))
        name = part.name or next(one for one in numbered if one not in names)
        names.add(name)
        named.append(replace(part, name=name))
    return named


def checked_meshes(meshes: Mapping[str, T], kind: type[T]) -> dict[str, T]:
    """The meshes by the names of their parts. Raises an InputError unless there is at least one,
    all of a kind."""
    wanted = f"pass a dict of {kind.__name__} by the names of the parts, the rearmost first"
    check_type("meshes", meshes, Mapping, wanted, InputError)
    if not meshes:
        raise InputError(f"meshes is empty; {wanted}")
    for name, mesh in meshes.items():
        check_type("a name in meshes", name, str, wanted, InputError)
        check_type(f"meshes[{name!r:.80}]", mesh, kind, wanted, InputError)
    return dict(meshes)
