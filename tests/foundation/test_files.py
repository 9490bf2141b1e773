"""Atomic writing."""

from __future__ import annotations

import os
import stat
from pathlib import Path

import pytest

import glid_nb
from glid_nb import InputError
from glid_nb._files import write_atomically


def test_text_is_utf8_and_bytes_are_bytes(tmp_path: Path) -> None:
    write_atomically(tmp_path / "a.txt", "λ₁ ≥ 0\n")
    assert (tmp_path / "a.txt").read_bytes() == "λ₁ ≥ 0\n".encode()
    write_atomically(tmp_path / "a.txt", b"\x00\r\n")
    assert (tmp_path / "a.txt").read_bytes() == b"\x00\r\n"
    assert [p.name for p in tmp_path.iterdir()] == ["a.txt"]


UNIX = pytest.mark.skipif(os.name == "nt", reason="Windows has no such permissions, nor FIFOs")


@UNIX
@pytest.mark.parametrize("mask", [0o022, 0o077])
def test_permissions_are_those_of_a_plain_open(tmp_path: Path, mask: int) -> None:
    before = os.umask(mask)
    try:
        write_atomically(tmp_path / "a.txt", "")
        assert os.umask(mask) == mask
    finally:
        os.umask(before)
    assert stat.S_IMODE((tmp_path / "a.txt").stat().st_mode) == 0o666 & ~mask


@UNIX
def test_an_existing_file_keeps_its_permissions(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    path.write_text("old")
    for mode in (0o600, 0o666, 0o640):
        path.chmod(mode)
        write_atomically(path, "new")
        assert stat.S_IMODE(path.stat().st_mode) == mode
    assert path.read_text() == "new"


def test_a_symbolic_link_stays_one(tmp_path: Path) -> None:
    (tmp_path / "far").mkdir()
    file, link, chain = tmp_path / "far" / "a.txt", tmp_path / "link", tmp_path / "chain"
    link.symlink_to(Path("far") / "a.txt")
    chain.symlink_to("link")
    for text in ("made", "replaced"):
        write_atomically(chain, text)
        assert file.read_text() == text
    assert link.is_symlink()
    assert chain.is_symlink()
    assert [p.name for p in file.parent.iterdir()] == ["a.txt"]


def test_a_link_that_leads_nowhere_is_an_os_error(tmp_path: Path) -> None:
    link, loop = tmp_path / "link", tmp_path / "loop"
    link.symlink_to(tmp_path / "nowhere" / "a.txt")
    loop.symlink_to("loop")
    with pytest.raises(FileNotFoundError, match=r"^The folder .*nowhere does not exist$"):
        write_atomically(link, "")
    with pytest.raises(OSError, match=r"^\S*loop cannot be written: "):
        write_atomically(loop, "")
    assert loop.is_symlink()


@UNIX
def test_hard_links_stay_one_file(tmp_path: Path) -> None:
    first, second = tmp_path / "a.txt", tmp_path / "b.txt"
    first.write_text("a long old text")
    second.hardlink_to(first)
    first.chmod(0o640)
    write_atomically(second, "new")
    assert first.read_text() == "new"
    assert first.samefile(second)
    assert stat.S_IMODE(first.stat().st_mode) == 0o640
    assert len(list(tmp_path.iterdir())) == 2


def test_a_hard_link_that_cannot_be_overwritten_keeps_what_was_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    first, second = tmp_path / "a.txt", tmp_path / "b.txt"
    first.write_text("old")
    second.hardlink_to(first)
    calls = []

    def fail_once_in_place(file: int) -> None:
        calls.append(file)
        if len(calls) == 2:
            raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", fail_once_in_place)
    with pytest.raises(OSError, match=r"b\.txt cannot be written: No space left"):
        write_atomically(second, "something longer")
    assert first.read_text() == "old"
    assert len(list(tmp_path.iterdir())) == 2


@UNIX
def test_a_device_stays_one(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    try:
        write_atomically(pipe, "new")
        assert os.read(reader, 10) == b"new"
    finally:
        os.close(reader)
    assert stat.S_ISFIFO(pipe.stat().st_mode)


@UNIX
def test_the_umask_of_the_process_is_left_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Another thread would make files with permissions that nobody wanted."""
    monkeypatch.delattr("os.umask")
    write_atomically(tmp_path / "a.txt", "")


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
        write_atomically(path, "new")
    monkeypatch.undo()
    assert path.read_text() == "old"
    assert [p.name for p in tmp_path.iterdir()] == ["a.txt"]


def test_a_missing_folder_is_an_os_error(tmp_path: Path) -> None:
    folder = tmp_path / "nowhere"
    with pytest.raises(FileNotFoundError) as refusal:
        write_atomically(folder / "a.txt", "")
    assert str(refusal.value) == f"The folder {folder} does not exist"
    (tmp_path / "file").touch()
    with pytest.raises(NotADirectoryError, match=r"^The folder .*file does not exist$"):
        write_atomically(tmp_path / "file" / "a.txt", "")


@pytest.mark.parametrize("name", ["", "."])
def test_a_folder_is_no_file(tmp_path: Path, name: str) -> None:
    with pytest.raises(IsADirectoryError, match=r" is a folder; name a file$"):
        write_atomically(tmp_path / name, "")
    assert list(tmp_path.iterdir()) == []


def test_an_error_names_the_file_and_never_a_temporary_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device", str(tmp_path / ".a.txt.tmp"))

    monkeypatch.setattr("os.fsync", full)
    with pytest.raises(OSError, match="No space") as refusal:
        write_atomically(tmp_path / "a.txt", "")
    expected = f"{tmp_path / 'a.txt'} cannot be written: No space left on device"
    assert str(refusal.value) == expected
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", ["a\0b.json", "\ud800.json"])
def test_a_name_that_no_file_can_have(name: str) -> None:
    told = r"\.json' has a character that file names cannot have$"
    with pytest.raises(InputError, match=told):
        write_atomically(name, "")
    for read in (glid_nb.HarmonicMap.load, glid_nb.io.load_pose, glid_nb.io.load_document):
        with pytest.raises(InputError, match=told):
            read(name)


def test_a_name_that_is_too_long() -> None:
    name = 300 * "x"
    with pytest.raises(OSError, match="x cannot be written: File name too long"):
        write_atomically(name, "")
    for read in (glid_nb.HarmonicMap.load, glid_nb.io.load_pose, glid_nb.io.load_document):
        with pytest.raises(OSError, match="x cannot be read: File name too long"):
            read(name)
