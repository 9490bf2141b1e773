"""Atomic writing."""

from __future__ import annotations

import os
import stat
from pathlib import Path

import pytest

from glid_nb._files import write_bytes_atomically, write_text_atomically


def test_text_is_utf8_and_bytes_are_bytes(tmp_path: Path) -> None:
    write_text_atomically(tmp_path / "a.txt", "λ₁ ≥ 0\n")
    assert (tmp_path / "a.txt").read_bytes() == "λ₁ ≥ 0\n".encode()
    write_bytes_atomically(tmp_path / "a.txt", b"\x00\r\n")
    assert (tmp_path / "a.txt").read_bytes() == b"\x00\r\n"
    assert [p.name for p in tmp_path.iterdir()] == ["a.txt"]


@pytest.mark.parametrize("mask", [0o022, 0o077])
def test_permissions_are_those_of_a_plain_open(tmp_path: Path, mask: int) -> None:
    before = os.umask(mask)
    try:
        write_text_atomically(tmp_path / "a.txt", "")
        assert os.umask(mask) == mask
    finally:
        os.umask(before)
    assert stat.S_IMODE((tmp_path / "a.txt").stat().st_mode) == 0o666 & ~mask


@pytest.mark.parametrize("culprit", ["os.fsync", "pathlib.Path.chmod", "pathlib.Path.replace"])
def test_a_failure_leaves_what_was_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, culprit: str
) -> None:
    path = tmp_path / "a.txt"
    path.write_text("old")

    def fail(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(culprit, fail)
    with pytest.raises(KeyboardInterrupt):
        write_text_atomically(path, "new")
    monkeypatch.undo()
    assert path.read_text() == "old"
    assert [p.name for p in tmp_path.iterdir()] == ["a.txt"]


def test_a_missing_folder_is_an_os_error(tmp_path: Path) -> None:
    folder = tmp_path / "nowhere"
    with pytest.raises(FileNotFoundError) as refusal:
        write_text_atomically(folder / "a.txt", "")
    assert str(refusal.value) == f"The folder {folder} does not exist"
    (tmp_path / "file").touch()
    with pytest.raises(NotADirectoryError, match=r"^The folder .*file does not exist$"):
        write_text_atomically(tmp_path / "file" / "a.txt", "")


@pytest.mark.parametrize("name", ["", "."])
def test_a_folder_is_no_file(tmp_path: Path, name: str) -> None:
    with pytest.raises(IsADirectoryError, match=r" is a folder; name a file$"):
        write_text_atomically(tmp_path / name, "")
    assert list(tmp_path.iterdir()) == []


def test_an_error_names_the_file_and_never_a_temporary_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device", str(tmp_path / ".a.txt.tmp"))

    monkeypatch.setattr("os.fsync", full)
    with pytest.raises(OSError, match="No space") as refusal:
        write_text_atomically(tmp_path / "a.txt", "")
    expected = f"{tmp_path / 'a.txt'} cannot be written: No space left on device"
    assert str(refusal.value) == expected
    assert list(tmp_path.iterdir()) == []
