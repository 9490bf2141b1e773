"""ARCHITECTURE.md names what is in the tree, and nothing that is gone."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[2]
PACKAGE = REPOSITORY / "glid_nb"
TEXT = (REPOSITORY / "ARCHITECTURE.md").read_text(encoding="utf-8")
NAMES = sorted(set(re.findall(r"`([^`\n]+)`", re.sub(r"```.*?```", "", TEXT, flags=re.DOTALL))))
# FOLDER stands for one of the user's.
PATHS = [name for name in NAMES if re.fullmatch(r"(?!FOLDER)[\w.-]+(?:/[\w.-]+)+", name)]
FOLDERS = [REPOSITORY, PACKAGE, PACKAGE / "page", PACKAGE / "page" / "js"]
"""Paths in the text begin in one of them."""


def parts(folder: Path) -> list[str]:
    """The names of what lies in a folder and is written by hand."""
    found = [path for path in folder.iterdir() if path.name[0] not in "_."]
    return sorted(path.name for path in found if path.is_dir() or path.suffix == ".py")


def module_of(dotted: str) -> Path | None:
    """The file or folder that the first two parts of a name mean, such as ``session.history``."""
    first, second = dotted.split(".")[:2]
    for root in (PACKAGE, REPOSITORY):
        inside = root / first / second
        if inside.is_dir():
            return inside
        if inside.with_suffix(".py").is_file():
            return inside.with_suffix(".py")
    return None


def dotted_names() -> list[str]:
    packages = "|".join(name for name in parts(PACKAGE) if not name.endswith(".py"))
    names = [name for name in NAMES if re.fullmatch(rf"(?:{packages}|studies)(?:\.\w+)+", name)]
    return [name for name in names if not name.endswith(".json")]


@pytest.mark.parametrize("name", parts(PACKAGE))
def test_the_table_of_layers_has_every_part_of_the_package(name: str) -> None:
    assert f"\n| `{name.removesuffix('.py')}` |" in TEXT


@pytest.mark.parametrize("name", parts(REPOSITORY / "docs" / "extensions"))
def test_every_extension_of_the_site_is_named(name: str) -> None:
    assert f"`{name}`" in TEXT


@pytest.mark.parametrize("name", parts(PACKAGE / "page" / "js"))
def test_every_folder_of_the_page_is_named(name: str) -> None:
    assert re.search(rf"\b{name}[`/]", TEXT)


@pytest.mark.parametrize("path", PATHS)
def test_a_path_exists(path: str) -> None:
    assert any((folder / path).exists() for folder in FOLDERS)


@pytest.mark.parametrize("name", dotted_names())
def test_a_dotted_name_is_that_of_a_module_or_defined_in_its_package(name: str) -> None:
    module, words = module_of(name), name.split(".")
    if module is None:
        sources, words = list(PACKAGE.joinpath(words[0]).glob("__init__.py*")), words[1:]
    else:
        sources, words = [module] if module.is_file() else list(module.glob("*.py")), words[2:]
    text = "".join(path.read_text(encoding="utf-8") for path in sources)
    assert text
    assert [word for word in words if not re.search(rf"\b{word}\b", text)] == []


def test_names_are_found() -> None:
    assert "docs/extensions" in PATHS
    assert "session.editor_model.EditorModel" in dotted_names()
    assert module_of("session.editor_model.EditorModel") is not None
    assert module_of("session.gone") is None
