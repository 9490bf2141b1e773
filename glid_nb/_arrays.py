"""Types of arrays."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

if TYPE_CHECKING:
    import jax

AnyArray: TypeAlias = "jax.Array | np.ndarray[Any, Any]"
"""An array on the device or on the host: data for compiled programs may be either."""
