"""A thread that always does the latest task: what was overtaken before it began is forgotten."""

from __future__ import annotations

import sys
import threading
import time
import weakref
from collections.abc import Callable
from typing import Any, Generic, TypeVar

T = TypeVar("T")


class LatestWins(Generic[T]):
    """Calls a function in a thread with the task that was submitted last.

    An exception goes to :func:`threading.excepthook`, and the thread lives on. It starts with the
    first task, and ends when this is closed, when its owner is gone, or with the process.

    Parameters
    ----------
    work : callable
        Called with a task and this worker, whose ``overtaken`` and ``cancelled`` tell a long task
        when to end early. It must not keep the owner alive: see :func:`weakly`.
    owner : object
        What the thread works for.
    name : str
        The thread's.
    interval : float
        Least number of seconds from the end of a task to the beginning of the next.
    finish : bool
        Whether closing does what is pending first, rather than forgetting it.
    """

    def __init__(
        self,
        work: Callable[[T, LatestWins[T]], Any],
        owner: object,
        name: str,
        *,
        interval: float = 0.0,
        finish: bool = False,
    ) -> None:
        self._work, self._name, self._interval, self._finish = work, name, interval, finish
        self._changed = threading.Condition()
        # The pending task, and whether it is done although the worker is paused.
        self._pending: tuple[T, bool] | None = None
        self._busy = self._cancelled = self._paused = self._hurried = self._closed = False
        self._ended = -float("inf")
        self._thread: threading.Thread | None = None
        # At the end of the process too, before the interpreter is torn down under the thread.
        self._finalizer = weakref.finalize(owner, self._close)

    def submit(self, task: T, *, at_once: bool = False) -> None:
        """Do this instead of what is pending; returns at once. ``at_once``: also while paused.

        Once this is closed nothing happens.
        """
        with self._changed:
            if self._closed:
                return
            self._pending = (task, at_once)
            if self._thread is None:
                self._thread = threading.Thread(target=self._run, name=self._name, daemon=True)
                self._thread.start()
            self._changed.notify_all()

    def cancel(self) -> None:
        """Forget what is pending, and ask what is being done to end early."""
        with self._changed:
            self._pending, self._cancelled = None, self._busy
            self._changed.notify_all()

    def wait(self, timeout: float | None = None) -> bool:
        """Wait until there is nothing left to do; whether that came within ``timeout`` seconds."""
        with self._changed:
            return self._changed.wait_for(
                lambda: self._closed or not (self._busy or self._due()), timeout
            )

    def hurry(self, timeout: float | None = None) -> bool:
        """As :meth:`wait`, and what is pending does not wait for the interval."""
        with self._changed:
            self._hurried = True
            self._changed.notify_all()
            try:
                return self.wait(timeout)
            finally:
                self._hurried = False

    @property
    def busy(self) -> bool:
        """Whether something is being done and was not cancelled, or waits to be done."""
        with self._changed:
            return (self._busy and not self._cancelled) or self._due()

    @property
    def cancelled(self) -> bool:
        """Whether what is being done is not wanted any more."""
        return self._closed or self._cancelled

    @property
    def overtaken(self) -> bool:
        """Whether what is being done should make room: for a newer task, or a pause."""
        with self._changed:
            return self.cancelled or self._paused or self._pending is not None

    @property
    def paused(self) -> bool:
        """While paused, tasks wait, but for those that were submitted ``at_once``."""
        return self._paused

    @paused.setter
    def paused(self, value: bool) -> None:
        with self._changed:
            self._paused = value
            self._changed.notify_all()

    @property
    def thread(self) -> threading.Thread | None:
        """The thread; None before the first task."""
        return self._thread

    @property
    def alive(self) -> bool:
        """Whether the thread runs."""
        return self._thread is not None and self._thread.is_alive()

    @property
    def closed(self) -> bool:
        """Whether this was closed."""
        return self._closed

    def close(self) -> None:
        """End the thread and wait for that; submitting does nothing from then on."""
        self._finalizer()

    def _close(self) -> None:
        with self._changed:
            self._closed = True
            self._changed.notify_all()
            thread = self._thread
        if thread is not None and thread is not threading.current_thread():
            thread.join()

    def _due(self) -> bool:
        return self._pending is not None and (not self._paused or self._pending[1])

    def _next(self) -> tuple[T] | None:
        """The next task, once it is time for it; None when there will be none."""
        with self._changed:
            while True:
                self._changed.wait_for(lambda: self._closed or self._due())
                rest = self._ended + self._interval - time.monotonic()
                self._changed.wait_for(lambda: self._closed or self._hurried, max(rest, 0.0))
                if self._closed and not (self._finish and self._pending):
                    return None
                if self._pending is not None and (self._closed or self._due()):
                    (task, _), self._pending = self._pending, None
                    self._busy = True
                    return (task,)

    def _run(self) -> None:
        while (taken := self._next()) is not None:
            try:
                self._work(*taken, self)
            except Exception:  # reported as any thread's, and this one goes on
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
