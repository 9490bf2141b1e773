"""How a solve, and one compiled call of it, can end."""

from enum import Enum
from typing import Self

# How a call can end, as integers that a device program can return.
RUNNING, CONVERGED, NO_DECREASE, REFUSED, INDEFINITE, BLOCKED, PENDING = range(7)


class Status(Enum):
    """Outcome of a solve; every member's value is a word and its ``message`` a full sentence."""

    CONVERGED = ("converged", "The solver converged: the Newton decrement is below the tolerance.")
    STATIONARY = (
        "stationary",
        "The solver converged as far as double precision allows: no step lowers the energy.",
    )
    MAX_ITERATIONS = "max_iterations", "The solver stopped at the maximal number of iterations."
    STOPPED = "stopped", "The solver was stopped from outside."
    BLOCKED = (
        "blocked",
        "No further step could be proved locally injective; the last certified map is returned.",
    )
    INDEFINITE = (
        "indefinite",
        "The Hessian is not positive definite and modifying it was not allowed; the last "
        "certified map is returned.",
    )

    UNPROVED = (
        "unproved",
        "No map that the solver reached could be proved locally injective; the certified map that "
        "it was to start from is returned.",
    )

    message: str

    def __new__(cls, value: str, message: str) -> Self:
        member = object.__new__(cls)
        member._value_, member.message = value, message
        return member

    @property
    def ok(self) -> bool:
        """Whether a local minimum was reached."""
        return self in (Status.CONVERGED, Status.STATIONARY)
