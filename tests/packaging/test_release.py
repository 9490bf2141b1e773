"""The checks before an upload, and the files that workflows name."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tools.check_release import problems

REPOSITORY = Path(__file__).resolve().parents[2]
WORKFLOWS = sorted((REPOSITORY / ".github" / "workflows").glob("*.yml"))
FILES = [
    "dist/glid-nb/glid_nb-1.2.3-py3-none-any.whl",
    "dist/glid-nb/glid_nb-1.2.3.tar.gz",
    "dist/glid-check/glid_check-1.2.3-py3-none-any.whl",
    "dist/glid-check/glid_check-1.2.3.tar.gz",
]
CHANGELOG = "# Changelog\n\n## Unreleased\n\n## 1.2.3 - 2026-12-01\n"


def test_a_tag_that_agrees_with_everything_may_be_released() -> None:
    assert problems("v1.2.3", FILES, CHANGELOG) == []


@pytest.mark.parametrize("tag", ["1.2.3", "v1.2", "v1.2.3.dev1", "version-1.2.3"])
def test_a_tag_of_another_form_is_refused(tag: str) -> None:
    wanted = f"the tag {tag} is not of the form v1.2.3 or v1.2.3rc1"
    assert wanted in problems(tag, FILES, CHANGELOG)


def test_another_version_is_refused_for_each_file() -> None:
    found = problems("v1.2.4", FILES, CHANGELOG.replace("1.2.3", "1.2.4"))
    assert found == [f"{file} has version 1.2.3, the tag says 1.2.4" for file in FILES]


def test_a_missing_and_a_strange_file_are_named() -> None:
    found = problems("v1.2.3", [*FILES[:3], "dist/notes.txt"], CHANGELOG)
    assert found == [
        "dist/notes.txt is not a wheel or sdist of glid-nb or glid-check",
        "glid_check.tar.gz is missing",
    ]


@pytest.mark.parametrize("text", ["# Changelog\n", "## 1.2.30\n", "text ## 1.2.3\n"])
def test_a_version_without_a_section_in_the_changelog_is_refused(text: str) -> None:
    assert problems("v1.2.3", FILES, text) == ["CHANGELOG.md has no section '## 1.2.3'"]


@pytest.mark.parametrize("path", WORKFLOWS, ids=lambda path: path.stem)
def test_a_workflow_names_scripts_and_targets_that_exist(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    scripts = re.findall(r"\btools/[\w.]+", text)
    makefile = (REPOSITORY / "Makefile").read_text(encoding="utf-8")
    targets = re.findall(r"run: make ([\w-]+)", text)
    assert scripts or targets
    assert all((REPOSITORY / script).is_file() for script in scripts)
    assert all(re.search(rf"^{target}:", makefile, re.MULTILINE) for target in targets)


def test_all_supported_pythons_are_tested_and_named_on_the_index() -> None:
    tests = (REPOSITORY / ".github" / "workflows" / "tests.yml").read_text(encoding="utf-8")
    matrix = re.search(r"python: \[(.*)\]", tests)
    assert matrix is not None
    for file in ("pyproject.toml", "checker/pyproject.toml"):
        text = (REPOSITORY / file).read_text(encoding="utf-8")
        named = re.findall(r'"Programming Language :: Python :: (3\.\d+)"', text)
        assert named == re.findall(r'"([\d.]+)"', matrix[1]), file
