"""A thread that runs the latest task and drops tasks that were replaced before they began."""

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
    """Calls a function in a thread with the last submitted task.

    The thread starts with the first task. It ends when the worker is closed, when its owner is
    deleted, or with the process. Exceptions go to :func:`threading.excepthook`, and the thread
    continues.

    ``work`` is called with a task and this worker. A long task must check ``overtaken`` or
    ``cancelled`` and end early. If ``work`` keeps the ``owner`` alive, the worker must be closed;
    :func:`weakly` avoids this. ``interval`` seconds pass between two tasks. Closing drops the
    pending task, or runs it first with ``finish``. With ``waits``, closing waits for the running
    task. The end of the process always waits for it, the end of the owner never.
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
        """Replace the pending task; returns at once. A closed worker ignores the task."""
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
        """Wait until there is nothing to do. Returns False after ``timeout`` seconds."""
        with self._changed:
            return self._changed.wait_for(
                lambda: self.closed or not (self._busy or self._pending), timeout
            )

    def hurry(self, timeout: float | None = None) -> bool:
        """Like :meth:`wait`, but the pending task does not wait for the interval."""
        with self._changed:
            self._hurried = True
            self._changed.notify_all()
            try:
                return self.wait(timeout)
            finally:
                self._hurried = False

    @property
    def busy(self) -> bool:
        """Whether a task is pending, or runs and was not cancelled."""
        with self._changed:
            return (self._busy and not self._cancelled) or self._pending is not None

    @property
    def cancelled(self) -> bool:
        """Whether the running task was cancelled, or the worker is closed."""
        return self.closed or self._cancelled

    @property
    def overtaken(self) -> bool:
        """Whether the running task should end: it was cancelled, or a newer one waits."""
        with self._changed:
            return self.cancelled or self._pending is not None

    def overtaken_within(self, seconds: float) -> bool:
        """Wait until the running task should end, at most ``seconds``. Returns whether it
        should."""
        with self._changed:
            return self._changed.wait_for(
                lambda: self.cancelled or self._pending is not None, seconds
            )

    def close(self) -> None:
        """End the thread. Later tasks are ignored."""
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
        # A running compiler must not outlive the interpreter.
        end = functools.partial(self._close, True)
        atexit.register(end)
        while (taken := self._next()) is not None:
            try:
                self._work(*taken, self)
            except Exception:  # reported as for any thread, but this thread continues
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
    """Wrap a bound method so that it does not keep its object alive. Without the object it does
    nothing."""
    reference = weakref.WeakMethod(method)

    def call(*arguments: Any) -> Any:
        bound = reference()
        return None if bound is None else bound(*arguments)

    return call
