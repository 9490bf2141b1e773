"""`glid-nb grade`: hand-ins of a small chapter, among them such that cheat or do harm."""

from __future__ import annotations

import csv
import json
import os
import select
import signal
import subprocess
import sys
import tempfile
import textwrap
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from glid_nb._errors import InputError
from glid_nb.cli import main
from glid_nb.course import CALL_JNP
from glid_nb.grading.grade import grade
from glid_nb.grading.handed_in import Grade, HandedIn, chapters_in, handed_in
from glid_nb.grading.tables import canvas, moodle, points, table

pytestmark = pytest.mark.slow  # two processes for each hand-in

NAME = "07_small"
LIMIT = 5.0  # seconds; what hangs, hangs for so long
DOUBLE, COUNT = "def double(x):\n    return ...", "def steps(down):\n    return ..."
CHAPTER = (
    ("setup", "import numpy as np\nfrom glid_nb.course import check\n\nlength = 3", ()),
    ("double", DOUBLE, ("exercise",)),
    (
        "check-1",
        """
        with check("exercise 1"):
            for value in (1.0, np.arange(length), 2j):
                answer = double(value)
                assert answer is not ..., "double returns nothing yet"
                assert np.all(answer == 2 * value), "it is not twice as much"
        """,
        ("check",),
    ),
    ("base", "def base():\n    return 10", ("answer",)),
    ("between", "ten = base()", ()),
    ("steps", COUNT, ("exercise",)),
    (
        "check-2",
        """
        with check("exercise 2"):
            asked = []
            down = lambda t: (asked.append(t), t < ten)[1]
            assert steps(down) == ten, "down(t) is true for t = 0 to ten - 1"
            assert len(asked) == ten + 1, "ask once for each t"
        """,
        ("check",),
    ),
)
RIGHT = {
    "double": "def double(x):\n    return x + x",
    "steps": "def steps(down):\n    t = 0\n    while down(t):\n        t += 1\n    return t",
}


def notebook(changes: dict[str, str | None] | None = None, **cells: str) -> dict[str, Any]:
    """The chapter with other sources of cells; None leaves a cell out."""
    changed = {**(changes or {}), **cells}
    written = []
    for name, source, tags in CHAPTER:
        own = changed.get(name, textwrap.dedent(source).strip())
        if own is not None:
            metadata = {"tags": list(tags)}
            cell = {"cell_type": "code", "id": name, "source": own, "metadata": metadata}
            written.append({**cell, "outputs": [], "execution_count": None})
    return {"cells": written, "metadata": {}, "nbformat": 4, "nbformat_minor": 5}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "course").mkdir()
    (tmp_path / "handed-in").mkdir()
    chapter = tmp_path / "course" / f"{NAME}.ipynb"
    chapter.write_text(json.dumps(notebook()), encoding="utf-8")
    return tmp_path


def hand_in(folder: Path, student: str, book: dict[str, Any]) -> Path:
    own = folder / "handed-in" / student
    own.mkdir()
    path = own / f"{NAME}.ipynb"
    path.write_text(json.dumps(book), encoding="utf-8")
    return path


def graded(folder: Path) -> list[Grade]:
    """The grades of all notebooks that count."""
    grades = [
        grade(each, limit=LIMIT, folder=folder / "handed-in") for each in found_in(folder).counting
    ]
    return [one for own in grades for one in own]


def found_in(folder: Path) -> HandedIn:
    return handed_in(folder / "handed-in", chapters_in(folder / "course"))


def verdicts(grades: Sequence[Grade]) -> list[str]:
    return [one.verdict for one in grades]


@pytest.mark.parametrize(
    "book",
    [
        notebook(),
        notebook(double="# TODO\n" + DOUBLE, steps=COUNT + "  # how?"),
        notebook(double="", steps="# nothing"),
        notebook({"check-1": "print('exercise 1: right')", "check-2": ""}),
    ],
    ids=["untouched", "comments", "cleared", "checks edited"],
)
def test_what_nobody_filled_in_is_untouched(folder: Path, book: dict[str, Any]) -> None:
    hand_in(folder, "ada", book)
    assert verdicts(graded(folder)) == ["untouched", "untouched"]


def test_deleted_cells_are_missing(folder: Path) -> None:
    hand_in(folder, "ada", notebook({"double": None, "steps": None}))
    hand_in(folder, "bob", notebook({"double": None, "steps": RIGHT["steps"]}))
    assert verdicts(graded(folder)) == ["missing", "missing", "missing", "right"]


@pytest.mark.parametrize("lost", [("id", "metadata"), ("metadata",), ("id",)])
def test_cells_without_ids_and_tags_are_found_by_their_functions(
    folder: Path, lost: tuple[str, ...]
) -> None:
    run = {f"check-{n}": f"run_check('checks/{NAME}.py', {n}, globals())" for n in (1, 2)}
    book = notebook(RIGHT | run)
    for cell in book["cells"]:
        cell.update({"metadata": {}} if "metadata" in lost else {})
        if "id" in lost:
            del cell["id"]
    hand_in(folder, "ada", book)
    assert verdicts(graded(folder)) == ["right", "right"]


def test_an_answer_in_a_new_cell_is_found_by_its_function(folder: Path) -> None:
    book = notebook(RIGHT)
    book["cells"][1]["id"] = "typed-again"
    hand_in(folder, "ada", book)
    assert verdicts(graded(folder)) == ["right", "right"]


def test_right_answers_are_right_and_may_use_cells_of_their_own(folder: Path) -> None:
    more = {"base": "def base():\n    return 4 + 8"}  # which the check uses
    book = notebook(RIGHT | more, double="%time 1\ndef double(x):\n    return twice(x)")
    helper = {"cell_type": "code", "id": "mine", "metadata": {}, "outputs": []}
    book["cells"].insert(1, {**helper, "source": "from own import factor"})
    book["cells"].insert(3, {**helper, "id": "too", "source": "def twice(x):\n  return factor * x"})
    path = hand_in(folder, "ada", book)
    (path.parent / "own.py").write_text("factor = 2", encoding="utf-8")
    assert verdicts(graded(folder)) == ["right", "right"]


def test_half_done_wrong_and_crashing_answers(folder: Path) -> None:
    hand_in(folder, "half", notebook(double=RIGHT["double"]))
    wrong = {"double": "def double(x):\n    return x", "steps": "def steps(d:"}
    hand_in(folder, "wrong", notebook(wrong, base="def base():\n    return 1 / 0"))
    grades = graded(folder)
    assert verdicts(grades) == ["right", "untouched", "wrong", "crashed"]
    assert grades[2].text == "it is not twice as much"
    went_on = "the chapter went on with its own cells, because of ZeroDivisionError"
    assert grades[3].text.startswith(went_on)
    assert "; SyntaxError: " in grades[3].text


def test_numpy_where_jax_differentiates_gets_the_hint_of_the_notebook(folder: Path) -> None:
    check = (
        "import jax\nwith check('exercise 1'):\n    assert abs(jax.grad(double)(4.0) - 2) < 1e-6"
    )
    chapter = notebook({"check-1": check})
    (folder / "course" / f"{NAME}.ipynb").write_text(json.dumps(chapter), encoding="utf-8")
    traced = "def double(x):\n    return np.sqrt(4 * x**2)"
    hand_in(folder, "ada", notebook(double=traced))
    hand_in(
        folder, "bob", notebook(double=f"import jax.numpy as jnp\n{traced.replace('np', 'jnp')}")
    )
    one, _, other, _ = graded(folder)
    assert (one.verdict, one.text) == ("wrong", CALL_JNP)
    assert other.verdict == "right"


def test_one_answer_that_never_returns_costs_its_own_time_only(folder: Path) -> None:
    endless = "def double(x):\n    while True:\n        pass"
    hand_in(folder, "ada", notebook(RIGHT, double=endless))
    first, second = graded(folder)
    assert (first.verdict, first.text) == ("too slow", "the answer takes longer than 5 seconds")
    assert second.verdict == "right"


@pytest.mark.skipif(not Path("/proc/self/fd").exists(), reason="the answer opens files of /proc")
def test_a_process_left_behind_that_keeps_the_referees_output_holds_nothing_up(
    folder: Path,
) -> None:
    """It has left the group of processes that is ended, and keeps all pipes of the referee open."""
    os.mkfifo(folder / "held")
    holds = f"""
        import os, threading

        def double(x):
            return x + x

        def keep():
            place = f"/proc/{{referee}}/fd"
            for number in os.listdir(place):
                try:
                    os.open(f"{{place}}/{{number}}", os.O_WRONLY)
                except OSError:
                    pass

        referee = os.getppid()
        if not os.fork():
            os.setsid()
            keep()
            with open({str(folder / "held")!r}, "w") as told:
                told.write(f"{{os.getpid()}}\\n")
            threading.Event().wait()
    """
    told = os.open(folder / "held", os.O_RDONLY | os.O_NONBLOCK)
    hand_in(folder, "ada", notebook(RIGHT, double=textwrap.dedent(holds).strip()))
    since = time.monotonic()
    try:
        assert verdicts(graded(folder)) == ["right", "right"]
        assert time.monotonic() - since < 300, "it waited for the process that was left behind"
    finally:
        select.select([told], [], [], 60)
        os.kill(int(os.read(told, 100)), signal.SIGKILL)
        os.close(told)


def test_a_hand_in_that_deletes_files_harms_only_its_own_copy(folder: Path) -> None:
    harm = "import os\nfor name in os.listdir('.'):\n    os.remove(name)\nos._exit(0)"
    path = hand_in(folder, "ada", notebook(RIGHT, double=harm))
    (path.parent / "mine.png").write_bytes(b"a picture")
    hand_in(folder, "bob", notebook(RIGHT))
    assert verdicts(graded(folder)) == ["crashed", "right", "right", "right"]
    assert (path.parent / "mine.png").exists()
    assert path.exists()


# For the first and the second exercise.
FORGERIES = {
    "prints, and asks for what is not public": (
        "print('exercise 1: right')\ndef double(x):\n    print('exercise 1: right')",
        "def steps(down):\n    return down.__globals__['ten']",
    ),
    "writes to all that is open, and edits the check": (
        """
        import json, os
        line = json.dumps({"exercise": 1, "verdict": "right", "text": ""})
        for number in range(64):
            try:
                os.write(number, (line + "\\n").encode())
            except OSError:
                pass
        def double(x):
            return x
        """,
        """
        import glid_nb.course, contextlib, numpy as np
        @contextlib.contextmanager
        def check(name, seconds=1):
            yield
        glid_nb.course.check = check
        glid_nb.course.report = lambda *_: None
        np.all = lambda *_: True
        def steps(down):
            return 11
        """,
    ),
    "is equal to everything, and ends with success": (
        """
        class Equal:
            __array_priority__ = 100
            def __eq__(self, other):
                return True
        def double(x):
            return Equal()
        """,
        "import sys\nsys.exit(0)",
    ),
    "sends code": (
        """
        import glid_nb.grading.student as student
        student.encoded = lambda *_: {"is": "pickle", "bytes": "Y29zCnN5c3RlbQou"}
        def double(x):
            return x
        """,
        "def steps(down):\n    return 10",
    ),
}


@pytest.mark.parametrize("name", FORGERIES)
def test_a_verdict_cannot_be_forged_from_the_notebook(folder: Path, name: str) -> None:
    double, steps = (textwrap.dedent(code).strip() for code in FORGERIES[name])
    hand_in(folder, "eve", notebook(double=double, steps=steps))
    assert set(verdicts(graded(folder))) <= {"wrong", "crashed"}


def test_the_command_prints_a_table_and_writes_csv(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    hand_in(folder, "=ada", notebook(double=RIGHT["double"]))
    to = {name: folder / f"{name}.csv" for name in ("csv", "moodle", "canvas")}
    words = [word for name, path in to.items() for word in (f"--{name}", str(path))]
    place = str(folder / "handed-in")
    assert main(["grade", place, "--chapters", str(folder / "course"), *words]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[:4] for line in lines] == [
        ["student", "exercise", "verdict"],
        ["=ada", NAME, "1", "right"],
        ["=ada", NAME, "2", "untouched"],
    ]
    rows = {name: list(csv.DictReader(path.read_text().splitlines())) for name, path in to.items()}
    assert [row["verdict"] for row in rows["csv"]] == ["right", "untouched"]
    assert rows["moodle"][0] | {"Feedback": ""} == {"Username": "'=ada", NAME: "1", "Feedback": ""}
    assert [row[NAME] for row in rows["canvas"]] == ["2", "1"]
    assert rows["canvas"][1]["SIS Login ID"] == "'=ada"  # no formula


def test_the_command_lists_students_without_a_notebook(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    hand_in(folder, "ada", notebook())
    (folder / "handed-in" / "bob").mkdir()
    place, to = str(folder / "handed-in"), folder / "moodle.csv"
    chapters = str(folder / "course")
    assert main(["grade", place, "--chapters", chapters, "--moodle", str(to)]) == 0
    last = capsys.readouterr().out.splitlines()[-1]
    assert last.split(maxsplit=2) == ["bob", "missing", "the folder has no notebook"]
    rows = list(csv.DictReader(to.read_text().splitlines()))
    wanted = {"Username": "bob", NAME: "", "Feedback": "the folder has no notebook"}
    assert rows[1] == wanted


@pytest.mark.skipif(os.name != "posix", reason="elsewhere no handler runs when a process is ended")
def test_ending_the_command_ends_the_answer_and_lines_before_are_printed(
    folder: Path,
) -> None:
    hand_in(folder, "ada", notebook())
    alive = folder / "alive"
    os.mkfifo(alive)  # its other end is open as long as the answer's process lives
    forever = f"""
        def double(x):
            import threading
            with open({str(alive)!r}, "w") as told:
                told.write("begun\\n")
                told.flush()
                threading.Event().wait()
    """
    hand_in(folder, "bob", notebook(double=textwrap.dedent(forever).strip()))
    to = folder / "grades.csv"
    words = ["--chapters", str(folder / "course"), "--limit", "300", "--csv", str(to)]
    command = [sys.executable, "-m", "glid_nb", "grade", str(folder / "handed-in"), *words]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        with alive.open() as told:
            assert told.readline() == "begun\n"
            process.terminate()
            ended, _, _ = select.select([told], [], [], 60)
            assert ended, "the answer still runs"
            assert told.read() == ""
        out, _ = process.communicate()
    assert process.returncode == 128 + signal.SIGTERM
    assert [line.split()[0] for line in out.splitlines()] == ["student", "ada", "ada"]
    assert [row["student"] for row in csv.DictReader(to.read_text().splitlines())] == ["ada", "ada"]


def test_students_are_named_by_folders_or_by_files(folder: Path) -> None:
    for path in (f"ada/{NAME}.ipynb", f"bob/assignment/{NAME}.ipynb", f"cy_{NAME}.ipynb"):
        to = folder / "handed-in" / path
        to.parent.mkdir(parents=True, exist_ok=True)
        to.write_text(json.dumps(notebook()), encoding="utf-8")
    moodles = folder / "handed-in" / "Dee Doe_123_assignsubmission_file_"
    moodles.mkdir()
    (moodles / f"{NAME}(1).ipynb").write_text(json.dumps(notebook()), encoding="utf-8")
    found = found_in(folder).counting
    assert sorted(one.student for one in found) == ["Dee Doe", "ada", "bob", "cy"]


def test_the_second_half_of_a_chapter_is_a_chapter_of_its_own(folder: Path) -> None:
    """Such as 09b beside 09."""
    for name in ("07b_small", "other"):
        (folder / "course" / f"{name}.ipynb").write_text(json.dumps(notebook()), encoding="utf-8")
    chapters = chapters_in(folder / "course")
    assert list(chapters) == [NAME, "07b_small"]
    for name in chapters:
        path = folder / "handed-in" / f"ada_{name}.ipynb"
        path.write_text(json.dumps(notebook()), encoding="utf-8")
    found = handed_in(folder / "handed-in", chapters).counting
    assert {(one.student, one.chapter.name) for one in found} == {
        ("ada", name) for name in chapters
    }


def test_a_folder_without_any_chapter_is_refused(folder: Path) -> None:
    (folder / "handed-in" / "poem.ipynb").write_text("{}", encoding="utf-8")
    with pytest.raises(InputError, match=r"poem\.ipynb: its name contains no chapter such as 07_s"):
        found_in(folder)


@pytest.mark.parametrize(
    "text", ["not JSON", "[]", "3", "null", '{"cells": 3}', "[" * 200_000, "", "9" * 5000]
)
def test_a_file_that_is_no_notebook_is_graded_too(folder: Path, text: str) -> None:
    (folder / "handed-in" / f"ada_{NAME}.ipynb").write_text(text, encoding="utf-8")
    (folder / "handed-in" / "homework.ipynb").write_text(text, encoding="utf-8")
    found = found_in(folder)
    assert [(one.student, one.verdict) for one in found.others] == [("homework", "left out")]
    grades = graded(folder)
    assert verdicts(grades) == ["crashed", "crashed"]
    assert grades[0].text.startswith("the file is no notebook: ")


@pytest.mark.parametrize("deep", ["-" * 100_000 + "1", "(" * 5000, "+".join("1" * 50_000)])
def test_an_answer_that_python_cannot_read_crashes_alone(folder: Path, deep: str) -> None:
    hand_in(folder, "ada", notebook(RIGHT, double=f"x = {deep}"))
    assert verdicts(graded(folder)) == ["crashed", "right"]


def test_whatever_goes_wrong_with_one_hand_in_stops_no_other(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    hand_in(folder, "ada", notebook(RIGHT))
    hand_in(folder, "bob", notebook())

    def no_space(*_: Any, **__: Any) -> None:
        raise OSError(28, "no space left on the disk")

    monkeypatch.setattr(tempfile, "TemporaryDirectory", no_space)
    grades = graded(folder)
    assert verdicts(grades) == ["crashed", "crashed", "untouched", "untouched"]
    assert grades[0].text == "grading it raises OSError: [Errno 28] no space left on the disk"


@pytest.mark.skipif(os.name != "posix" or os.geteuid() == 0, reason="root reads all files")
def test_a_file_that_cannot_be_read_crashes_alone(folder: Path) -> None:
    hand_in(folder, "ada", notebook(RIGHT)).chmod(0)
    hand_in(folder, "bob", notebook())
    grades = graded(folder)
    assert verdicts(grades) == ["crashed", "crashed", "untouched", "untouched"]
    assert grades[0].text == "it cannot be read: Permission denied"


def test_folders_and_hidden_files_are_no_notebooks(folder: Path) -> None:
    hand_in(folder, "ada", notebook())
    for name in (f"{NAME}.ipynb", "bob/.ipynb_checkpoints"):
        (folder / "handed-in" / name).mkdir(parents=True)
    for name in (f"ada/._{NAME}.ipynb", f"bob/.ipynb_checkpoints/{NAME}-checkpoint.ipynb"):
        (folder / "handed-in" / name).write_text("of an archive", encoding="utf-8")
    found = found_in(folder)
    assert [one.student for one in found.counting] == ["ada"]
    assert [(one.student, one.verdict) for one in found.others] == [
        (f"{NAME}.ipynb", "missing"),
        ("bob", "missing"),
    ]


def test_a_notebook_of_no_chapter_is_a_line_for_its_student(folder: Path) -> None:
    hand_in(folder, "ada", notebook())
    for student in ("ada", "bob"):
        scratch = folder / "handed-in" / student / "scratch.ipynb"
        scratch.parent.mkdir(exist_ok=True)
        scratch.write_text(json.dumps(notebook()), encoding="utf-8")
    found = found_in(folder)
    assert [one.student for one in found.counting] == ["ada"]
    reason = f"scratch.ipynb: its name contains no chapter such as {NAME}"
    assert found.others == tuple(Grade(n, "", 0, "left out", reason) for n in ("ada", "bob"))


def test_of_copies_of_a_notebook_one_counts_and_the_table_names_the_others(folder: Path) -> None:
    own = hand_in(folder, "anna", notebook(RIGHT))
    for name in (f"{NAME}-Copy1.ipynb", f"my_{NAME}.ipynb"):
        own.with_name(name).write_bytes(own.read_bytes())
    grades = [*graded(folder), *found_in(folder).others]
    assert points(grades) == {"anna": {NAME: 2}}
    assert [one.text for one in grades if one.verdict == "left out"] == [
        f"{name}: {NAME}.ipynb counts instead"
        for name in (f"my_{NAME}.ipynb", f"{NAME}-Copy1.ipynb")
    ]
    (row,) = csv.DictReader(moodle(grades).splitlines())
    assert f"{NAME}-Copy1.ipynb: {NAME}.ipynb counts instead" in row["Feedback"]


def test_of_copies_with_other_names_the_newest_counts(folder: Path) -> None:
    old = hand_in(folder, "anna", notebook())
    old = old.rename(old.with_name(f"{NAME} (1).ipynb"))
    new = old.with_name(f"{NAME} (2).ipynb")
    new.write_bytes(old.read_bytes())
    for path, time_of in ((old, 2e9), (new, 1e9)):
        os.utime(path, (time_of, time_of))
    assert [one.path for one in found_in(folder).counting] == [old]
    os.utime(new, (3e9, 3e9))
    assert [one.path for one in found_in(folder).counting] == [new]


def test_two_students_of_one_name_in_moodle_are_two_students(folder: Path) -> None:
    names = [f"Dee Doe_{n}_assignsubmission_file_" for n in (12, 34)]
    for name in names:
        hand_in(folder, name, notebook())
    assert [one.student for one in found_in(folder).counting] == names


@pytest.mark.skipif(os.name != "posix", reason="elsewhere not everybody can make links")
def test_links_are_not_followed(folder: Path) -> None:
    path = hand_in(folder, "anna", notebook(RIGHT))
    (folder / "handed-in" / "zoe").mkdir()
    (folder / "handed-in" / "zoe" / path.name).symlink_to(path)
    (folder / "handed-in" / "yan").symlink_to(path.parent)
    (folder / "handed-in" / "xia").mkdir()
    (folder / "handed-in" / "xia" / "work").symlink_to(path.parent)
    found = found_in(folder)
    assert [one.student for one in found.counting] == ["anna"]
    reason = "it is a link, and links are not followed"
    assert [(one.student, one.verdict, one.text) for one in found.others] == [
        ("xia", "left out", f"work: {reason}"),
        ("yan", "left out", f"yan: {reason}"),
        ("zoe", "left out", f"{path.name}: {reason}"),
    ]


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16"])
def test_a_byte_order_mark_and_capitals_in_a_name_do_no_harm(folder: Path, encoding: str) -> None:
    own = folder / "handed-in" / "ada"
    own.mkdir()
    book = json.dumps(notebook({"double": "# größer\n" + DOUBLE}), ensure_ascii=False)
    (own / f"{NAME.upper()}.IPYNB").write_text(book, encoding=encoding)
    (one,) = found_in(folder).counting
    assert (one.student, one.chapter.name) == ("ada", NAME)
    assert verdicts(graded(folder)) == ["untouched", "untouched"]


def test_half_a_surrogate_pair_in_a_reason_is_replaced_in_all_files(folder: Path) -> None:
    harm = 'def double(x):\n    raise ValueError("\\ud800 x")'
    hand_in(folder, "ada", notebook(double=harm))
    to = {name: folder / f"{name}.csv" for name in ("csv", "moodle", "canvas")}
    words = [word for name, path in to.items() for word in (f"--{name}", str(path))]
    place = str(folder / "handed-in")
    assert main(["grade", place, "--chapters", str(folder / "course"), *words]) == 0
    first, _ = csv.DictReader(to["csv"].read_text(encoding="utf-8").splitlines())
    assert (first["verdict"], first["text"]) == ("crashed", "ValueError: ? x")
    assert all(path.exists() for path in to.values())


@pytest.mark.parametrize("flag", ["csv", "moodle", "canvas"])
def test_standard_output_is_refused_for_files(
    folder: Path, flag: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(folder)
    hand_in(folder, "ada", notebook())
    assert main(["grade", "handed-in", "--chapters", "course", f"--{flag}", "-"]) == 1
    assert "the table is printed there, so name a file" in capsys.readouterr().err
    assert not (folder / "-").exists()


@pytest.mark.parametrize("limit", ["1e300", "86401"])
def test_a_limit_is_at_most_a_day(limit: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["grade", ".", "--limit", limit])
    assert "a limit is at most 86400 seconds, which is a day" in capsys.readouterr().err


def test_tables_print_no_control_characters() -> None:
    grades = [Grade("a\x1b[2Jda", NAME, 1, "wrong", "x\ny")]
    assert "\x1b" not in table(grades)
    assert moodle(grades).splitlines()[0] == f"Username,{NAME},Feedback"
    assert canvas(grades, {NAME: 2}).splitlines()[1].startswith("    Points Possible,")
