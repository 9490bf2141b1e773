"""Save in the background, and track which files an editor may overwrite without asking."""

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
MOST_KEPT = 5  # most files of work that is in no session file


class OwnFiles:
    """The files that an editor wrote or opened. It overwrites other files only after asking.

    Each file has an owner: the file that the user named. The owner of a texture is its mesh; a
    session file owns itself. A file that another program has changed no longer belongs to the
    editor.
    """

    def __init__(self) -> None:
        self._owners: dict[Path, tuple[Path, tuple[int, ...] | None]] = {}
        self.session: Path | None = None  # the session file that was saved or opened last

    def note(self, paths: Iterable[Path], owner: Path) -> None:
        """Remember files that were opened, or written for ``owner``."""
        owner = owner.resolve()
        self._owners.update((path.resolve(), (owner, _version_of(path))) for path in paths)

    def note_session(self, path: str | Path) -> None:
        """Remember a session file that was saved or opened."""
        self.session = Path(path)
        self.note([self.session], self.session)

    def strangers(self, paths: Iterable[Path], owner: Path) -> tuple[Path, ...]:
        """The files that exist but do not belong to ``owner``."""
        owner, there = owner.resolve(), [path for path in paths if path.exists()]
        return tuple(p for p in there if self._owners.get(p.resolve()) != (owner, _version_of(p)))


class Autosave:
    """Saves the last submitted document: the first at once, then at most once per ``interval``.

    A pending document is written when this object is closed, when its ``owner`` is deleted and when
    the process ends. If another program has changed the file, later saves go to a new file beside
    it. If a save fails and ``elsewhere`` is given, saves go to the path ``elsewhere()`` from then
    on.

    After each save, ``on_done`` is called in the thread with the exception, or with None if the
    save succeeded. The saved file becomes one of the ``own`` files.
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
        """The file that is no longer written because another program changed it."""
        self.error: Exception | None = None
        """The exception of the last save; None if it succeeded."""
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
        self._worker.cancel()  # the pending document is older
        try:
            self._write(document)
        except Exception:
            self._worker.submit(document)
            raise

    def flush(self, timeout: float | None = None) -> bool:
        """Save the pending document now. Returns False if that takes over ``timeout`` seconds."""
        return self._worker.hurry(timeout)

    def close(self) -> None:
        """Save the pending document and end the thread. Submitting is an error afterwards."""
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
    """Save the pending changes of all editors of this process to a file, before it is read."""
    wanted = Path(path).resolve()
    for autosave in tuple(_all):
        if autosave.path.resolve() == wanted:
            autosave.flush()


def free_sibling(path: Path) -> Path:
    """The first of name-2, name-3, ... that does not exist."""
    others = (path.with_stem(f"{path.stem}-{number}") for number in itertools.count(2))
    return next(other for other in others if not other.exists())


def kept_files(image: NDArray[np.uint8] | None = None) -> list[Path]:
    """The kept files with work that is in no session file, the newest first.

    With ``image``, only the files for that picture. Empty if the data folder, or a file in it,
    cannot be read.
    """
    try:
        found = [path for path in _kept().glob("*.glid") if os.access(path, os.R_OK)]
    except OSError:  # reported when something is saved there
        return []
    versions = {path: _version_of(path) for path in found}
    paths = sorted(versions, key=lambda path: versions[path] or (), reverse=True)
    name = "" if image is None or not paths else _name_of(image)
    return [path for path in paths if path.name.startswith(name)]


def new_kept_file(image: NDArray[np.uint8]) -> Path:
    """A new path for keeping work on a picture. Makes its folder and deletes the oldest files.

    Raises an OSError if the folder cannot be made.
    """
    path = _kept() / f"{_name_of(image)}.glid"
    path.parent.mkdir(parents=True, exist_ok=True)
    for old in kept_files()[MOST_KEPT - 1 :]:
        with contextlib.suppress(OSError):  # for example another user's file; it may stay
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
    except OSError:  # reported when the file is written
        return None
    return status.st_mtime_ns, status.st_ino, status.st_size
