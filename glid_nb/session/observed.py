"""The base class of the editor's models: a lock, and observers of changes."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

Observer = Callable[[str], None]


class Observed:
    """A model that several threads may use, and that reports its changes by name to observers.

    Each model has one lock, which its views hold while they draw. Observers are called by the
    thread that made the changes, after it has released the lock, so they may take other locks.
    """

    def __init__(self) -> None:
        self._lock = threading.RLock()
        self._depth = 0
        self._observers: list[Observer] = []
        self._actions: list[Callable[[], None]] = []
        self._changes: dict[str, None] = {}  # in order, each once

    @contextmanager
    def locked(self) -> Iterator[None]:
        """Hold the lock, so that what is read belongs to one moment."""
        self._lock.acquire()
        self._depth += 1
        actions: list[Callable[[], None]] = []
        changes: tuple[str, ...] = ()
        try:
            yield
        finally:
            self._depth -= 1
            if not self._depth:
                actions, self._actions = self._actions, []
                changes, self._changes = tuple(self._changes), {}
            self._lock.release()
            for act in actions:
                act()
            self._announce(*changes)

    def observe(self, observer: Observer) -> Callable[[], None]:
        """Call ``observer`` with the name of every change; returns a function that ends this."""
        with self.locked():
            self._observers.append(observer)

        def end() -> None:
            with self.locked():
                if observer in self._observers:
                    self._observers.remove(observer)

        return end

    def _tell(self, *names: str) -> None:
        """Report these changes once the lock, which must be held, is released."""
        assert self._depth
        self._changes.update(dict.fromkeys(names))

    def _announce(self, *names: str) -> None:
        """Report these changes now."""
        for observer in tuple(self._observers) if names else ():
            for name in names:
                observer(name)

    def _afterwards(self, act: Callable[[], None]) -> None:
        """Call ``act`` once the lock, which must be held, is released, before observers."""
        assert self._depth
        self._actions.append(act)
