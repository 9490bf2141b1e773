"""How a solve, and one compiled call of it, can end."""

from __future__ import annotations

from enum import Enum

# How a call can end, as integers that a device program can return.
RUNNING, CONVERGED, NO_DECREASE, REFUSED, INDEFINITE, BLOCKED, PENDING = range(7)


class Status(Enum):
    """Outcome of a solve; every member's value is a word and its ``message`` a full sentence."""

    CONVERGED = "converged"
    STATIONARY = "stationary"
    MAX_ITERATIONS = "max_iterations"
    STOPPED = "stopped"
    BLOCKED = "blocked"
    INDEFINITE = "indefinite"

    @property
    def message(self) -> str:
        """What happened, in a sentence for the user."""
        return _MESSAGES[self]

    @property
    def ok(self) -> bool:
        """Whether a local minimum was reached."""
        return self in (Status.CONVERGED, Status.STATIONARY)


_MESSAGES = {
    Status.CONVERGED: "The solver converged: the Newton decrement is below the tolerance.",
    Status.STATIONARY: (
        "The solver converged as far as double precision allows: no step lowers the energy."
    ),
    Status.MAX_ITERATIONS: "The solver stopped at the maximal number of iterations.",
    Status.STOPPED: "The solver was stopped from outside.",
    Status.BLOCKED: (
        "No further step could be proved locally injective; the last certified map is returned."
    ),
    Status.INDEFINITE: (
        "The Hessian is not positive definite and modifying it was not allowed; the last "
        "certified map is returned."
    ),
}
