"""Bad input is reported in one line; bugs keep their traceback."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from glid_nb.cli import samples
from glid_nb.cli.main import main
from glid_nb.cli.output import BAD_INPUT, one_line
from glid_nb.geometry import GeometryError


def test_the_packages_own_refusals_are_bad_input() -> None:
    assert isinstance(GeometryError("hole 1 touches hole 2"), BAD_INPUT)
    assert isinstance(FileNotFoundError(2, "No such file", "x.png"), BAD_INPUT)


def test_other_errors_are_bugs() -> None:
    assert not isinstance(ValueError("operands could not be broadcast together"), BAD_INPUT)
    assert not isinstance(TypeError("unsupported operand"), BAD_INPUT)


def test_a_system_error_names_the_file_first() -> None:
    error = FileNotFoundError(2, "No such file or directory", "x.json")
    assert one_line(error) == "x.json: No such file or directory"


def test_a_message_of_several_lines_becomes_one() -> None:
    assert one_line(GeometryError("hole 1\n  touches hole 2\n")) == "hole 1 touches hole 2"


def test_a_bug_keeps_its_traceback(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(_: object) -> None:
        raise ValueError("a bug")

    monkeypatch.setattr(samples, "run", broken)
    with pytest.raises(ValueError, match="a bug"):
        main(["samples"])


@pytest.fixture
def refusing(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(_: object) -> None:
        raise GeometryError("hole 1 touches hole 2")

    monkeypatch.setattr(samples, "run", refuse)


@pytest.mark.usefixtures("refusing")
def test_bad_input_is_one_line_and_exit_code_1(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["samples"]) == 1
    out, err = capsys.readouterr()
    assert out == ""
    assert err == "glid-nb: error: hole 1 touches hole 2\n"


@pytest.mark.usefixtures("refusing")
def test_debug_shows_the_traceback() -> None:
    with pytest.raises(GeometryError, match="hole 1 touches hole 2"):
        main(["samples", "--debug"])


def test_an_interrupt_is_said_quietly(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def interrupted(_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(samples, "run", interrupted)
    assert main(["samples"]) == 130
    assert "interrupted" in capsys.readouterr().err


@pytest.mark.slow
def test_a_home_that_cannot_be_written_costs_one_warning_and_not_the_map(
    tmp_path: Path, problem_data: dict[str, Any]
) -> None:
    problem, home = tmp_path / "problem.json", tmp_path / "home"
    problem.write_text(json.dumps(problem_data), encoding="utf-8")
    home.write_text("not a folder", encoding="utf-8")  # root could write into any folder
    unset = ("GLID_NB_CACHE", "XDG_CACHE_HOME", "JAX_COMPILATION_CACHE_DIR")
    environment = {k: v for k, v in os.environ.items() if k not in unset} | {"HOME": str(home)}
    words = ("solve", str(problem), "--out", str(tmp_path / "map.json"))
    done = subprocess.run(
        [sys.executable, "-m", "glid_nb", *words],
        env=environment,
        capture_output=True,
        text=True,
        timeout=200,
    )
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "map.json").is_file()
    (told,) = [line for line in done.stderr.splitlines() if "warning" in line.lower()]
    assert told.startswith("glid-nb: warning: compiled programs are not kept")
    assert "GLID_NB_CACHE" in told
