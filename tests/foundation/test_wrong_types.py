"""Arguments of a wrong type: the error names the argument and does not come from inside."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

import glid_nb as glid

SQUARE = glid.Cage([[0, 0], [4, 0], [4, 2], [0, 2]])
SQUARE_BOX = (0, 0, 4, 2)


def identity() -> glid.HarmonicMap:
    return glid.HarmonicMap.identity(glid.Domain.from_cage(SQUARE))


CALLS: list[tuple[str, Callable[[Any], Any]]] = [
    ("map must be", lambda value: glid.certify(value)),
    ("panels must be", lambda value: glid.certify(identity(), panels=value)),
    ("tightness must be", lambda value: glid.certify(identity(), tightness=value)),
    ("map must be", lambda value: glid.global_injectivity(value)),
    ("certificate must be", lambda value: glid.global_injectivity(identity(), value)),
    ("map must be", lambda value: glid.render([[0.0]], value)),
    ("domain must be", lambda value: glid.HarmonicMap(value, [1], [1])),
    ("domain must be", lambda value: glid.HarmonicMap.identity(value)),
    ("cage must be", lambda value: glid.Domain.from_cage(value)),
    ("cage must be", lambda value: glid.Domain(value, SQUARE)),
    ("cage must be", lambda value: glid.cut(value, [[-1, 0], [1, 0]])),
    ("offset_cage must be", lambda value: glid.Domain(SQUARE, value)),
    ("result must be", lambda value: glid.io.build_report(value)),
    ("domain must be", lambda value: glid.suggest_pose(value)),
    ("result must be", lambda value: glid.refine(value)),
    ("map must be", lambda value: glid.certify(identity()).belongs_to(value)),
    (
        "second_derivative must be",
        lambda v: glid.audit(abs, bounds=SQUARE_BOX, second_derivative=v),
    ),
    ("jacobian must be", lambda value: glid.audit(abs, bounds=SQUARE_BOX, jacobian=value)),
    ("warp must be", lambda value: glid.audit(value)),
    ("audit must be", lambda value: glid.figures.folds(value)),
    ("other must be", lambda value: identity().distance(value)),
    ("order must be", lambda value: identity().wirtinger_derivatives([[1, 1]], value)),
]


@pytest.mark.parametrize(("message", "call"), CALLS)
def test_it_is_named(message: str, call: Callable[[Any], Any]) -> None:
    with pytest.raises(TypeError, match=message):
        call("text")


@pytest.mark.parametrize("points", ["a", [[1, 2], [3]], [[1, 2, 3]], [1, 2]])
def test_points_are_pairs(points: Any) -> None:
    with pytest.raises(glid.InputError, match=r"points must be \(k, 2\) coordinates"):
        identity()(points)


def test_integers_beyond_floating_point() -> None:
    square = [[10**400, 0], [4, 0], [4, 2], [0, 2]]
    with pytest.raises(glid.InputError, match=r"cage\[0\] must be finite"):
        glid.io.Problem.from_dict({"cage": square, "handles": [[1, 1]], "targets": [[1, 1]]})
