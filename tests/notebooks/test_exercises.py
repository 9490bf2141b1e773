"""The course: saved notebooks, and the checks of the exercises.

A chapter's cells are run once, in one namespace and without figures. Each check is run on the
skeleton, the solution and the wrong answers of `notebooks/solutions`.
"""

from __future__ import annotations

import ast
import contextlib
import importlib.util
import io
import re
import symtable
import sys
from pathlib import Path
from typing import Any, NamedTuple
from unittest.mock import MagicMock

import nbformat
import pytest

from glid_nb import InputError, figures

FOLDER = Path(__file__).parents[2] / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("[0-9][0-9]_*.ipynb"))
_HEADING = re.compile(r"^# %% exercise (\d+): (.+)$", re.MULTILINE)
_FENCE = re.compile(r"<details>.*?```python\n(.*?)\n```.*?</details>", re.DOTALL)

pytestmark = pytest.mark.slow  # each chapter solves a few problems


class Outcome(NamedTuple):
    """What the check of an exercise prints for an answer."""

    exercise: int
    answer: str
    printed: str


def cells(path: Path) -> list[Any]:
    return nbformat.read(path, as_version=4).cells


def has(cell: Any, tag: str) -> bool:
    return tag in cell.metadata.get("tags", ())


def answers(path: Path) -> dict[tuple[int, str], str]:
    """The code of each answer by the exercise's number and the answer's name."""
    text = (path.parent / "solutions" / path.stem).with_suffix(".py").read_text(encoding="utf-8")
    _, *parts = _HEADING.split(text)
    triples = zip(parts[::3], parts[1::3], parts[2::3], strict=True)
    return {(int(number), name): code.strip() for number, name, code in triples}


def printed(code: str, name: str, namespace: dict[str, Any]) -> str:
    with contextlib.redirect_stdout(io.StringIO()) as out:
        exec(compile(code, name, "exec"), namespace)
    return out.getvalue().strip()


def outcomes(path: Path) -> tuple[Outcome, ...]:
    """Run a chapter up to its last check, and each check on the skeleton and all answers."""
    namespace: dict[str, Any] = {"__name__": "__main__", "display": lambda *_: None}
    book = [cell for cell in cells(path) if cell.cell_type == "code"]
    last = max(i for i, cell in enumerate(book) if has(cell, "check"))
    known, found, exercise = answers(path), [], 0
    for cell in book[: last + 1]:
        if has(cell, "nbval-skip"):
            continue
        text = printed(cell.source, path.name, namespace)
        if not has(cell, "check"):
            continue
        exercise += 1
        found.append(Outcome(exercise, "skeleton", text))
        for (number, name), code in known.items():
            if number == exercise:
                tried = dict(namespace)
                for (earlier, kind), solved in known.items():
                    if earlier < exercise and kind == "solution":
                        printed(solved, path.name, tried)
                printed(code, path.name, tried)
                found.append(Outcome(exercise, name, printed(cell.source, path.name, tried)))
    return tuple(found)


def assigned(code: str) -> set[str]:
    """The names that a cell leaves."""
    names = symtable.symtable(code, "cell", "exec").get_symbols()
    return {name.get_name() for name in names if name.is_assigned() or name.is_imported()}


def mentioned(table: symtable.SymbolTable) -> set[str]:
    """The chapter's names that a cell assigns or reads, also in its functions."""
    outside = table.get_type() == "module"
    own = {name.get_name() for name in table.get_symbols() if outside or name.is_global()}
    return own.union(*map(mentioned, table.get_children()))


def inlined(code: str) -> set[str]:
    """The variables that occur only in a cell's comprehensions.

    From Python 3.12 on, they are symbols of the module.
    """
    tree = ast.parse(code)
    loops = [node for node in ast.walk(tree) if isinstance(node, ast.comprehension)]
    targets = [name for loop in loops for name in ast.walk(loop.target)]
    inside = {id(name) for name in targets}
    stored = {
        node.id
        for node in ast.walk(tree)
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store) and id(node) not in inside
    }
    return {name.id for name in targets if isinstance(name, ast.Name)} - stored


@pytest.fixture
def without_figures(monkeypatch: pytest.MonkeyPatch) -> None:
    """Figures draw nothing here, because nbval runs the notebooks with them."""
    for name in figures.__all__:
        monkeypatch.setattr(figures, name, lambda *_, **__: MagicMock())


@pytest.mark.usefixtures("without_figures")
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda p: p.stem)
def test_a_check_tells_a_solution_from_a_skeleton_and_from_wrong_answers(path: Path) -> None:
    for exercise, answer, text in outcomes(path):
        right, wrong = f"exercise {exercise}: right", f"exercise {exercise}: not yet: "
        if answer == "solution":
            assert text == right
        else:
            assert text.startswith(wrong), f"exercise {exercise}, {answer}: {text}"


@pytest.fixture
def without_extras(monkeypatch: pytest.MonkeyPatch) -> None:
    """The packages of the extra `course` are not installed."""
    hidden, find = ("igl", "clarabel", "glid_check"), importlib.util.find_spec

    def found(name: str, *arguments: Any) -> Any:
        return None if name in hidden else find(name, *arguments)

    monkeypatch.setattr(importlib.util, "find_spec", found)
    for name in hidden:
        monkeypatch.setitem(sys.modules, name, None)


@pytest.mark.usefixtures("without_figures", "without_extras")
@pytest.mark.parametrize(
    ("number", "package", "left_out"),
    [
        ("03", "libigl", "bounded biharmonic weights"),
        ("09", "glid-check", "the check of a proof by another program"),
        ("11", "libigl", "SLIM in the last experiment"),
    ],
)
def test_a_chapter_says_at_its_top_what_it_leaves_out_and_runs_without_it(
    number: str, package: str, left_out: str
) -> None:
    (path,) = FOLDER.glob(f"{number}_*.ipynb")
    namespace: dict[str, Any] = {"__name__": "__main__", "display": lambda *_: None}
    code = [cell.source for cell in cells(path) if cell.cell_type == "code"]
    texts = [printed(source, path.name, namespace) for source in code]
    sentence = f"Without {package}, which is not installed, this chapter leaves out {left_out}. "
    assert texts[1].startswith(sentence)  # after the cell for Colab
    assert "pip install 'glid-nb[course]'" in texts[1]


@pytest.mark.usefixtures("without_extras")
def test_a_chapter_that_cannot_run_without_a_package_says_so_at_its_top() -> None:
    (path,) = FOLDER.glob("10_*.ipynb")
    _, first, *_ = (cell.source for cell in cells(path) if cell.cell_type == "code")
    with pytest.raises(InputError) as refusal:
        printed(first, path.name, {"__name__": "__main__"})
    assert str(refusal.value) == (
        "this chapter needs libigl and clarabel, which are not installed; "
        "run: pip install 'glid-nb[course]', and restart the kernel"
    )


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda p: p.stem)
def test_a_chapter_has_two_or_three_exercises_each_with_a_wrong_answer(path: Path) -> None:
    book = cells(path)
    n = sum(has(cell, "check") for cell in book)
    assert 2 <= n <= 3
    assert sum(has(cell, "exercise") for cell in book) == n
    names = [[name for number, name in answers(path) if number == i] for i in range(1, n + 1)]
    assert all("solution" in of and len(of) >= 2 for of in names)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda p: p.stem)
def test_a_check_assigns_no_name_of_the_chapter(path: Path) -> None:
    book = [cell for cell in cells(path) if cell.cell_type == "code"]
    others = [c.source for c in book if not has(c, "check")]
    tables = [symtable.symtable(source, "cell", "exec") for source in others]
    own = [mentioned(t) - inlined(source) for t, source in zip(tables, others, strict=True)]
    names = set[str]().union(*own)
    for exercise, cell in enumerate((c for c in book if has(c, "check")), 1):
        left = assigned(cell.source) - inlined(cell.source)
        assert not left & names, f"exercise {exercise}"


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda p: p.stem)
def test_the_collapsed_solutions_are_those_that_are_run(path: Path) -> None:
    text = "\n".join(cell.source for cell in cells(path) if cell.cell_type == "markdown")
    shown = [code.strip() for code in _FENCE.findall(text)]
    assert shown == [code for (_, name), code in answers(path).items() if name == "solution"]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda p: p.stem)
def test_a_notebook_is_saved_with_pictures_and_without_widgets(path: Path) -> None:
    book = nbformat.read(path, as_version=4)
    assert "widgets" not in book.metadata  # without its state GitHub refuses to show the notebook
    outputs = [out for cell in book.cells if cell.cell_type == "code" for out in cell.outputs]
    assert any("image/png" in out.get("data", ()) for out in outputs)
    assert not [out for out in outputs if out.output_type == "error" or out.get("name") == "stderr"]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda p: p.stem)
def test_what_is_saved_is_the_skeletons_check(path: Path) -> None:
    saved = [c.outputs[0].text.strip() for c in cells(path) if has(c, "check")]
    assert all(": not yet: " in text for text in saved)
