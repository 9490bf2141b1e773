"""The pages of the proofs name code and tests that exist."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize(("name", "least"), [("proof.md", 20), ("motion.md", 10)])
def test_every_lemma_names_its_code_and_its_test(name: str, least: int) -> None:
    page = ROOT / "docs" / name
    text = page.read_text(encoding="utf-8")
    for name, target in re.findall(r"\[([^\]]+)\]\(([^)]+)\)", text):
        source = (page.parent / target).read_text(encoding="utf-8")
        for word in re.findall(r"`(?:\w+\.)*(\w+)`", name):
            assert re.search(rf"\b{word}\b", source), (word, target)
    tests = re.findall(r"`(tests/[\w/]+\.py)::(\w+)`", text)
    assert len(tests) > least
    for file, name in tests:
        assert f"def {name}(" in (ROOT / file).read_text(encoding="utf-8"), name
    numbers = re.findall(r"\*\*Lemma (\d+) \(", text)
    assert numbers == [str(i) for i in range(1, len(numbers) + 1)]
    for lemma in re.split(r"\*\*Lemma \d+", text)[1:]:
        assert "tests/" in lemma
