"""Base classes of the editor's models: undo, a lock, and observers of changes."""

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Any, Generic, Self, TypeVar

S = TypeVar("S")
Observer = Callable[[str], None]

MOST_STEPS = 500  # most steps that undo goes back


@dataclass(frozen=True, eq=False)
class History(Generic[S]):
    """The past, present and undone states. A history is immutable, as the states are.

    Consecutive steps of the same gesture, such as the moves of one drag, are one step for undo.
    """

    present: S
    past: tuple[S, ...] = ()
    future: tuple[S, ...] = ()  # the states that redo restores, the next one first
    gesture: Any = None  # the unfinished gesture that made the present; None for a complete step
    origin: Self | None = None  # the history before the gesture

    def step(self, state: S, gesture: Any = None) -> Self:
        """Add ``state``; within the same gesture, replace the present. Clears redo."""
        if gesture is not None and gesture == self.gesture:
            return self.amended(state)
        origin = None if gesture is None else self.ended()
        past = (*self.past, self.present)[-MOST_STEPS:]
        return type(self)(state, past, gesture=gesture, origin=origin)

    def amended(self, state: S) -> Self:
        """Replace the present without a step for undo."""
        return replace(self, present=state)

    def ended(self) -> Self:
        """End the gesture, so that the next state is another step."""
        return self if self.gesture is None else replace(self, gesture=None, origin=None)

    def cancelled(self) -> Self:
        """The history before the gesture; itself without a gesture."""
        return self if self.origin is None else self.origin

    def undone(self) -> Self:
        """The history one step back; itself at the beginning."""
        if not self.past:
            return self
        *past, present = self.past
        return type(self)(present, tuple(past), (self.present, *self.future))

    def redone(self) -> Self:
        """The history one step forward; itself at the end."""
        if not self.future:
            return self
        present, *future = self.future
        return type(self)(present, (*self.past, self.present), tuple(future))


class Observed:
    """A model with one lock for several threads, and observers that get the names of changes.

    The thread that makes a change calls the observers after it has released the lock. So observers
    may take other locks.
    """

    def __init__(self) -> None:
        self._lock = threading.RLock()
        self._depth = 0
        self._observers: list[Observer] = []
        self._changes: dict[str, None] = {}  # an ordered set

    @contextmanager
    def locked(self) -> Iterator[None]:
        """Hold the lock, so that all values read belong to the same moment."""
        self._lock.acquire()
        self._depth += 1
        changes: tuple[str, ...] = ()
        try:
            yield
        finally:
            self._depth -= 1
            if not self._depth:
                changes, self._changes = tuple(self._changes), {}
            self._lock.release()
            self._announce(*changes)

    def observe(self, observer: Observer) -> Callable[[], None]:
        """Call ``observer`` with the name of every change. Returns a function that ends this."""
        with self.locked():
            self._observers.append(observer)

        def end() -> None:
            with self.locked():
                if observer in self._observers:
                    self._observers.remove(observer)

        return end

    def tell(self, *names: str) -> None:
        """Report these changes once the lock is released."""
        with self.locked():
            self._changes.update(dict.fromkeys(names))

    def _announce(self, *names: str) -> None:
        for observer in tuple(self._observers) if names else ():
            for name in names:
                observer(name)


class Undoable(Observed, Generic[S]):
    """An observed model that has a state and its undo history."""

    def __init__(self, state: S) -> None:
        super().__init__()
        self.history = History(state)  # the undo history

    @property
    def state(self) -> S:
        """The present state."""
        return self.history.present

    @property
    def can_undo(self) -> bool:
        """Whether there is something to undo."""
        return bool(self.history.past)

    @property
    def can_redo(self) -> bool:
        """Whether there is something to redo."""
        return bool(self.history.future)

    def undo(self) -> bool:
        """Go one step back. Returns whether there was one."""
        with self.locked():
            return self._go_to(self.history.undone())

    def redo(self) -> bool:
        """Go one step forward again. Returns whether there was one."""
        with self.locked():
            return self._go_to(self.history.redone())

    def _go_to(self, history: History[S]) -> bool:
        """Replace the history. Returns whether it is another one."""
        changes = history is not self.history
        if changes:
            self.history = history
            self.tell("state")
        return changes
