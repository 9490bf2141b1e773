"""Saving while somebody works: in the background, not too often, always the latest."""

from __future__ import annotations

import itertools
import threading
import weakref
from collections.abc import Callable
from pathlib import Path

from glid_nb.session.document import Document
from glid_nb.session.document_file import save_document
from glid_nb.session.own_files import version_of
from glid_nb.session.worker import LatestWins

INTERVAL = 3.0
"""Least number of seconds between two saves, by default."""


class Autosave:
    """Saves the document that was submitted last, at most once per interval.

    The file is written by a thread of its own, atomically; a document that was overtaken by a later
    one is never written. What is pending when the process ends, or when this object is dropped, is
    written then. A file that somebody else has changed is left to them: from then on this one
    writes beside it (`free_sibling`).

    Parameters
    ----------
    path : path
        The file.
    interval : float
        Least number of seconds between two saves; the first is made at once.
    on_done : callable, optional
        Called, in the thread, after each save: with the exception if it failed, else with None. The
        next submission tries again.
    """

    def __init__(
        self,
        path: str | Path,
        interval: float = INTERVAL,
        on_done: Callable[[Exception | None], None] | None = None,
    ) -> None:
        if not interval >= 0:
            raise ValueError(f"interval is {interval}; it must be at least 0 seconds")
        self._file = _File(Path(path), on_done)
        self._worker: LatestWins[Document] = LatestWins(
            self._file.save, self, f"autosave {Path(path).name}", interval=interval, finish=True
        )
        _all.add(self)

    @property
    def path(self) -> Path:
        """The file."""
        return self._file.path

    @property
    def left(self) -> Path | None:
        """The file that was left to somebody else; None while nobody else has changed it."""
        return self._file.left

    @property
    def error(self) -> Exception | None:
        """What went wrong with the last save; None when it went well."""
        return self._file.error

    @property
    def n_saved(self) -> int:
        """How often the file was written."""
        return self._file.n_saved

    def submit(self, document: Document) -> None:
        """Save this document soon; returns at once."""
        if self._worker.closed:
            raise RuntimeError(f"the autosave of {self.path} is closed")
        self._worker.submit(document)

    def write(self, document: Document) -> None:
        """Save this document now, in this thread, whoever has changed the file.

        Raises
        ------
        DocumentError, OSError
            It cannot be written; what was there before stays.
        """
        self._worker.cancel()  # what is pending is older
        try:
            self._file.write(document)
        except Exception:
            self._worker.submit(document)
            raise

    def take_over(self) -> None:
        """Accept the file as it is now: its next save is not a change by somebody else."""
        self._file.take_over()

    def flush(self, timeout: float | None = None) -> bool:
        """Save what is pending now; whether that was done (or had failed) within ``timeout``."""
        return self._worker.hurry(timeout)

    def close(self) -> None:
        """Save what is pending and end the thread. Submitting is an error from then on."""
        self._worker.close()


_all: weakref.WeakSet[Autosave] = weakref.WeakSet()


def flush(path: str | Path) -> None:
    """Save what is pending for a file anywhere in this process, before the file is read."""
    wanted = Path(path).resolve()
    for autosave in tuple(_all):
        if autosave.path.resolve() == wanted:
            autosave.flush()


def free_sibling(path: Path) -> Path:
    """The first of name-2, name-3, ... that does not exist."""
    others = (path.with_stem(f"{path.stem}-{number}") for number in itertools.count(2))
    return next(other for other in others if not other.exists())


class _File:
    """The file, and what is known of it; it does not know the `Autosave`, so that can be dropped.

    Its lock is held while the file is written.
    """

    def __init__(self, path: Path, on_done: Callable[[Exception | None], None] | None) -> None:
        self.path, self._on_done = path, on_done
        self.left: Path | None = None
        self.error: Exception | None = None
        self.n_saved = 0
        self._known = version_of(path)
        self._writing = threading.Lock()

    def save(self, document: Document, _: object) -> None:
        """In the thread: write the file, or one beside it where somebody else has changed it."""
        failure: Exception | None = None
        with self._writing:
            try:
                if version_of(self.path) not in (None, self._known):
                    self.left, self.path = self.path, free_sibling(self.path)
                save_document(document, self.path)
                self._known = version_of(self.path)
            except Exception as error:  # reported; the next submission tries again
                failure = error
            self.error = failure
            self.n_saved += failure is None
        if self._on_done is not None:
            self._on_done(failure)

    def write(self, document: Document) -> None:
        """In the caller's thread: write the file, whoever has changed it."""
        with self._writing:
            save_document(document, self.path)
            self._known, self.error = version_of(self.path), None

    def take_over(self) -> None:
        """Take the file as it is now for one's own."""
        with self._writing:
            self._known = version_of(self.path)
