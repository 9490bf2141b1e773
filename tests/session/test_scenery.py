"""Which of several shapes is pressed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from glid_nb.geometry import Cage, Domain
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging.order import order_of
from glid_nb.session.scenery import Scenery, pressed

SIDE = 40  # pixels of a picture, 20 units


def _square(key: str, x: float, above: bool = False) -> Scenery:
    """A square of 8 units around (x, 0), of which the right half is transparent."""
    cage = Cage([[x - 4, -4], [x + 4, -4], [x + 4, 4], [x - 4, 4]])
    picture = np.full((SIDE, SIDE, 4), 255, np.uint8)
    picture[:, int((x + 10) * SIDE / 20) :, 3] = 0
    return Scenery(key, picture, HarmonicMap.identity(Domain.from_cage(cage)), above=above)


EDITED, LEFT, RIGHT = _square("edited", 0), _square("left", -3), _square("right", 1)


@pytest.mark.parametrize(
    ("x", "expected"),
    [(-6.5, "left"), (-3.5, None), (-2.0, None), (0.5, "right"), (2.0, None), (9.0, None)],
)
def test_behind_the_edited_shape_a_visible_one_is_pressed(x: float, expected: str | None) -> None:
    # The edited shape is seen from -4 to 0, the one on the left to -3, the one on the right to 1.
    found = pressed(np.array([x, 0.0]), EDITED.sheets, [LEFT, RIGHT])
    assert (found and found.key) == expected


@pytest.mark.parametrize(("x", "expected"), [(-3.5, "left"), (-2.0, "right"), (0.5, "right")])
def test_in_front_of_it_the_last_visible_one_is_pressed(x: float, expected: str) -> None:
    above = [replace(shape, above=True) for shape in (RIGHT, LEFT)]
    assert pressed(np.array([x, 0.0]), EDITED.sheets, above).key == expected  # type: ignore[union-attr]
    found = pressed(np.array([-3.5, 0.0]), EDITED.sheets, above[:1])
    assert found is None  # which is the edited shape: the one on the right begins at -3


def test_a_shape_is_pressed_where_its_map_takes_it() -> None:
    moved = HarmonicMap(LEFT.map.domain, LEFT.map.phi + 9 * (LEFT.map.phi != 0), LEFT.map.psi)
    shape = replace(LEFT, map=moved, order=order_of(moved.domain.cage))
    assert pressed(np.array([4.5, 2.0]), EDITED.sheets, [shape]) is shape
    assert pressed(np.array([-6.5, 2.0]), EDITED.sheets, [shape]) is None
