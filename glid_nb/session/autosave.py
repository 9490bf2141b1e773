"""Saving while somebody works: in the background, not too often, always the latest."""

from __future__ import annotations

import itertools
import threading
import time
import weakref
from collections.abc import Callable
from pathlib import Path

from glid_nb.session.document import Document
from glid_nb.session.document_file import save_document
from glid_nb.session.own_files import version_of

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
        self._worker = _Worker(Path(path), interval, on_done)
        _all.add(self)
        # Also at the end of the process.
        self._finalizer = weakref.finalize(self, self._worker.close)

    @property
    def path(self) -> Path:
        """The file."""
        return self._worker.path

    @property
    def left(self) -> Path | None:
        """The file that was left to somebody else; None while nobody else has changed it."""
        return self._worker.left

    @property
    def error(self) -> Exception | None:
        """What went wrong with the last save; None when it went well."""
        return self._worker.error

    @property
    def n_saved(self) -> int:
        """How often the file was written."""
        return self._worker.n_saved

    def submit(self, document: Document) -> None:
        """Save this document soon; returns at once."""
        self._worker.submit(document)

    def write(self, document: Document) -> None:
        """Save this document now, in this thread, whoever has changed the file.

        Raises
        ------
        DocumentError, OSError
            It cannot be written; what was there before stays.
        """
        self._worker.write(document)

    def take_over(self) -> None:
        """Accept the file as it is now: its next save is not a change by somebody else."""
        self._worker.take_over()

    def flush(self, timeout: float | None = None) -> bool:
        """Save what is pending now; whether that was done (or had failed) within ``timeout``."""
        return self._worker.flush(timeout)

    def close(self) -> None:
        """Save what is pending and end the thread. Submitting is an error from then on."""
        self._finalizer()


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


class _Worker:
    """The thread and what it shares; it does not know the `Autosave`, so that one can be dropped.

    The thread starts with the first document and ends when it is closed.
    """

    def __init__(
        self, path: Path, interval: float, on_done: Callable[[Exception | None], None] | None
    ) -> None:
        self.path, self._interval, self._on_done = path, interval, on_done
        self.left: Path | None = None
        self._known = version_of(path)
        self._changed = threading.Condition()
        self._pending: Document | None = None
        self._hurry = self._busy = self._closed = False
        self._thread: threading.Thread | None = None
        self.error: Exception | None = None
        self.n_saved = 0

    def submit(self, document: Document) -> None:
        with self._changed:
            if self._closed:
                raise RuntimeError(f"the autosave of {self.path} is closed")
            self._pending = document
            if self._thread is None:
                self._thread = threading.Thread(
                    target=self._run, name=f"autosave {self.path.name}", daemon=True
                )
                self._thread.start()
            self._changed.notify_all()

    def flush(self, timeout: float | None) -> bool:
        with self._changed:
            self._hurry = True
            self._changed.notify_all()
            done = self._changed.wait_for(lambda: self._pending is None and not self._busy, timeout)
            self._hurry = False
            return done

    def close(self) -> None:
        with self._changed:
            self._closed = True
            self._changed.notify_all()
            thread = self._thread
        if thread is not None and thread is not threading.current_thread():
            thread.join()

    def write(self, document: Document) -> None:
        with self._changed:
            self._changed.wait_for(lambda: not self._busy)
            save_document(document, self.path)
            self._pending, self._known, self.error = None, version_of(self.path), None
            self._changed.notify_all()

    def take_over(self) -> None:
        with self._changed:
            self._changed.wait_for(lambda: not self._busy)
            self._known = version_of(self.path)

    def _save(self, document: Document) -> None:
        found = version_of(self.path)
        if found not in (None, self._known):
            self.left, self.path = self.path, free_sibling(self.path)
        save_document(document, self.path)
        self._known = version_of(self.path)

    def _run(self) -> None:
        last = -float("inf")
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._pending is not None or self._closed)
                due = last + self._interval
                self._changed.wait_for(
                    lambda: self._hurry or self._closed, max(0.0, due - time.monotonic())
                )
                document, self._pending = self._pending, None
                if document is None:
                    if self._closed:
                        return
                    continue  # it was written meanwhile
                self._busy = True
            failure: Exception | None = None
            try:
                self._save(document)
            except Exception as error:  # reported; the thread must live on
                failure = error
            last = time.monotonic()
            self.error = failure
            self.n_saved += failure is None
            try:
                if self._on_done is not None:
                    self._on_done(failure)
            finally:
                with self._changed:
                    self._busy = False
                    self._changed.notify_all()
