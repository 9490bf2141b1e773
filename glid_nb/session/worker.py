"""A thread that does the latest task and drops those that were replaced before they began."""

from __future__ import annotations

import atexit
import functools
import sys
import threading
import time
import weakref
from collections.abc import Callable
from typing import Any, Generic, TypeVar

T = TypeVar("T")


class LatestWins(Generic[T]):
    """Calls a function in a thread with the task that was submitted last.

    The thread starts with the first task, and ends when this is closed, when its owner is gone, or
    with the process. Exceptions go to :func:`threading.excepthook`; the thread goes on.

    ``work`` is called with a task and this worker; a long task ends early when ``overtaken`` or
    ``cancelled`` say so. It must not keep the ``owner``, for whom it works, alive: see
    :func:`weakly`. From the end of a task to the beginning of the next ``interval`` seconds pass.
    Closing drops the pending task, or does it first with ``finish``; it waits for the running one
    if it ``waits``. The end of the process waits in any case.
    """

    def __init__(
        self,
        work: Callable[[T, LatestWins[T]], Any],
        owner: object,
        name: str,
        *,
        interval: float = 0.0,
        finish: bool = False,
        waits: bool = True,
    ) -> None:
        self._work, self._name, self._interval, self._finish = work, name, interval, finish
        self._waits = waits
        self._changed = threading.Condition()
        # The pending task, and whether it is done although the worker is paused.
        self._pending: tuple[T, bool] | None = None
        self._busy = self._cancelled = self._paused = self._hurried = False
        self.closed = False
        """Whether this was closed."""
        self.thread: threading.Thread | None = None
        """The thread; None before the first task."""
        self._ended = -float("inf")
        self._finalizer = weakref.finalize(owner, self._close)

    def submit(self, task: T, *, at_once: bool = False) -> None:
        """Do this instead of the pending task, ``at_once`` also while paused; returns at once.

        A closed worker ignores it.
        """
        with self._changed:
            if self.closed:
                return
            self._pending = (task, at_once)
            if self.thread is None:
                self.thread = threading.Thread(target=self._run, name=self._name, daemon=True)
                self.thread.start()
            self._changed.notify_all()

    def cancel(self) -> None:
        """Drop the pending task, and ask the running one to end early."""
        with self._changed:
            self._pending, self._cancelled = None, self._busy
            self._changed.notify_all()

    def wait(self, timeout: float | None = None) -> bool:
        """Wait until there is nothing to do; whether that is within ``timeout`` seconds."""
        with self._changed:
            return self._changed.wait_for(
                lambda: self.closed or not (self._busy or self._due()), timeout
            )

    def hurry(self, timeout: float | None = None) -> bool:
        """As :meth:`wait`, but the pending task does not wait for the interval."""
        with self._changed:
            self._hurried = True
            self._changed.notify_all()
            try:
                return self.wait(timeout)
            finally:
                self._hurried = False

    @property
    def busy(self) -> bool:
        """Whether a task runs that was not cancelled, or one is due."""
        with self._changed:
            return (self._busy and not self._cancelled) or self._due()

    @property
    def cancelled(self) -> bool:
        """Whether the running task was cancelled, or this is closed."""
        return self.closed or self._cancelled

    @property
    def overtaken(self) -> bool:
        """Whether the running task should end: cancelled, paused, or a newer one waits."""
        with self._changed:
            return self.cancelled or self._paused or self._pending is not None

    @property
    def paused(self) -> bool:
        """While paused, only tasks that were submitted ``at_once`` are done."""
        return self._paused

    @paused.setter
    def paused(self, value: bool) -> None:
        with self._changed:
            self._paused = value
            self._changed.notify_all()

    def close(self) -> None:
        """End the thread; later tasks are ignored."""
        self._finalizer()

    def _close(self, at_exit: bool = False) -> None:
        with self._changed:
            self.closed = True
            self._changed.notify_all()
            thread = self.thread
        if thread not in (None, threading.current_thread()) and (self._waits or at_exit):
            thread.join()

    def _due(self) -> bool:
        return self._pending is not None and (not self._paused or self._pending[1])

    def _next(self) -> tuple[T] | None:
        """Wait for the next task; None once this is closed."""
        with self._changed:
            while True:
                self._changed.wait_for(lambda: self.closed or self._due())
                rest = self._ended + self._interval - time.monotonic()
                self._changed.wait_for(lambda: self.closed or self._hurried, max(rest, 0.0))
                if self.closed and not (self._finish and self._pending):
                    return None
                if self._pending is not None and (self.closed or self._due()):
                    (task, _), self._pending = self._pending, None
                    self._busy = True
                    return (task,)

    def _run(self) -> None:
        # A compiler that is still at work must not outlive the interpreter.
        end = functools.partial(self._close, at_exit=True)
        atexit.register(end)
        try:
            self._do_all()
        finally:
            atexit.unregister(end)

    def _do_all(self) -> None:
        while (taken := self._next()) is not None:
            try:
                self._work(*taken, self)
            except Exception:  # reported like that of any thread, but this thread goes on
                arguments = (*sys.exc_info(), threading.current_thread())
                threading.excepthook(threading.ExceptHookArgs(arguments))
            finally:
                del taken
                with self._changed:
                    self._ended = time.monotonic()
                    self._busy = self._cancelled = False
                    self._changed.notify_all()


def weakly(method: Callable[..., Any]) -> Callable[..., Any]:
    """A bound method that does not keep its object alive, and does nothing once that is gone."""
    reference = weakref.WeakMethod(method)

    def call(*arguments: Any) -> Any:
        bound = reference()
        return None if bound is None else bound(*arguments)

    return call
