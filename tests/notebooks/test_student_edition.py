"""`make student`: the chapters without solutions and without the inside of the checks."""

from __future__ import annotations

import importlib.util
import re
from pathlib import Path
from types import ModuleType
from typing import Any

import nbformat
import pytest

from glid_nb.course import CHECK_HEADING, run_check
from glid_nb.grading.chapters import Notebook, answers

CHECKOUT = Path(__file__).parents[2]
CHAPTERS = sorted((CHECKOUT / "notebooks").glob("[0-9][0-9]*_*.ipynb"))


@pytest.fixture(scope="module")
def tool() -> ModuleType:
    path = CHECKOUT / "tools" / "student_edition.py"
    spec = importlib.util.spec_from_file_location("student_edition", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def edition(tool: ModuleType, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("student")
    tool.main(folder)
    return folder


def with_tag(path: Path, tag: str) -> list[Any]:
    book = nbformat.read(path, as_version=4)
    return [cell for cell in book.cells if tag in cell.metadata.get("tags", ())]


@pytest.mark.parametrize("path", CHAPTERS, ids=lambda path: path.stem)
def test_it_shows_neither_solutions_nor_checks(edition: Path, path: Path) -> None:
    book = nbformat.read(edition / path.name, as_version=4)
    nbformat.validate(book)
    text = "\n".join(cell.source for cell in book.cells)
    solutions = (CHECKOUT / "notebooks" / "solutions" / f"{path.stem}.py").read_text("utf-8")
    assert "<summary>Solution" not in text
    assert "with check(" not in text
    assert "assert " not in "\n".join(
        cell.source for cell in with_tag(edition / path.name, "check")
    )
    bodies = solutions.split("# %% ")[1:]
    assert not [body for body in bodies if body.partition("\n")[2].strip() in text]


@pytest.mark.parametrize("path", CHAPTERS, ids=lambda path: path.stem)
def test_its_links_lead_to_its_own_files(edition: Path, path: Path) -> None:
    book = nbformat.read(edition / path.name, as_version=4)
    text = "\n".join(cell.source for cell in book.cells if cell.cell_type == "markdown")
    targets = re.findall(r"\]\((?![a-z]+:|#)([^)#]+)", text)
    assert not [target for target in targets if not (edition / target).exists()]


@pytest.mark.parametrize("path", CHAPTERS, ids=lambda path: path.stem)
def test_its_checks_are_those_of_the_chapter(edition: Path, path: Path) -> None:
    parts = CHECK_HEADING.split((edition / "checks" / f"{path.stem}.py").read_text("utf-8"))
    checks = [cell.source.strip() for cell in with_tag(path, "check")]
    assert [text.strip() for text in parts[2::2]] == checks
    assert list(map(int, parts[1::2])) == list(range(1, len(checks) + 1))


@pytest.mark.parametrize("path", CHAPTERS, ids=lambda path: path.stem)
def test_handed_in_as_it_is_it_is_untouched(edition: Path, path: Path) -> None:
    given = answers(Notebook.read(path), Notebook.read(edition / path.name))
    assert given
    assert all(one.untouched == "the cell is as it was given" for one in given.values())
    assert Notebook.read(edition / path.name).chapter == path.stem


def test_cells_to_fill_in_and_locked_checks_are_nbgraders(edition: Path) -> None:
    for path in CHAPTERS:
        cells = nbformat.read(edition / path.name, as_version=4).cells
        marked = [cell.metadata.nbgrader for cell in cells if "nbgrader" in cell.metadata]
        graded = [one for one in marked if one.grade]
        assert len(graded) == len(with_tag(path, "check"))
        assert all(one.locked and not one.solution and one.points == 1 for one in graded)
        assert all(one.solution and "points" not in one for one in marked if not one.grade)
        assert len({one.grade_id for one in marked}) == len(marked)
        assert {one.schema_version for one in marked} == {3}


def test_a_check_runs_from_its_file_in_the_notebooks_namespace(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    first, second = "found = 1", "with check('exercise 2'):\n    assert x == 2"
    text = f"# %% exercise 1\n{first}\n\n\n# %% exercise 2\n{second}\n"
    (tmp_path / "checks.py").write_text(text, encoding="utf-8")
    namespace: dict[str, Any] = {"x": 3}
    exec("from glid_nb.course import check", namespace)
    run_check(tmp_path / "checks.py", 2, namespace)
    assert capsys.readouterr().out.startswith("exercise 2: not yet")
    run_check(tmp_path / "checks.py", 1, namespace)
    assert namespace["found"] == 1
