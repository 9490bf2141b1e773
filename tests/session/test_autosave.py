"""Autosaving: the latest document is saved, not too often, and nothing is lost."""

from __future__ import annotations

import subprocess
import sys
import threading
import time
from dataclasses import replace
from pathlib import Path

import pytest

from glid_nb.session.autosave import Autosave
from glid_nb.session.document_file import load_document, save_document

from .test_document import document


def test_the_first_save_is_immediate_and_the_latest_wins(tmp_path: Path) -> None:
    path = tmp_path / "a.glid"
    base, saved = document(), list[Exception | None]()
    autosave = Autosave(path, interval=60, on_done=saved.append)
    autosave.submit(replace(base, active=0))
    assert autosave.flush(timeout=60)
    assert load_document(path).active == 0
    for active in (1, 0, 1, 0, 1):
        autosave.submit(replace(base, active=active))
    assert saved == [None]  # the interval is not over
    assert autosave.flush(timeout=60)
    assert saved == [None, None]
    assert load_document(path).active == 1
    autosave.close()


def test_the_interval_is_kept(tmp_path: Path) -> None:
    base, saved = document(), list[Exception | None]()
    autosave = Autosave(tmp_path / "a.glid", interval=0.5, on_done=saved.append)
    end = time.monotonic() + 1.2
    while time.monotonic() < end:
        autosave.submit(base)
        threading.Event().wait(0.01)
    assert len(saved) <= 3
    autosave.close()
    assert 2 <= len(saved) <= 4
    assert saved == [None] * len(saved)


def test_closing_saves_what_is_pending_and_ends_the_thread(tmp_path: Path) -> None:
    path = tmp_path / "a.glid"
    before = threading.active_count()
    autosave = Autosave(path, interval=60)
    base = document()
    autosave.submit(base)
    autosave.flush()
    autosave.submit(replace(base, active=0))
    autosave.close()
    assert load_document(path).active == 0
    assert threading.active_count() == before
    autosave.close()
    with pytest.raises(RuntimeError, match="closed"):
        autosave.submit(base)


def test_a_failure_is_reported_and_the_next_save_tries_again(tmp_path: Path) -> None:
    folder = tmp_path / "gone"
    seen: list[Exception | None] = []
    autosave = Autosave(folder / "a.glid", interval=0, on_done=seen.append)
    autosave.submit(document())
    assert autosave.flush(timeout=60)
    assert isinstance(autosave.error, FileNotFoundError)
    assert seen == [autosave.error]
    folder.mkdir()
    autosave.submit(document())
    assert autosave.flush(timeout=60)
    assert autosave.error is None
    assert seen[1:] == [None]
    assert load_document(folder / "a.glid").active == 1
    autosave.close()


@pytest.mark.slow
def test_the_end_of_the_process_saves_too(tmp_path: Path) -> None:
    path = tmp_path / "a.glid"
    source = f"""
from glid_nb.geometry import Cage, Domain
from glid_nb.imaging import TraceOptions
from glid_nb.session.autosave import Autosave
from glid_nb.session.document import Document
import numpy as np
domain = Domain.from_cage(Cage([[0, 0], [4, 0], [0, 3]]))
image = np.zeros((3, 4, 4), np.uint8)
autosave = Autosave({str(path)!r}, interval=600)
for component in range(5):
    autosave.submit(Document(
        image, domain.cage, domain, TraceOptions(component=component), None, (), 0))
"""
    subprocess.run([sys.executable, "-c", source], check=True, timeout=120)
    assert load_document(path).trace_options.component == 4


def test_a_file_that_somebody_else_changed_is_left_to_them(tmp_path: Path) -> None:
    path, base = tmp_path / "a.glid", document()
    autosave = Autosave(path, interval=0)
    autosave.submit(replace(base, active=0))
    assert autosave.flush(timeout=60)
    save_document(replace(base, active=1), path)
    (tmp_path / "a-2.glid").write_bytes(b"also somebody's")
    for _ in range(2):  # and from then on
        autosave.submit(replace(base, active=0))
        assert autosave.flush(timeout=60)
        assert (autosave.error, autosave.left) == (None, path)
        assert autosave.path == tmp_path / "a-3.glid"
    assert load_document(path).active == 1
    assert load_document(autosave.path).active == 0
    assert (tmp_path / "a-2.glid").read_bytes() == b"also somebody's"
    autosave.close()


@pytest.mark.parametrize("accept", [True, False], ids=["taken over", "written"])
def test_a_change_that_was_accepted_is_written_over(tmp_path: Path, accept: bool) -> None:
    path, base = tmp_path / "a.glid", document()
    autosave = Autosave(path, interval=0)
    save_document(replace(base, active=1), path)
    if accept:
        autosave.own.note([path], path)
    else:
        autosave.write(replace(base, active=1))
    autosave.submit(replace(base, active=0))
    assert autosave.flush(timeout=60)
    assert (autosave.left, load_document(path).active) == (None, 0)
    autosave.close()


def test_a_file_that_was_deleted_is_written_anew(tmp_path: Path) -> None:
    path = tmp_path / "a.glid"
    autosave = Autosave(path, interval=0)
    autosave.write(document())
    path.unlink()
    autosave.submit(document())
    assert autosave.flush(timeout=60)
    assert (autosave.left, path.exists()) == (None, True)
    autosave.close()


def test_what_is_pending_is_not_written_after_a_later_one(tmp_path: Path) -> None:
    path, base, saved = tmp_path / "a.glid", document(), list[Exception | None]()
    autosave = Autosave(path, interval=600, on_done=saved.append)
    autosave.submit(base)
    assert autosave.flush(timeout=60)
    autosave.submit(replace(base, active=0))
    autosave.write(replace(base, active=1))
    autosave.close()
    assert (saved, load_document(path).active) == ([None], 1)
