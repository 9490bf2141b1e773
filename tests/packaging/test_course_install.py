"""The chapters, in an environment made by the line on the course's page."""

from __future__ import annotations

import os
import re
import shutil
import sys
import tomllib
from pathlib import Path

import pytest
from filelock import FileLock

from .environments import CHECKOUT, copy_of_the_checkout, run

PAGE = CHECKOUT / "docs" / "course.md"
LECTURERS = CHECKOUT / "docs" / "lecturers.md"
CHAPTERS = sorted((CHECKOUT / "notebooks").glob("[0-9][0-9]*_*.ipynb"))


def commands() -> list[str]:
    """The lines of the page's first block for a shell."""
    block = re.search(r"```sh\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    assert block is not None
    return block[1].splitlines()


def extras() -> dict[str, list[str]]:
    settings = tomllib.loads((CHECKOUT / "pyproject.toml").read_text(encoding="utf-8"))
    return settings["project"]["optional-dependencies"]


def parts_of_course() -> set[str]:
    """The extras that the extra `course` consists of."""
    names = re.search(r"glid-nb\[(.*?)\]", " ".join(extras()["course"]))
    assert names is not None
    return set(names[1].split(","))


def test_every_page_names_the_same_extra() -> None:
    assert sum("-e ./checker -e '.[course]'" in line for line in commands()) == 1
    assert "pip install 'glid-nb[course]'" in LECTURERS.read_text(encoding="utf-8")
    binder = (CHECKOUT / "binder" / "requirements.txt").read_text(encoding="utf-8")
    assert "--extra course" in binder
    # The pins that the parts of the extra bring.
    for name in ("jupyterlab", "libigl", "clarabel", "python-flint", "nbval"):
        assert re.search(rf"^{name}==", binder, re.MULTILINE)


def test_colab_gets_all_of_the_extra_but_the_server_that_it_has() -> None:
    page = (CHECKOUT / "docs" / "howto" / "hosts.md").read_text(encoding="utf-8")
    named = re.search(r"%pip install .*glid-nb\[(.*?)\]", page)
    assert named is not None
    assert set(named[1].split(",")) == parts_of_course() - {"lab"}


@pytest.fixture(scope="session")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the checkout after the page's lines, except the last one, which opens Lab.

    The first process that wants it makes it; the others wait and share it.
    """
    folder = tmp_path_factory.getbasetemp()
    if "PYTEST_XDIST_WORKER" in os.environ:
        folder = folder.parent
    copy, done = folder / "course", folder / "course-is-installed"
    with FileLock(folder / "course.lock"):
        if not done.exists():
            install(copy)
            done.touch()
    return copy


def install(folder: Path) -> None:
    shutil.rmtree(folder, ignore_errors=True)  # of another process, which failed
    copy = copy_of_the_checkout(folder)
    *lines, last = commands()
    assert last == ".venv/bin/jupyter lab notebooks"
    # `python3` is the Python that runs the tests.
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    for line in lines:
        run("sh", "-c", line, folder=copy, PATH=path)


@pytest.mark.install
@pytest.mark.timeout(900)
def test_the_line_of_the_page_brings_jupyterlab(installed: Path) -> None:
    assert run(installed / ".venv/bin/jupyter", "lab", "--version", folder=installed)


@pytest.mark.install
@pytest.mark.timeout(900)
@pytest.mark.parametrize("path", CHAPTERS, ids=lambda path: path.stem)
def test_a_chapter_runs_and_prints_what_it_printed_when_it_was_saved(
    installed: Path, path: Path
) -> None:
    """By nbval, like the lecturers' page, without the settings of our own tests."""
    (installed / "empty.ini").write_text("[pytest]\n", encoding="utf-8")
    python, notebook = installed / ".venv/bin/python", Path("notebooks") / path.name
    nbval = ("-m", "pytest", "-c", "empty.ini", "-p", "no:cacheprovider", "--nbval", notebook)
    # What other tests have compiled is the same here.
    cache = os.environ["GLID_NB_CACHE"]
    run(python, *nbval, folder=installed, GLID_NB_CACHE=cache)
