"""How the hand meets pins: locked, hidden or grouped. The solver does not know of this."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Self

from numpy.typing import ArrayLike

from glid_nb import _json
from glid_nb._arguments import check_fields
from glid_nb._arrays import Array, number_pairs
from glid_nb._errors import InputError, InputFileError, about

_Handle = tuple[float, float]


class PinMarkError(InputError):
    """A mark of a pin is not valid."""


@dataclass(frozen=True)
class PinMark:
    """How the hand meets one pin. Raises a PinMarkError for other values."""

    locked: bool = False
    """Whether the hand cannot move it. It stays a constraint."""
    hidden: bool = False
    """Whether it is neither drawn nor hit. It stays a constraint."""
    group: int = 0
    """Pins with the same number above 0 are selected and moved together."""

    def __post_init__(self) -> None:
        check_fields(self, PinMarkError)


_PLAIN = PinMark()


@dataclass(frozen=True)
class PinMarks:
    """The marks of pins, by their handles. So all poses with a handle share its mark."""

    marks: Mapping[_Handle, PinMark] = field(default_factory=dict)
    """Handles without an entry have no mark."""

    def __bool__(self) -> bool:
        return bool(self.marks)

    def of(self, handles: ArrayLike) -> tuple[PinMark, ...]:
        """The marks of handles (h, 2)."""
        return tuple(self.marks.get(handle, _PLAIN) for handle in _keys(handles))

    def changed(self, handles: ArrayLike, **changes: Any) -> Self:
        """Marks where these handles (h, 2) have other values."""
        old = zip(_keys(handles), self.of(handles), strict=True)
        return self._with({handle: replace(mark, **changes) for handle, mark in old})

    def grouped(self, handles: ArrayLike) -> Self:
        """Marks where these handles (h, 2) are a group of their own."""
        number = 1 + max((mark.group for mark in self.marks.values()), default=0)
        return self.changed(handles, group=number)

    def moved(self, handles: ArrayLike, places: ArrayLike) -> Self:
        """Marks where handles at other places (h, 2) have the marks of ``handles`` (h, 2)."""
        return self._with(dict(zip(_keys(places), self.of(handles), strict=True)))

    def only(self, handles: Iterable[Array]) -> Self:
        """The marks of these handles only, each an array (h, 2)."""
        kept = {handle for each in handles for handle in _keys(each)}
        return type(self)({handle: m for handle, m in self.marks.items() if handle in kept})

    def _with(self, changes: Mapping[_Handle, PinMark]) -> Self:
        new = {**self.marks, **changes}
        return type(self)({handle: mark for handle, mark in new.items() if mark != _PLAIN})

    def to_list(self) -> list[dict[str, Any]]:
        """Plain JSON values."""
        return [
            {"handle": list(handle), **{k: v for k, v in vars(mark).items() if v}}
            for handle, mark in self.marks.items()
        ]

    @classmethod
    def from_list(cls, data: Any, name: str) -> Self:
        """The marks that `to_list` wrote. Raises an InputFileError that names the wrong part."""
        _json.check_list(data, name)
        marks: dict[_Handle, PinMark] = {}
        optional = _json.keys(*vars(_PLAIN))
        for i, one in enumerate(data):
            with about(f"{name}[{i}]", InputFileError):
                _json.check_fields(one, "it", _json.keys("handle"), optional)
                _json.check_points([one["handle"]], "handle")
                x, y = one["handle"]
                given = {key: one[key] for key in optional if one.get(key) is not None}
                marks[float(x), float(y)] = PinMark(**given)
        return cls(marks)


def with_groups(marks: Sequence[PinMark], chosen: Iterable[int]) -> tuple[int, ...]:
    """Indices of pins with those of their groups before them, each once. The last one stays
    last."""
    wanted = tuple(dict.fromkeys(chosen))
    groups = {marks[i].group for i in wanted} - {0}
    mates = (i for i, mark in enumerate(marks) if mark.group in groups and i not in wanted)
    return (*mates, *wanted)


def switched(marks: Sequence[PinMark], chosen: Iterable[int], pin: int) -> tuple[int, ...]:
    """The chosen pins with one more, which comes last, or without it and its group."""
    chosen = tuple(chosen)
    if pin not in chosen:
        return (*chosen, pin)
    mates = with_groups(marks, [pin])
    return tuple(i for i in chosen if i not in mates)


def _keys(handles: ArrayLike) -> list[_Handle]:
    points = number_pairs(handles, "handles must be [x, y] pairs", PinMarkError)
    return [(x, y) for x, y in points.tolist()]
