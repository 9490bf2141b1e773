"""Work that may lag behind: done in a thread, not too often, always for the latest state."""

from __future__ import annotations

import sys
import threading
import time
import weakref
from collections.abc import Callable
from typing import Any


class Background:
    """Calls a method in a thread after it was asked to, at most once per interval.

    An exception goes to :func:`threading.excepthook`; what is asked for after it is done again.

    Parameters
    ----------
    work : bound method
        Called without arguments; its object is not kept alive by this.
    interval : float
        Least number of seconds between two calls.
    """

    def __init__(self, work: Callable[[], Any], interval: float) -> None:
        self._worker = _Worker(weakref.WeakMethod(work), interval)
        self._finalizer = weakref.finalize(self, self._worker.close)

    def ask(self) -> None:
        """Have the work done soon; returns at once."""
        self._worker.ask()

    def wait(self, timeout: float | None = None) -> bool:
        """Wait until everything that was asked for is done."""
        return self._worker.wait(timeout)

    def close(self) -> None:
        """End the thread; what was asked for is left undone."""
        self._finalizer()


class _Worker:
    """The thread and what it shares."""

    def __init__(self, work: weakref.WeakMethod[Any], interval: float) -> None:
        self._work, self._interval = work, interval
        self._changed = threading.Condition()
        self._wanted = self._busy = self._closed = False
        self._thread: threading.Thread | None = None

    def ask(self) -> None:
        with self._changed:
            if self._closed:
                return
            self._wanted = True
            if self._thread is None:
                self._thread = threading.Thread(target=self._run, name="background", daemon=True)
                self._thread.start()
            self._changed.notify_all()

    def wait(self, timeout: float | None) -> bool:
        with self._changed:
            return self._changed.wait_for(
                lambda: self._closed or not (self._wanted or self._busy), timeout
            )

    def close(self) -> None:
        with self._changed:
            self._closed, self._wanted = True, False
            self._changed.notify_all()
            thread = self._thread
        if thread is not None and thread is not threading.current_thread():
            thread.join()

    def _run(self) -> None:
        last = -float("inf")
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._wanted or self._closed)
                due = last + self._interval
                self._changed.wait_for(lambda: self._closed, max(0.0, due - time.monotonic()))
                if self._closed:
                    return
                self._wanted, self._busy = False, True
            work = self._work()
            try:
                if work is None:
                    return
                work()
            except Exception:  # reported as any thread's, and this one goes on
                arguments = (*sys.exc_info(), threading.current_thread())
                threading.excepthook(threading.ExceptHookArgs(arguments))
            finally:
                del work
                last = time.monotonic()
                with self._changed:
                    self._busy = False
                    self._changed.notify_all()
