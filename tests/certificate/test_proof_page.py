"""The page of the proof names code and tests that exist."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "proof.md"


def test_every_lemma_names_its_code_and_its_test() -> None:
    text = PAGE.read_text(encoding="utf-8")
    for name, target in re.findall(r"\[([^\]]+)\]\(([^)]+)\)", text):
        source = (PAGE.parent / target).read_text(encoding="utf-8")
        for word in re.findall(r"`(?:\w+\.)*(\w+)`", name):
            assert re.search(rf"\b{word}\b", source), (word, target)
    tests = re.findall(r"`(tests/[\w/]+\.py)::(\w+)`", text)
    assert len(tests) > 20
    for file, name in tests:
        assert f"def {name}(" in (ROOT / file).read_text(encoding="utf-8"), name
    numbers = re.findall(r"\*\*Lemma (\d+) \(", text)
    assert numbers == [str(i) for i in range(1, len(numbers) + 1)]
    for lemma in re.split(r"\*\*Lemma \d+", text)[1:]:
        assert "tests/" in lemma
