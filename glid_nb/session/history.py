"""Undo and redo: a list of values and a place in it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Generic, TypeVar

S = TypeVar("S")

MOST_STEPS = 500
"""Undo reaches this far back."""


@dataclass(frozen=True, eq=False)
class History(Generic[S]):
    """What was, what is, and what was undone; immutable like its states.

    A gesture, such as a drag, makes many states and one step: those that name the same gesture
    directly after one another.
    """

    present: S
    past: tuple[S, ...] = ()
    future: tuple[S, ...] = ()
    """The state that a redo brings back first comes first."""
    gesture: Any = None
    """What made the present and may go on; None for a step that is complete."""
    origin: History[S] | None = None
    """What was before the gesture."""

    def step(self, state: S, gesture: Any = None) -> History[S]:
        """``state`` follows the present, or replaces it within the same gesture.

        What was undone is forgotten.
        """
        if gesture is not None and gesture == self.gesture:
            return self.refined(state)
        origin = None if gesture is None else self.ended()
        past = (*self.past, self.present)[-MOST_STEPS:]
        return History(state, past, gesture=gesture, origin=origin)

    def refined(self, state: S) -> History[S]:
        """``state`` in place of the present, which is no step of the user's."""
        return replace(self, present=state)

    def ended(self) -> History[S]:
        """The same after the gesture: what comes next is another step."""
        return self if self.gesture is None else replace(self, gesture=None, origin=None)

    def cancelled(self) -> History[S]:
        """As if the gesture that goes on had never begun; itself where there is none."""
        return self if self.origin is None else self.origin

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
