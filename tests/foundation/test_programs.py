"""Programs that are compiled once, and kept between processes."""

from __future__ import annotations

import errno
import hashlib
import os
import pickle
import shutil
import threading
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import jax
import numpy as np
import pytest

from glid_nb import _cache_folder, _kept_programs, _programs
from glid_nb._programs import Program
from glid_nb._runtime import watched

from ..support.cache import kept_in

TIMEOUT = 60.0


def double(x: Any, y: Any) -> Any:
    return 2 * x + y


def made(function: Any = double) -> Program:
    """A program that a new process has not run yet."""
    return Program(function, donated=1, may_keep=lambda *_: True)


def stages(program: Program, *arguments: Any) -> list[str]:
    """The stages that a call goes through."""
    seen: list[str] = []
    with watched(seen.append):
        np.testing.assert_array_equal(program(*arguments), double(*arguments))
    return seen


@pytest.fixture(autouse=True)
def folder(tmp_path: Path) -> Iterator[Path]:
    with kept_in(tmp_path) as folder:
        yield folder


ONES, TWOS = np.ones(3, np.float32), np.full(3, 2, np.float32)


def test_a_program_is_compiled_once_for_each_kind_of_arguments() -> None:
    program = made()
    assert stages(program, ONES, ONES) == ["trace", "lower", "compile"]
    assert stages(program, TWOS, ONES) == []
    assert stages(program, ONES[:2], ONES[:2]) == ["trace", "lower", "compile"]


def test_compiling_is_logged(caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level("INFO", "glid_nb")
    program = made()
    program(ONES, ONES)
    assert [line.split()[0] for line in caplog.messages] == ["compiling", "compiled"]
    program(TWOS, ONES)
    assert len(caplog.messages) == 2


def test_another_process_finds_it_without_tracing() -> None:
    made()(ONES, ONES)
    assert stages(made(), TWOS, ONES) == ["load"]


def test_results_of_a_program_that_was_read_have_the_usual_type() -> None:
    """With JAX 0.12 they had not, and every call with such a result read the program again."""
    seen: list[str] = []
    result = made()(ONES, ONES)
    program = made()
    again = program(ONES, ONES)
    assert jax.typeof(again) == jax.typeof(result)
    with watched(seen.append):
        program(ONES, program(program(ONES, ONES), ONES))
    assert seen == []


def test_after_a_change_of_the_package_it_is_found_by_its_text(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    made()(ONES, ONES)
    monkeypatch.setattr(_programs, "package_files", lambda: ["changed"])
    assert stages(made(), TWOS, ONES) == ["trace", "lower", "load"]
    assert stages(made(), TWOS, ONES) == ["load"]


def test_a_damaged_file_is_compiled_again(folder: Path) -> None:
    made()(ONES, ONES)
    (path,) = folder.glob("glid_nb_program_*")
    path.write_bytes(path.read_bytes()[:-1])
    assert stages(made(), TWOS, ONES) == ["trace", "lower", "compile"]
    assert stages(made(), TWOS, ONES) == ["load"]


def test_what_must_not_be_kept_is_not(folder: Path) -> None:
    program = Program(double, donated=1, may_keep=lambda *_: False)
    assert stages(program, ONES, ONES) == ["trace", "lower", "compile"]
    assert not list(folder.glob("glid_nb_*"))


def test_a_second_thread_waits_for_what_the_first_compiles() -> None:
    traced, go_on, calls = threading.Event(), threading.Event(), []

    def slow(x: Any, y: Any) -> Any:
        calls.append(threading.get_ident())
        traced.set()
        assert go_on.wait(TIMEOUT)
        return double(x, y)

    program, results = made(slow), []
    threads = [
        threading.Thread(target=lambda: results.append(program(ONES, ONES))) for _ in range(2)
    ]
    for thread in threads:
        thread.start()
    assert traced.wait(TIMEOUT)
    go_on.set()
    for thread in threads:
        thread.join(TIMEOUT)
    assert len(calls) == 1
    np.testing.assert_array_equal(results, np.full((2, 3), 3.0))


def test_whoever_watches_can_end_it() -> None:
    class Ended(Exception):  # noqa: N818
        pass

    def end(name: str) -> None:
        if name == "compile":
            raise Ended

    program = made()
    with pytest.raises(Ended), watched(end):
        program(ONES, ONES)
    assert stages(program, ONES, ONES) == ["trace", "lower", "compile"]


def test_of_those_in_files_the_few_used_last_stay_in_memory(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(_programs, "MOST_LOADED", 2)
    program = Program(double, donated=1, may_keep=lambda x, _: len(x) != 3)
    kinds = threes, twos, ones, mixed = [
        (np.ones(n), ONES[:k]) for n, k in ((3, 3), (2, 2), (1, 1), (1, 3))
    ]
    for arguments in kinds[:3]:
        assert stages(program, *arguments) == ["trace", "lower", "compile"]
    assert stages(program, *twos) == []
    assert stages(program, *mixed) == ["trace", "lower", "compile"]
    assert stages(program, *twos) == stages(program, *mixed) == []
    assert stages(program, *ones) == ["load"]
    assert stages(program, *twos) == ["load"]
    assert stages(program, *ones) == stages(program, *threes) == []


@pytest.fixture
def warned(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The warnings of a process that has not given up any folder."""
    told: list[str] = []
    monkeypatch.setattr(_cache_folder, "refused", set())
    monkeypatch.setattr(_cache_folder.warnings, "warn", lambda text, *_, **__: told.append(text))
    return told


COMPILED = ["trace", "lower", "compile"]


def test_a_folder_that_cannot_be_made_is_told_once_and_the_work_goes_on(
    folder: Path, warned: list[str]
) -> None:
    (folder / "file").write_text("not a folder", encoding="utf-8")
    jax.config.update("jax_compilation_cache_dir", str(folder / "file" / "below"))
    for _ in range(2):
        assert stages(made(), ONES, ONES) == COMPILED
    assert len(warned) == 1
    assert str(folder / "file" / "below") in warned[0]
    assert "GLID_NB_CACHE" in warned[0]


@pytest.mark.parametrize(
    ("fault", "reason"),
    [
        (OSError(errno.ENOSPC, os.strerror(errno.ENOSPC)), "No space left"),
        (PermissionError(errno.EACCES, os.strerror(errno.EACCES)), "Permission denied"),
        (OSError(errno.EROFS, os.strerror(errno.EROFS)), "Read-only file system"),
    ],
)
def test_a_write_that_fails_is_told_once_and_the_work_goes_on(
    fault: OSError, reason: str, warned: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: Any) -> None:
        raise fault

    monkeypatch.setattr(_kept_programs, "write_atomically", fail)
    assert stages(made(), ONES, ONES) == COMPILED
    assert stages(made(), TWOS, ONES) == COMPILED
    assert len(warned) == 1
    assert reason in warned[0]


def test_a_folder_that_vanishes_is_made_again(folder: Path, warned: list[str]) -> None:
    assert stages(made(), ONES, ONES) == COMPILED
    shutil.rmtree(folder)
    assert stages(made(), ONES, ONES) == COMPILED
    assert stages(made(), TWOS, ONES) == ["load"]
    assert warned == []


@pytest.mark.parametrize(
    "content", [b"", b"\0", b"\xff\xfe", b"glid_nb_program_of_nobody", b"../x"]
)
def test_a_damaged_alias_is_written_again(content: bytes, folder: Path, warned: list[str]) -> None:
    made()(ONES, ONES)
    (alias,) = folder.glob("glid_nb_arguments_*")
    alias.write_bytes(content)
    assert stages(made(), TWOS, ONES) == ["trace", "lower", "load"]
    assert stages(made(), TWOS, ONES) == ["load"]
    assert warned == []


def test_a_program_that_another_version_has_written_is_compiled_again(
    folder: Path, warned: list[str]
) -> None:
    made()(ONES, ONES)
    (path,) = folder.glob("glid_nb_program_*")
    for value in (("other", "parts"), 1, {}):
        content = zlib.compress(pickle.dumps(value))
        path.write_bytes(hashlib.sha256(content).digest() + content)
        assert stages(made(), TWOS, ONES) == ["load", "trace", "lower", "load", "compile"]
    assert stages(made(), TWOS, ONES) == ["load"]
    assert warned == []


@pytest.mark.skipif(not hasattr(os, "geteuid"), reason="files have no owners here")
def test_a_program_of_another_user_is_not_run(
    warned: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    made()(ONES, ONES)
    mine = os.geteuid()
    monkeypatch.setattr(_kept_programs, "trusted_owners", lambda: {mine + 1})
    assert stages(made(), TWOS, ONES) == COMPILED
    assert len(warned) == 1
    assert "another user" in warned[0]


def test_without_a_way_to_write_executables_nothing_is_kept(
    folder: Path, warned: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(_kept_programs, "executables", lambda: None)
    assert stages(made(), ONES, ONES) == COMPILED
    assert not list(folder.glob("glid_nb_*"))
    assert warned == []


def test_a_library_that_refuses_to_write_executables_is_told_once(
    warned: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    class Library:
        @staticmethod
        def serialize(_: Any) -> Any:
            raise ValueError("compilation does not support serialization")

    monkeypatch.setattr(_kept_programs, "executables", lambda: Library)
    for _ in range(2):
        assert stages(made(), ONES, ONES) == COMPILED
    assert len(warned) == 1
    assert "does not support serialization" in warned[0]
