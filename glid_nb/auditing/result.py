"""The result of an audit."""

import math
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from glid_nb._arrays import Floats, Rebuilt, frozen
from glid_nb._errors import InputError

Verdict = Literal["proved", "folds", "collapses", "undecided"]


class AuditError(InputError):
    """The warp cannot be audited as it is given."""


@dataclass(frozen=True, eq=False)
class Audit(Rebuilt):
    """What is proved of a warp. `glid_nb.figures.folds` draws it."""

    verdict: Verdict
    """"proved": free of folds. "folds": a negative determinant is proved, or a vertex round which
    the triangles wind more than once. "collapses": no determinant is negative, but one is exactly
    0. "undecided": nothing is proved; only functions can be undecided."""
    kind: Literal["field", "mesh", "map"]
    message: str
    """The verdict in one sentence."""
    point: tuple[float, float] | None
    """(x, y), in the source, of a proved negative determinant. None without one."""
    determinant: float | None
    """The determinant there. It may be rounded, but its sign is proved. For a function, it is an
    upper bound of the determinant."""
    smallest: float
    """The smallest determinant, rounded. For a function, the smallest that was met, not proved."""
    where: tuple[float, float]
    """(x, y), in the source, of the smallest determinant."""
    lower_bound: float | None
    """No determinant is smaller, if the verdict is "proved". Otherwise None."""
    folded: int
    """The number of pieces (cells, triangles or boxes) with a negative determinant."""
    pieces: int
    """The number of all pieces."""
    folded_area: float
    """The area in the source where the determinant is negative. For a function, the area of the
    boxes that are proved to fold."""
    undecided_area: float
    """The area in the source where no sign is proved. It is 0 for fields and meshes."""
    determinants: Floats = field(repr=False)
    """The smallest determinant of each piece: (h - 1, w - 1) of a field, (p,) of others. For a
    function, one determinant inside each box. NaN where a `DisplacementField` is not known."""
    signs: NDArray[np.int8] = field(repr=False)
    """The proved sign of each piece: 1 if its determinant is positive everywhere, -1 if it is
    negative somewhere (of a box: everywhere). 0 is exact for fields and meshes; a box with 0 is
    undecided, and a cell where a `DisplacementField` is not known has 0, too."""
    outlines: Floats | None = field(repr=False, default=None)
    """(p, k, 2) corners, in the source, of the pieces. None for a field, whose cells are a grid."""

    def __post_init__(self) -> None:
        vars(self).update(determinants=frozen(self.determinants), signs=frozen(self.signs))
        if self.outlines is not None:
            vars(self).update(outlines=frozen(self.outlines))

    @property
    def proved(self) -> bool:
        """Whether the warp is proved free of folds."""
        return self.verdict == "proved"

    def to_dict(self) -> dict[str, Any]:
        """All but the arrays, as values for JSON."""
        names = ("verdict", "kind", "message", "point", "determinant", "smallest", "where")
        names += ("lower_bound", "folded", "pieces", "folded_area", "undecided_area")
        values = {name: getattr(self, name) for name in names}
        return {name: _for_json(value) for name, value in values.items()}


def _for_json(value: Any) -> Any:
    if isinstance(value, tuple):
        return list(value)
    return None if isinstance(value, float) and not math.isfinite(value) else value


def at(point: tuple[float, float]) -> str:
    """A point as text."""
    return f"({point[0]:.6g}, {point[1]:.6g})"


def share(folded: int, pieces: int, one: str, many: str) -> str:
    """For example "3 of 1,024 cells fold"."""
    noun, verb = (one if pieces == 1 else many), ("folds" if folded == 1 else "fold")
    return f"{folded:,} of {pieces:,} {noun} {verb}"
