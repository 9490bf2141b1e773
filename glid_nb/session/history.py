"""Undo and redo: a list of values and a place in it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Generic, TypeVar

S = TypeVar("S")

MOST_STEPS = 500
"""Undo reaches this far back."""


@dataclass(frozen=True, eq=False)
class History(Generic[S]):
    """What was, what is, and what was undone; immutable like its states."""

    present: S
    past: tuple[S, ...] = ()
    future: tuple[S, ...] = ()
    """The state that a redo brings back first comes first."""

    def step(self, state: S) -> History[S]:
        """``state`` follows the present; what was undone is forgotten."""
        return History(state, (*self.past, self.present)[-MOST_STEPS:])

    def step_from(self, before: S, state: S) -> History[S]:
        """``state`` as one step from ``before``, which the present has since left in small ones."""
        return replace(self, present=before).step(state)

    def refined(self, state: S) -> History[S]:
        """``state`` in place of the present, which is no step of the user's."""
        return replace(self, present=state)

    def undone(self) -> History[S]:
        """One step back; itself at the beginning."""
        if not self.past:
            return self
        *past, present = self.past
        return History(present, tuple(past), (self.present, *self.future))

    def redone(self) -> History[S]:
        """One step forward again; itself at the end."""
        if not self.future:
            return self
        present, *future = self.future
        return History(present, (*self.past, self.present), tuple(future))
