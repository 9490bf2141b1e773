"""Arguments are refused by name, with the remedy."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from glid_nb import _runtime
from glid_nb._arguments import check_count, check_keywords, check_type
from glid_nb._runtime import in_chunks


def test_what_belongs_passes() -> None:
    check_type("weights", None, list | None, "give a list")
    check_type("weights", [1], list, "give a list")
    check_keywords("Editor", ["width"], ["width", "height"])
    assert check_count("width", np.int64(3), 3, "pixels") == 3


@pytest.mark.parametrize(
    ("check", "error", "message"),
    [
        (
            lambda: check_type("weights", 3, list | dict | None, "give a list"),
            TypeError,
            "weights must be list, dict or None, not int; give a list",
        ),
        (
            lambda: check_type("weights", 3, list, "give a list", ValueError),
            ValueError,
            "weights must be list, not int; give a list",
        ),
        (
            lambda: check_keywords("Editor", ["widht"], ["width", "height"]),
            TypeError,
            "Editor has no argument 'widht'; did you mean 'width'?",
        ),
        (
            lambda: check_keywords("Editor", ["qqq"], ["width", "height"]),
            TypeError,
            "Editor has no argument 'qqq'; there are width, height",
        ),
        (
            lambda: check_count("width", 2.5, 1, "pixels"),
            TypeError,
            "width must be a whole number of pixels, not 2.5",
        ),
        (
            lambda: check_count("width", True, 1, "pixels"),
            TypeError,
            "width must be a whole number of pixels, not True",
        ),
        (
            lambda: check_count("width", 2, 3, "pixels"),
            ValueError,
            "width is 2; it must be at least 3 pixels",
        ),
    ],
)
def test_what_does_not_belong_is_refused(
    check: Callable[[], Any], error: type[Exception], message: str
) -> None:
    with pytest.raises(error) as refused:
        check()
    assert str(refused.value) == message


@pytest.mark.parametrize("count", [0, 1, 4, 9])
def test_the_results_of_chunks_are_put_together(
    count: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(_runtime, "CHUNK_ELEMENTS", 8)
    sizes = []

    def program(x: Any, y: Any, scale: float) -> dict[str, Any]:
        sizes.append(len(x))
        return {"sum": x + y, "rows": np.stack([x, scale * y / (1 - y)], axis=1)}

    x, y = np.arange(count, dtype=float), np.arange(1.0, count + 1)
    got = in_chunks(program, 2, (x, y), 2.0)
    assert sum(sizes) == count
    assert max(sizes) <= 4
    np.testing.assert_array_equal(got["sum"], x + y)
    with np.errstate(divide="ignore"):  # inside a chunk there is no warning
        np.testing.assert_array_equal(got["rows"], np.stack([x, 2 * y / (1 - y)], axis=1))
