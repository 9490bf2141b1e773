"""Consoles and locales without UTF-8: no printed text ends a command."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow  # each run imports the modules that trace a picture

# A console of Windows in western Europe, and a server without a locale.
CONSOLES = {
    "cp1252": {"PYTHONIOENCODING": "cp1252", "PYTHONUTF8": "0"},
    "cp1252, strict": {"PYTHONIOENCODING": "cp1252:strict", "PYTHONUTF8": "0"},
    "ascii": {"PYTHONIOENCODING": "ascii", "PYTHONUTF8": "0"},
    "LC_ALL=C": {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"},
}


def glid_nb(*words: object, folder: Path, **variables: str) -> subprocess.CompletedProcess[bytes]:
    """Run the command line as a console does."""
    command = [sys.executable, "-m", "glid_nb", *map(str, words)]
    kept = {k: v for k, v in os.environ.items() if not k.startswith(("LC_", "LANG", "PYTHON"))}
    environment = {**kept, **variables}
    return subprocess.run(
        command, cwd=folder, env=environment, capture_output=True, timeout=200, check=False
    )


@pytest.mark.parametrize("console", CONSOLES)
def test_a_console_that_lacks_a_sign_shows_an_escape(
    console: str, picture: Path, tmp_path: Path
) -> None:
    named = tmp_path / "σ₂ 🦎.png"
    picture.rename(named)
    done = glid_nb("trace", named, "--out", "Käfig 🦎.json", folder=tmp_path, **CONSOLES[console])
    assert done.returncode == 0, done.stderr
    assert b"vertices" in done.stdout
    assert b"\\" in done.stdout
    assert json.loads((tmp_path / "Käfig 🦎.json").read_text(encoding="utf-8"))["cage"]


@pytest.mark.parametrize("console", CONSOLES)
def test_an_error_about_such_a_name_is_one_line(console: str, tmp_path: Path) -> None:
    done = glid_nb("trace", "σ₂ 🦎.png", "--out", "a.json", folder=tmp_path, **CONSOLES[console])
    assert done.returncode == 1
    assert done.stderr.startswith(b"glid-nb: error: ")
    assert done.stderr.count(b"\n") == 1


@pytest.mark.parametrize("command", [(), ("demo",), ("solve",), ("animate",), ("render",)])
def test_every_help_can_be_printed(command: tuple[str, ...], tmp_path: Path) -> None:
    done = glid_nb(*command, "--help", folder=tmp_path, **CONSOLES["ascii"])
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith(b"usage: ")


@pytest.mark.skipif(os.name == "nt", reason="names are text there")
def test_a_name_that_is_no_text_is_printed_too(picture: Path, tmp_path: Path) -> None:
    name = os.fsdecode(b"caf\xe9.png")
    picture.rename(tmp_path / name)
    words = (name, "--out", os.fsdecode(b"caf\xe9.json"))
    done = glid_nb("trace", *words, folder=tmp_path, PYTHONIOENCODING="utf-8:strict")
    assert done.returncode == 0, done.stderr
    assert b"caf\\udce9.json" in done.stdout
