"""The course: saved notebooks, and the checks of the exercises.

A chapter's cells are run once, in one namespace and without figures. Each check is run on the
skeleton, the solution and the wrong answers of `notebooks/solutions`.
"""

from __future__ import annotations

import ast
import contextlib
import importlib.util
import io
import json
import re
import symtable
import sys
from pathlib import Path
from typing import Any, NamedTuple
from unittest.mock import MagicMock

import nbformat
import pytest

from glid_nb import InputError, figures
from glid_nb.grading.chapters import Cell
from glid_nb.grading.grade import grade
from glid_nb.grading.handed_in import Chapter, HandIn
from glid_nb.grading.referee import Remote, Student, StudentError
from glid_nb.grading.student import Link

FOLDER = Path(__file__).parents[2] / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("[0-9][0-9]*_*.ipynb"))
# Exercises with fewer than three right answers and five wrong ones: each answer costs seconds.
FEWER = {("02", 1): (2, 4), ("03", 3): (2, 5), ("06", 3): (1, 3), ("08", 3): (2, 5)}
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


class Nearby(Student):
    """The process of the answers, in this one. Messages are written as JSON and read again."""

    def __init__(self, namespace: dict[str, Any]) -> None:
        super().__init__(Path(), 60)
        self.link = Link(io.BytesIO(), io.BytesIO())
        self.link.namespace = namespace
        self.link.ask = self.asked

    def request(self, message: dict[str, Any]) -> Any:
        try:
            return json.loads(json.dumps(self.link.done(json.loads(json.dumps(message)))))
        except Exception as error:
            raise StudentError(f"{type(error).__name__}: {error}") from error

    def asked(self, request: dict[str, Any]) -> Any:
        reply = json.loads(json.dumps(self.served(json.loads(json.dumps(request)))))
        assert "raise" not in reply, reply
        return self.link.decoded(reply["value"])


def outcome_from_afar(code: str, check: str, namespace: dict[str, Any]) -> str:
    """What a check prints if, as in `glid-nb grade`, only values come from the answer."""
    theirs, tried = dict(namespace), dict(namespace)
    printed(code, "answer", theirs)
    for name in Cell("", code).functions:
        tried[name] = Remote(Nearby(theirs), name)
    return printed(check, "check", tried)


def outcomes(path: Path) -> tuple[Outcome, ...]:
    """Run a chapter up to its last check, and each check on the skeleton and all answers.

    After a check the chapter goes on with the exercise's solution.
    """
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
        from_afar = outcome_from_afar(known[exercise, "solution"], cell.source, namespace)
        found.append(Outcome(exercise, "right: the solution, from afar", from_afar))
        for (number, name), code in known.items():
            if number == exercise:
                tried = dict(namespace)
                printed(code, path.name, tried)
                found.append(Outcome(exercise, name, printed(cell.source, path.name, tried)))
        printed(known[exercise, "solution"], path.name, namespace)  # what follows may use it
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
        if answer == "solution" or answer.startswith("right: "):
            assert text == right, f"exercise {exercise}, {answer}: {text}"
        else:
            assert text.startswith(wrong), f"exercise {exercise}, {answer}: {text}"
            assert "your code raises" not in text, f"exercise {exercise}, {answer}: {text}"


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
        ("09b", "glid-check", "the check of a proof by another program"),
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
    assert texts[0].startswith(sentence)
    assert "pip install 'glid-nb[course]'" in texts[0]


@pytest.mark.usefixtures("without_extras")
def test_a_chapter_that_cannot_run_without_a_package_says_so_at_its_top() -> None:
    (path,) = FOLDER.glob("10_*.ipynb")
    first, *_ = (cell.source for cell in cells(path) if cell.cell_type == "code")
    with pytest.raises(InputError) as refusal:
        printed(first, path.name, {"__name__": "__main__"})
    assert str(refusal.value) == (
        "this chapter needs libigl and clarabel, which are not installed; "
        "run: pip install 'glid-nb[course]', and restart the kernel"
    )


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda p: p.stem)
def test_a_chapter_has_two_or_three_exercises_each_with_right_and_wrong_answers(path: Path) -> None:
    book = cells(path)
    n = sum(has(cell, "check") for cell in book)
    assert 2 <= n <= 3
    assert sum(has(cell, "exercise") for cell in book) == n
    for exercise in range(1, n + 1):
        names = [name for number, name in answers(path) if number == exercise]
        right = [name for name in names if name == "solution" or name.startswith("right: ")]
        least = FEWER.get((path.stem.partition("_")[0], exercise), (3, 5))
        assert "solution" in right
        assert len(right) >= least[0], f"exercise {exercise} has {len(right)} right answers"
        assert len(names) - len(right) >= least[1], f"exercise {exercise}: too few wrong answers"


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
def test_an_exercise_left_out_leaves_nothing_out_for_the_others(path: Path) -> None:
    """`glid-nb grade` runs neither an untouched exercise nor its check.

    So no other cell reads what a check leaves, or what an exercise's cell imports.
    """
    book = [cell for cell in cells(path) if cell.cell_type == "code"]
    for cell in book:
        if has(cell, "check"):
            left = assigned(cell.source) - inlined(cell.source)
        elif has(cell, "exercise"):
            left = assigned(cell.source) - set(Cell("", cell.source).functions)
        else:
            continue
        for other in book:
            if other is not cell:
                table = symtable.symtable(other.source, "cell", "exec")
                read = mentioned(table) - assigned(other.source) - inlined(other.source)
                assert not left & read, f"{other.id} reads what {cell.id} leaves"


@pytest.mark.parametrize("left_out", [1, 2, 3])
def test_the_other_exercises_of_chapter_05_are_graded_if_one_is_left_out(left_out: int) -> None:
    (path,) = FOLDER.glob("05_*.ipynb")
    text = path.read_text(encoding="utf-8")
    handed_in = json.loads(text)
    number = 0
    for cell in handed_in["cells"]:
        if "exercise" in cell["metadata"].get("tags", ()):
            number += 1
            if number != left_out:
                cell["source"] = answers(path)[number, "solution"]
    hand_in = HandIn("ada", Chapter(path.stem, text), path, json.dumps(handed_in))
    grades = list(grade(hand_in, limit=60, folder=path.parent))
    wanted = ["untouched" if i == left_out else "right" for i in (1, 2, 3)]
    assert [one.verdict for one in grades] == wanted, grades


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


def test_the_project_goes_on_with_the_students_own_picture_and_pose() -> None:
    """All that chapter 13 certifies and hands in comes from `my_picture` and `my_pose`."""
    (path,) = FOLDER.glob("13_*.ipynb")
    code = [cell for cell in cells(path) if cell.cell_type == "code"]
    (posed,) = (i for i, cell in enumerate(code) if "def my_pose" in cell.source)
    later = [cell.source for cell in code[posed + 1 :] if not has(cell, "check")]
    names = set[str]().union(*(mentioned(symtable.symtable(c, "cell", "exec")) for c in later))
    assert "my_pose" in names
    assert not names & {"first", "suggested"}
    before = "\n".join(cell.source for cell in code[:posed])
    assert "image = my_picture()" in before
    assert before.count("glid.samples.image") == 1  # inside my_picture


def test_chapter_07_counts_the_null_space_with_and_without_redundant_unknowns() -> None:
    (path,) = FOLDER.glob("07_*.ipynb")
    (cell,) = (cell for cell in cells(path) if cell.id == "cell-19-count")
    counted = re.findall(r"(\d) handles? +(\d+) of (\d+) +(\d+) of (\d+)", cell.outputs[0].text)
    table = [tuple(map(int, row)) for row in counted]
    stopped = [(0, 4, 148, 2, 146), *((n, 2, 148, 0, 146) for n in (1, 2, 4))]
    # At rest a turn of the whole shape costs nothing either.
    at_rest = [(0, 5, 148, 3, 146), (1, 3, 148, 1, 146), *((n, 2, 148, 0, 146) for n in (2, 4))]
    assert table == stopped + at_rest
