"""A thread that does the latest task and drops those that were replaced before they began."""

import atexit
import functools
import sys
import threading
import time
import weakref
from collections.abc import Callable
from typing import Any, Generic, Self, TypeVar

T = TypeVar("T")


class LatestWins(Generic[T]):
    """Calls a function in a thread with the task that was submitted last.

    The thread starts with the first task, and ends when this is closed, when its owner is gone, or
    with the process. Exceptions go to :func:`threading.excepthook`; the thread goes on.

    ``work`` is called with a task and this worker; a long task ends early when ``overtaken`` or
    ``cancelled`` say so. If it keeps the ``owner`` alive (else see :func:`weakly`) this must be
    closed. ``interval`` seconds pass between two tasks. Closing drops the pending task, or does it
    first with ``finish``; it waits for the running one if it ``waits``, the end of the process
    always, the end of the owner never.
    """

    def __init__(
        self,
        work: Callable[[T, Self], Any],
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
        self._pending: tuple[T] | None = None
        self._busy = self._cancelled = self._hurried = False
        self.closed = False  # whether this was closed
        self.thread: threading.Thread | None = None  # the thread; None before the first task
        self._ended = -float("inf")
        self._finalizer = weakref.finalize(owner, self._close, False)

    def submit(self, task: T) -> None:
        """Do this instead of the pending task; returns at once. A closed worker ignores it."""
        with self._changed:
            if self.closed:
                return
            self._pending = (task,)
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
                lambda: self.closed or not (self._busy or self._pending), timeout
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
        """Whether a task runs that was not cancelled, or one is pending."""
        with self._changed:
            return (self._busy and not self._cancelled) or self._pending is not None

    @property
    def cancelled(self) -> bool:
        """Whether the running task was cancelled, or this is closed."""
        return self.closed or self._cancelled

    @property
    def overtaken(self) -> bool:
        """Whether the running task should end: cancelled, or a newer one waits."""
        with self._changed:
            return self.cancelled or self._pending is not None

    def close(self) -> None:
        """End the thread; later tasks are ignored."""
        if self._finalizer.detach():
            self._close(self._waits)

    def _close(self, waits: bool) -> None:
        with self._changed:
            self.closed = True
            self._changed.notify_all()
            thread = self.thread
        if waits and thread not in (None, threading.current_thread()):
            thread.join()

    def _next(self) -> tuple[T] | None:
        with self._changed:
            while True:
                self._changed.wait_for(lambda: self.closed or self._pending)
                rest = self._ended + self._interval - time.monotonic()
                self._changed.wait_for(lambda: self.closed or self._hurried, max(rest, 0.0))
                if self.closed and not (self._finish and self._pending):
                    return None
                if (taken := self._pending) is not None:
                    self._pending, self._busy = None, True
                    return taken

    def _run(self) -> None:
        # A compiler that is still at work must not outlive the interpreter.
        end = functools.partial(self._close, True)
        atexit.register(end)
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
        atexit.unregister(end)


def weakly(method: Callable[..., Any]) -> Callable[..., Any]:
    """A bound method that does not keep its object alive, and does nothing once that is gone."""
    reference = weakref.WeakMethod(method)

    def call(*arguments: Any) -> Any:
        bound = reference()
        return None if bound is None else bound(*arguments)

    return call
