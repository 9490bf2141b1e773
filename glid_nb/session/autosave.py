"""Saving in the background, and which files an editor may replace unasked."""

import contextlib
import hashlib
import itertools
import os
import threading
import weakref
from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from glid_nb._runtime import data_directory
from glid_nb.session.document import Document
from glid_nb.session.document_file import save_document
from glid_nb.session.worker import LatestWins

INTERVAL = 3.0  # least number of seconds between two saves, by default
MOST_KEPT = 5  # most files of kept work


class OwnFiles:
    """The files that an editor wrote or opened, so that it replaces no others unasked.

    Each has an owner, the file that was named when it was written: a texture its mesh, a session
    file itself. A file that another program has changed since is no longer the editor's.
    """

    def __init__(self) -> None:
        self._owners: dict[Path, tuple[Path, tuple[int, ...] | None]] = {}
        self.session: Path | None = None  # the session file that was saved or opened last

    def note(self, paths: Iterable[Path], owner: Path) -> None:
        """Remember files that were written for ``owner``, or opened."""
        owner = owner.resolve()
        self._owners.update((path.resolve(), (owner, _version_of(path))) for path in paths)

    def note_session(self, path: str | Path) -> None:
        """Remember a session file that was saved or opened."""
        self.session = Path(path)
        self.note([self.session], self.session)

    def strangers(self, paths: Iterable[Path], owner: Path) -> tuple[Path, ...]:
        """Those of the files that exist and do not belong to ``owner``."""
        owner, there = owner.resolve(), [path for path in paths if path.exists()]
        return tuple(p for p in there if self._owners.get(p.resolve()) != (owner, _version_of(p)))


class Autosave:
    """Saves the document that was submitted last, the first at once, then once per ``interval``.

    What is pending is written when this is closed, when its ``owner`` goes and when the process
    ends. A file that another program has changed is left: later saves go to a new one beside it.

    Where a save fails it goes to ``elsewhere()``, if that is given, from then on.

    After each save ``on_done`` is called, in the thread, with the exception if it failed, else with
    None. The file as it is now becomes one of the ``own`` files.
    """

    def __init__(
        self,
        path: str | Path,
        interval: float = INTERVAL,
        on_done: Callable[[Exception | None], None] | None = None,
        own: OwnFiles | None = None,
        owner: object | None = None,
        elsewhere: Callable[[], Path] | None = None,
    ) -> None:
        self.path, self.own, self._on_done = Path(path), own or OwnFiles(), on_done
        self._elsewhere = elsewhere
        self.left: Path | None = None
        """The file that was given up because another program changed it."""
        self.error: Exception | None = None
        """What went wrong with the last save; None when it went well."""
        self._writing = threading.RLock()
        self.own.note_session(self.path)
        name = f"autosave {self.path.name}"
        self._worker = LatestWins(self._save, owner or self, name, interval=interval, finish=True)
        _all.add(self)

    def submit(self, document: Document) -> None:
        """Save this document soon; returns at once."""
        if self._worker.closed:
            raise RuntimeError(f"the autosave of {self.path} is closed")
        self._worker.submit(document)

    def write(self, document: Document) -> None:
        """Save this document now, in this thread, even if another program has changed the file."""
        self._worker.cancel()  # what is pending is older
        try:
            self._write(document)
        except Exception:
            self._worker.submit(document)
            raise

    def flush(self, timeout: float | None = None) -> bool:
        """Save what is pending now; whether that ended, well or not, within ``timeout`` seconds."""
        return self._worker.hurry(timeout)

    def close(self) -> None:
        """Save what is pending and end the thread; submitting is an error from then on."""
        self._worker.close()

    def _save(self, document: Document, _: object) -> None:
        with self._writing:
            try:
                if self.own.strangers([self.path], self.path):
                    self.left, self.path = self.path, free_sibling(self.path)
                self._write_somewhere(document)
                if self.own.session == self.left:
                    self.own.session = self.path
            except Exception as error:  # reported; the next submission tries again
                self.error = error
        if self._on_done is not None:
            self._on_done(self.error)

    def _write_somewhere(self, document: Document) -> None:
        try:
            self._write(document)
        except OSError:
            if self._elsewhere is None:
                raise
            self.path = self._elsewhere()
            self._write(document)

    def _write(self, document: Document) -> None:
        with self._writing:
            save_document(document, self.path)
            self.own.note([self.path], self.path)
            self.error = None


_all: weakref.WeakSet[Autosave] = weakref.WeakSet()


def flush(path: str | Path) -> None:
    """Save what any editor of this process has pending for a file, before the file is read."""
    wanted = Path(path).resolve()
    for autosave in tuple(_all):
        if autosave.path.resolve() == wanted:
            autosave.flush()


def free_sibling(path: Path) -> Path:
    """The first of name-2, name-3, ... that does not exist."""
    others = (path.with_stem(f"{path.stem}-{number}") for number in itertools.count(2))
    return next(other for other in others if not other.exists())


def kept_files(image: NDArray[np.uint8] | None = None) -> list[Path]:
    """Files of kept work that is in no other file, of one picture or of any; the newest first.

    There are none where the data folder, or a file in it, cannot be read.
    """
    try:
        found = [path for path in _kept().glob("*.glid") if os.access(path, os.R_OK)]
    except OSError:  # said when something is to be kept there
        return []
    versions = {path: _version_of(path) for path in found}
    paths = sorted(versions, key=lambda path: versions[path] or (), reverse=True)
    name = "" if image is None or not paths else _name_of(image)
    return [path for path in paths if path.name.startswith(name)]


def new_kept_file(image: NDArray[np.uint8]) -> Path:
    """Where to keep work on a picture from now on; its folder is made, the oldest files go.

    Raises an OSError where there can be no such folder.
    """
    path = _kept() / f"{_name_of(image)}.glid"
    path.parent.mkdir(parents=True, exist_ok=True)
    for old in kept_files()[MOST_KEPT - 1 :]:
        with contextlib.suppress(OSError):  # another user's, say; one file more is no harm
            old.unlink(missing_ok=True)
    return free_sibling(path) if path.exists() else path


def _kept() -> Path:
    return data_directory() / "kept"


def _name_of(image: NDArray[np.uint8]) -> str:
    height, width = image.shape[:2]
    return f"{width}x{height}-{hashlib.sha256(np.ascontiguousarray(image).data).hexdigest()[:16]}"


def _version_of(path: Path) -> tuple[int, ...] | None:
    try:
        status = path.stat()
    except OSError:  # a file that cannot be reached is reported when it is written
        return None
    return status.st_mtime_ns, status.st_ino, status.st_size
