"""How a compiled call of the solver can end, as integers that a device program can return."""

RUNNING, CONVERGED, NO_DECREASE, REFUSED, INDEFINITE, BLOCKED, PENDING = range(7)
