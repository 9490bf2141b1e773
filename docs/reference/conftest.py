"""The names that the reference's examples share: what the examples of index.md make."""

from __future__ import annotations

import doctest
import functools
from pathlib import Path
from typing import Any

import pytest

INDEX = Path(__file__).with_name("index.md")


@functools.cache
def shared(solved: bool) -> dict[str, Any]:
    names: dict[str, Any] = {}
    for example in doctest.DocTestParser().get_examples(INDEX.read_text(encoding="utf-8")):
        if solved or not example.source.startswith("result"):
            exec(example.source, names)
    return names


@pytest.fixture(autouse=True)
def _names(request: pytest.FixtureRequest, doctest_namespace: dict[str, Any]) -> None:
    """A solve takes seconds of compiling, so only pages that use its result have it."""
    page = request.path
    if page != INDEX:
        doctest_namespace.update(shared("result" in page.read_text(encoding="utf-8")))
