"""How bad input is refused."""

from __future__ import annotations

import ast
import os
import subprocess
import sys
from pathlib import Path

import pytest

import glid_nb
from glid_nb._errors import InputError, InputFileError, about, did_you_mean
from glid_nb.geometry import GeometryError
from glid_nb.harmonic import MapError
from glid_nb.imaging import TraceError
from glid_nb.pose import PoseError
from glid_nb.session.document import DocumentError

PACKAGE = Path(glid_nb.__file__).parent


@pytest.mark.slow
def test_every_refusal_of_the_package_is_an_input_error() -> None:
    """A plain ValueError is a bug. The command line tells the two apart by the class."""
    strangers = [
        f"{path.relative_to(PACKAGE)}: {node.name}"
        for path in PACKAGE.rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.ClassDef) and "ValueError" in map(ast.unparse, node.bases)
    ]
    assert strangers == ["_errors.py: InputError"]


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("the key 'phi' is missing", "a.json: the key 'phi' is missing"),
        ("a.json is not a JSON file", "a.json is not a JSON file"),
        ("a.json: phi[0] is nan", "a.json: phi[0] is nan"),
        ("a.jsonx is another file", "a.json: a.jsonx is another file"),
    ],
)
def test_the_place_stands_in_front_once(text: str, named: str) -> None:
    with pytest.raises(InputFileError) as refusal, about(Path("a.json")):
        raise InputError(text)
    assert str(refusal.value) == named


@pytest.mark.parametrize(
    "kind", [InputFileError, GeometryError, TraceError, MapError, PoseError, DocumentError]
)
def test_the_place_stands_in_front_of_an_error_of_any_kind(kind: type[InputError]) -> None:
    with pytest.raises(kind) as refusal, about("the cage", kind):
        raise InputError("hole 1 is open", "the hole is open")
    assert str(refusal.value) == "the cage: hole 1 is open"
    assert refusal.value.plain == "the cage: the hole is open"


def test_a_bug_is_left_alone() -> None:
    with pytest.raises(ZeroDivisionError), about("a.json"):
        _ = 1 / 0


def test_a_name_that_is_near_is_offered() -> None:
    assert did_you_mean("holse", ("cage", "holes")) == "; did you mean 'holes'?"
    assert did_you_mean("q", ("cage", "holes")) == ""


@pytest.mark.slow
def test_ipython_prints_the_line_of_the_cell_and_one_sentence(tmp_path: Path) -> None:
    """Neither our frames nor the errors that caused this one."""
    path = tmp_path / "picture.png"
    path.write_bytes(b"no picture")
    code = f"import glid_nb as glid\ndef opened():\n    glid.Editor({str(path)!r})\nopened()"
    command = [sys.executable, "-m", "IPython", "--quick", "--colors=nocolor", "-c", code]
    environment = {**os.environ, "IPYTHONDIR": str(tmp_path)}
    printed = subprocess.run(command, env=environment, capture_output=True, text=True).stdout
    lines = printed.strip().splitlines()
    assert lines[:-1] == [
        "Cell In[1], line 4",
        "    opened()",
        "Cell In[1], line 3",
        f"    glid.Editor({str(path)!r})",
    ]
    assert lines[-1].startswith("TraceError: ")
    assert path.name in lines[-1]
