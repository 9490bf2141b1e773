"""`glid-nb lab`."""

from __future__ import annotations

import os
import shlex
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import nbformat
import pytest

from glid_nb.cli import lab


@pytest.fixture
def started(monkeypatch: pytest.MonkeyPatch) -> list[list[str]]:
    """The commands that would have been run."""
    commands: list[list[str]] = []

    monkeypatch.setattr(lab, "become", commands.append)
    return commands


def test_it_opens_a_copy_of_the_notebook(run, tmp_path: Path, started: list[list[str]]) -> None:
    folder = tmp_path / "new"
    assert run("lab", folder, "--", "--no-browser").code == 0
    notebook = folder / lab.NOTEBOOK
    cells = nbformat.read(notebook, as_version=4).cells
    assert any("glid.Editor" in cell.source for cell in cells)
    assert started[0][1:] == ["-m", "jupyterlab", str(notebook), "--no-browser"]
    # A file that somebody wrote there stays.
    notebook.write_text("mine")
    assert run("lab", folder).code == 0
    assert notebook.read_text() == "mine"


def test_printing_the_command_makes_nothing(run, tmp_path: Path, started: list[list[str]]) -> None:
    outcome = run("lab", tmp_path / "new", "--print")
    assert outcome.code == 0
    assert "-m jupyterlab" in outcome.out
    assert not (tmp_path / "new").exists()
    assert not started


def test_the_printed_command_can_be_pasted_into_a_shell(run, tmp_path: Path) -> None:
    folder = tmp_path / "my own folder"
    words = shlex.split(run("lab", folder, "--print").out, posix=os.name == "posix")
    assert words[1:3] == ["-m", "jupyterlab"]
    assert words[3].strip('"') == str(folder / lab.NOTEBOOK)


def test_without_jupyterlab_it_says_what_to_install(
    run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda _: None)
    outcome = run("lab", tmp_path)
    assert outcome.code == 1
    assert "pip install 'glid-nb[lab]'" in outcome.err


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="elsewhere a process of its own is started")
def test_the_server_takes_the_place_of_the_command() -> None:
    """A terminal that closes, or a supervisor, ends the server, too."""
    server = [sys.executable, "-c", "import os; print(os.getpid())"]
    code = f"from glid_nb.cli.lab import become; become({server!r})"
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE) as command:
        assert command.stdout is not None
        assert int(command.stdout.read()) == command.pid


def test_where_no_process_can_be_replaced_the_exit_code_is_told(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(lab, "os", SimpleNamespace(name="nt"))
    with pytest.raises(lab.InputError, match="exit code 3"):
        lab.become([sys.executable, "-c", "raise SystemExit(3)"])
