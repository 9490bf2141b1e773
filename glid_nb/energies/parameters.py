"""Range checks of energy parameters."""

from __future__ import annotations

import math
import numbers
from typing import Any

from glid_nb._jax import jax
from glid_nb.energies.energy import EnergyError


def checked_sharpness(energy: str, s: Any) -> Any:
    """``s`` as a positive finite float, or an :class:`EnergyError` that says what is wrong.

    Inside a traced program ``s`` is a JAX tracer, whose range was checked when it was stored; it
    passes through.
    """
    if isinstance(s, bool | str) or s is None:
        raise EnergyError(f"s of the energy {energy!r} must be a positive number, got {s!r}")
    if isinstance(s, jax.Array):
        return s
    if not isinstance(s, numbers.Real):
        # JAX rebuilds values around placeholders of its own, which are plain objects.
        if type(s) is object or isinstance(s, jax.ShapeDtypeStruct):
            return s
        raise EnergyError(f"s of the energy {energy!r} must be a positive number, got {s!r}")
    value = float(s)
    if not (math.isfinite(value) and value > 0):
        raise EnergyError(f"s of the energy {energy!r} must be positive and finite, got {value}")
    return value
