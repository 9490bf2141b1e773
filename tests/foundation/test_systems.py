"""Differences between systems, simulated on any of them."""

from __future__ import annotations

import ast
import errno
import io
import os
import sys
import time
import zipfile
from pathlib import Path

import pytest

from glid_nb import InputError, read_image
from glid_nb._files import discard, portable_name, read_file, same_file, write_atomically, zipped
from glid_nb._json import read_json

REPOSITORY = Path(__file__).resolve().parents[2]
FOLDERS = ("glid_nb", "checker", "studies", "tools", "docs")
SOURCES = sorted(path for name in FOLDERS for path in (REPOSITORY / name).rglob("*.py"))
NAMES = ["with two  spaces.json", "Σ₂ – größer.json", "🦎.json", "C:\\Users\\me\\map.json"]


def refuse_replacing(monkeypatch: pytest.MonkeyPatch) -> None:
    """Like Windows while another program has the file open."""

    def refused(self: Path, target: Path) -> Path:
        raise PermissionError(errno.EACCES, "Access is denied", str(self), 5, str(target))

    monkeypatch.setattr(Path, "replace", refused)


def test_a_file_that_is_open_elsewhere_is_overwritten_in_place(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "a.json"
    path.write_bytes(b"a long old text")
    refuse_replacing(monkeypatch)
    with path.open("rb"):
        write_atomically(path, "new")
    assert path.read_bytes() == b"new"
    assert list(tmp_path.iterdir()) == [path]


def test_an_open_file_that_cannot_be_overwritten_keeps_what_was_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, synced = tmp_path / "a.json", os.fsync
    path.write_bytes(b"old")
    refuse_replacing(monkeypatch)
    calls = []

    def full_the_second_time(file: int) -> None:
        calls.append(file)
        if len(calls) == 2:
            raise OSError(errno.ENOSPC, "No space left on device")
        synced(file)

    monkeypatch.setattr(os, "fsync", full_the_second_time)
    with pytest.raises(OSError, match=r"a\.json cannot be written: No space left"):
        write_atomically(path, "something longer")
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]


def test_a_new_file_that_may_not_get_its_name_is_an_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    refuse_replacing(monkeypatch)
    with pytest.raises(PermissionError, match=r"a\.json cannot be written: Access is denied"):
        write_atomically(tmp_path / "a.json", "new")
    assert list(tmp_path.iterdir()) == []


def test_writing_asks_for_nothing_that_only_unix_has(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "fcntl", None)
    monkeypatch.setitem(sys.modules, "pwd", None)
    for name in ("link", "symlink", "chown", "getuid", "umask", "O_DIRECTORY", "O_NOFOLLOW"):
        monkeypatch.delattr(os, name, raising=False)
    path = tmp_path / "a.json"
    for text in ("made", "replaced"):
        write_atomically(path, text)
        assert path.read_text(encoding="utf-8") == text


def test_a_file_that_is_open_elsewhere_is_not_deleted_and_no_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "a.glid"
    discard(path)  # gone already
    path.touch()

    def refused(self: Path, missing_ok: bool = False) -> None:
        raise PermissionError(errno.EACCES, f"{self} is open, {missing_ok}")

    with monkeypatch.context() as patch:
        patch.setattr(Path, "unlink", refused)
        discard(path)
    assert path.exists()
    discard(path)
    assert not path.exists()


@pytest.mark.parametrize("read", [read_json, read_image])
def test_a_folder_is_no_file_on_any_system(
    read, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def denied(self: Path) -> bytes:
        raise PermissionError(errno.EACCES, "Permission denied", str(self))

    monkeypatch.setattr(Path, "read_bytes", denied)  # the error of Windows for a folder
    with pytest.raises((InputError, OSError), match=r"(?i)folder|directory"):
        read(tmp_path)


@pytest.mark.parametrize("name", NAMES)
def test_names_with_spaces_signs_and_backslashes_are_names(name: str, tmp_path: Path) -> None:
    if os.name == "nt" and ":" in name:
        name = name.replace(":", "").replace("\\", "/")
        (tmp_path / name).parent.mkdir(parents=True)
    path = tmp_path / name
    write_atomically(path, '{"a": 1}')
    assert read_json(path) == read_json(str(path)) == {"a": 1}
    assert [p for p in tmp_path.rglob("*") if p.is_file()] == [path]
    path.write_bytes(b"[")
    with pytest.raises(InputError) as refusal:
        read_json(path)
    assert str(refusal.value).startswith(str(path))


def test_a_json_file_of_an_editor_that_marks_utf8_is_read(tmp_path: Path) -> None:
    path = tmp_path / "a.json"
    path.write_bytes(b'\xef\xbb\xbf{"a":\r\n 1}\r\n')
    assert read_json(path) == {"a": 1}


def test_names_that_differ_by_case_are_one_file_where_the_system_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    first, second = tmp_path / "Map.json", tmp_path / "map.JSON"
    monkeypatch.setattr(os.path, "normcase", str.lower)
    assert same_file(first, second)


def test_a_zip_has_the_same_bytes_on_every_system(monkeypatch: pytest.MonkeyPatch) -> None:
    files = {"a.json": b"{}", "b.png": b"\x89PNG"}
    here = zipped(files, stored=["b.png"])
    monkeypatch.setattr(sys, "platform", "win32" if sys.platform != "win32" else "linux")
    assert zipped(files, stored=["b.png"]) == here
    with zipfile.ZipFile(io.BytesIO(here)) as archive:
        assert archive.namelist() == list(files)


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("gecko", "gecko"),
        ("Mein Bild 🦎", "Mein Bild 🦎"),
        ('what? "a/b": <1>', "what_ _a_b_ _1_"),
        ("C:\\Users\\me\\cat", "C_Users_me_cat"),
        ("nul", "_nul"),
        ("Com1.new", "_Com1.new"),
        ("console", "console"),
        ("dots. ..", "dots"),
        (" . ", ""),
    ],
)
def test_a_suggested_name_is_possible_on_every_system(text: str, name: str) -> None:
    assert portable_name(text) == name
    assert portable_name(name) == name


@pytest.mark.skipif(not hasattr(time, "tzset"), reason="the zone is the system's there")
@pytest.mark.parametrize("zone", ["UTC", "Asia/Kathmandu", "Pacific/Kiritimati"])
def test_a_file_does_not_depend_on_the_time_zone(
    zone: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TZ", zone)
    time.tzset()
    try:
        write_atomically(tmp_path / "a.zip", zipped({"a": b"1"}))
    finally:
        monkeypatch.undo()
        time.tzset()
    assert read_file(tmp_path / "a.zip") == zipped({"a": b"1"})


def _of_text(call: ast.Call) -> bool:
    """Whether a call reads or writes text, so that its encoding would be the locale's."""
    named = {keyword.arg for keyword in call.keywords}
    match call.func:
        case ast.Attribute(attr="read_text" | "write_text" | "TextIOWrapper"):
            return True
        case ast.Attribute(attr="run" | "Popen" | "check_output"):
            return bool(named & {"text", "universal_newlines"})
        case ast.Name("open"):
            return not any(isinstance(a, ast.Constant) and "b" in str(a.value) for a in call.args)
        case ast.Attribute(attr="open"):  # path.open("w"); Image.open(file) has no such argument
            modes = [a.value for a in call.args[:1] if isinstance(a, ast.Constant)]
            return modes in ([], ["r"], ["w"], ["a"], ["x"]) and len(modes) == len(call.args)
    return False


@pytest.mark.parametrize("path", SOURCES, ids=lambda p: p.relative_to(REPOSITORY).as_posix())
def test_text_is_read_and_written_as_utf8_whatever_the_locale(path: Path) -> None:
    tree = ast.parse(path.read_text(encoding="utf-8"))
    calls = [node for node in ast.walk(tree) if isinstance(node, ast.Call) and _of_text(node)]
    without = [c.lineno for c in calls if all(k.arg != "encoding" for k in c.keywords)]
    positional = {c.lineno for c in calls if any(_is_utf8(a) for a in c.args)}
    assert not set(without) - positional, f"no encoding is given on lines {without}"


def _is_utf8(argument: ast.expr) -> bool:
    return isinstance(argument, ast.Constant) and argument.value == "utf-8"
