"""The table of ways to other minima, without solving anything."""

from __future__ import annotations

import pytest

from glid_nb.minima.ways import WAYS, Case


def test_every_way_has_a_name_of_its_own() -> None:
    assert len({way.name for way in WAYS}) == len(WAYS)


def test_a_way_that_is_led_has_a_limit_and_a_predicted_cost() -> None:
    for way in WAYS:
        assert way.limit is None or (way.limit > 0 and way.cost is not None)
        assert way.cost is None or 0 < way.cost < 1


@pytest.mark.parametrize(("ratio", "factor"), [(0.5, 2), (1, 1), (3, 1)])
def test_what_is_predicted_to_cost_half_may_cost_twice_as_much_on_the_way(
    ratio: float, factor: float
) -> None:
    case = Case(ratio=ratio)
    for way in WAYS:
        limit = way.limit_of(case)
        assert limit == (None if way.limit is None else pytest.approx(factor * way.limit))
