"""What the models of the editor share: a lock, and observers that are told of changes."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

Observer = Callable[[str], None]


class Observed:
    """A model that several threads may use, and that tells observers of its changes by name.

    Each model has one lock; its views draw while they hold it. Observers are told, in the thread
    that made the changes, once that thread has released it, so they may lock whatever they need.
    """

    def __init__(self) -> None:
        self._lock = threading.RLock()
        self._depth = 0
        self._observers: list[Observer] = []
        self._due: list[Callable[[], None]] = []
        self._news: dict[str, None] = {}  # in order, each once

    @contextmanager
    def locked(self) -> Iterator[None]:
        """Nobody else changes the model meanwhile: what is read here belongs together."""
        self._lock.acquire()
        self._depth += 1
        due: list[Callable[[], None]] = []
        news: tuple[str, ...] = ()
        try:
            yield
        finally:
            self._depth -= 1
            if not self._depth:
                due, self._due = self._due, []
                news, self._news = tuple(self._news), {}
            self._lock.release()
            for act in due:
                act()
            self._announce(*news)

    def observe(self, observer: Observer) -> Callable[[], None]:
        """Call ``observer`` with the name of every change; returns what ends that."""
        with self.locked():
            self._observers.append(observer)

        def end() -> None:
            with self.locked():
                if observer in self._observers:
                    self._observers.remove(observer)

        return end

    def _tell(self, *names: str) -> None:
        """Tell observers of these changes, once the lock is released. It must be held."""
        assert self._depth
        self._news.update(dict.fromkeys(names))

    def _announce(self, *names: str) -> None:
        """Tell observers of these changes now."""
        for observer in tuple(self._observers) if names else ():
            for name in names:
                observer(name)

    def _afterwards(self, act: Callable[[], None]) -> None:
        """Do this once the lock is released, before observers are told. It must be held."""
        assert self._depth
        self._due.append(act)
