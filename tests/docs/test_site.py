"""Checks of the site's pages that need no build."""

from __future__ import annotations

import doctest
import re
from pathlib import Path

import pytest

from glid_nb import figures, methods

from ..foundation.test_public_face import public_names

REPOSITORY = Path(__file__).resolve().parents[2]
DOCS = REPOSITORY / "docs"
REFERENCE = "\n".join(p.read_text(encoding="utf-8") for p in (DOCS / "reference").glob("*.md"))
EXAMPLES = [part.source + part.want for part in doctest.DocTestParser().get_examples(REFERENCE)]
EXPORTS = re.findall(r"(?<=glid_nb\.export\n   :members: ).+", REFERENCE)[0].split(", ")
KINDS = [method.__name__ for method in methods.METHODS.values()]


def test_the_course_lists_every_notebook() -> None:
    course = (DOCS / "course.md").read_text(encoding="utf-8")
    assert "```{course}" in course
    assert ":glob:\n\n/notebooks/*\n" in course


@pytest.mark.parametrize("name", public_names())
def test_the_reference_has_every_public_name(name: str) -> None:
    directive = rf"^\.\. auto(?:function|class|module|exception):: glid_nb\.{re.escape(name)}$"
    assert re.search(directive, REFERENCE, re.MULTILINE)


@pytest.mark.parametrize("name", public_names())
def test_the_references_table_has_every_public_name(name: str) -> None:
    assert f"`glid.{name}`" in (DOCS / "reference" / "index.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", [*public_names(), *figures.__all__, *EXPORTS, *KINDS])
def test_every_name_of_the_reference_has_an_example(name: str) -> None:
    assert any(re.search(rf"\b{re.escape(name)}\b", example) for example in EXAMPLES)


@pytest.mark.parametrize("page", sorted((DOCS / "reference").glob("*.md")), ids=lambda p: p.stem)
def test_an_example_ends_with_an_empty_line(page: Path) -> None:
    """Otherwise doctest takes the fence for expected output."""
    for fence in re.findall(r"```pycon\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL):
        assert fence.endswith("\n\n")
