"""`glid-nb lab`."""

from __future__ import annotations

import os
import shlex
import subprocess
from pathlib import Path
from types import SimpleNamespace

import nbformat
import pytest

from glid_nb.cli import lab


@pytest.fixture
def started(monkeypatch: pytest.MonkeyPatch) -> list[list[str]]:
    """The commands that would have been run."""
    commands: list[list[str]] = []

    def run(command: list[str], check: bool) -> SimpleNamespace:
        assert not check
        commands.append(command)
        return SimpleNamespace(returncode=0)

    monkeypatch.setattr(subprocess, "run", run)
    return commands


def test_it_opens_a_copy_of_the_notebook(run, tmp_path: Path, started: list[list[str]]) -> None:
    folder = tmp_path / "new"
    assert run("lab", folder, "--", "--no-browser").code == 0
    notebook = folder / lab.NOTEBOOK
    cells = nbformat.read(notebook, as_version=4).cells
    assert any("glid.Editor" in cell.source for cell in cells)
    assert started[0][1:] == ["-m", "jupyterlab", str(notebook), "--no-browser"]
    # What somebody wrote there stays.
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
