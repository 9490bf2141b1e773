"""Saving while somebody works: in the background, not too often, always the latest."""

from __future__ import annotations

import threading
import time
import weakref
from collections.abc import Callable
from pathlib import Path

from glid_nb.session.document import Document, save_document

INTERVAL = 3.0
"""Least number of seconds between two saves, by default."""


class Autosave:
    """Saves the document that was submitted last, at most once per interval.

    The file is written by a thread of its own, atomically; a document that was overtaken by a later
    one is never written. What is pending when the process ends, or when this object is dropped, is
    written then.

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
        self.path = Path(path)
        self._worker = _Worker(self.path, interval, on_done)
        _all.add(self)
        # Also at the end of the process.
        self._finalizer = weakref.finalize(self, self._worker.close)

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


class _Worker:
    """The thread and what it shares; it does not know the `Autosave`, so that one can be dropped.

    The thread starts with the first document and ends when it is closed.
    """

    def __init__(
        self, path: Path, interval: float, on_done: Callable[[Exception | None], None] | None
    ) -> None:
        self._path, self._interval, self._on_done = path, interval, on_done
        self._changed = threading.Condition()
        self._pending: Document | None = None
        self._hurry = self._busy = self._closed = False
        self._thread: threading.Thread | None = None
        self.error: Exception | None = None
        self.n_saved = 0

    def submit(self, document: Document) -> None:
        with self._changed:
            if self._closed:
                raise RuntimeError(f"the autosave of {self._path} is closed")
            self._pending = document
            if self._thread is None:
                self._thread = threading.Thread(
                    target=self._run, name=f"autosave {self._path.name}", daemon=True
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
                    return
                self._busy = True
            failure: Exception | None = None
            try:
                save_document(document, self._path)
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
