"""Types of arrays."""

from __future__ import annotations

from typing import Any, TypeAlias

import jax
import numpy as np

AnyArray: TypeAlias = jax.Array | np.ndarray[Any, Any]
"""An array on the device or on the host: data for compiled programs may be either."""
