"""The machine that measurements were taken on, and the best rates it was seen to reach."""

from __future__ import annotations

import functools
import os
import platform
from importlib.metadata import version
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from glid_nb._runtime import double_precision
from studies.timing import timed

_PRODUCTS = (512, 1024)  # sizes of the matrix products whose best rate counts
_READING = 1 << 25  # numbers, more than any cache holds
_LIBRARIES = ("jax", "jaxlib", "numpy", "scipy", "glid-nb")


def machine() -> dict[str, Any]:
    """What to say about a machine beside its numbers."""
    return {
        "processor": _processor(),
        "cores": cores(),
        "system": platform.platform(),
        "python": platform.python_version(),
        "devices": [f"{d.platform}: {d.device_kind}" for d in jax.local_devices()],
        "versions": {name: version(name) for name in _LIBRARIES},
    }


def cores() -> int:
    """CPU cores that this process may run on."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _processor() -> str:
    info = Path("/proc/cpuinfo")
    if info.exists():
        for line in info.read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()


@functools.cache
@double_precision
def rates() -> dict[str, float]:
    """Best seen: flops per second of large matrix products, bytes per second of reading.

    ``float64`` and ``float32`` are flops by precision, ``bytes`` is the reading.
    """
    rng = np.random.default_rng(0)
    product = jax.jit(jnp.matmul)

    def flops(dtype: Any) -> float:
        best = 0.0
        for n in _PRODUCTS:
            x, y = (jnp.asarray(rng.normal(size=(n, n)), dtype) for _ in range(2))
            multiply = timed(lambda x=x, y=y: product(x, y).block_until_ready(), 20)
            best = max(best, 2 * n**3 / multiply["least"])
        return best

    data = jnp.asarray(rng.normal(size=_READING))
    total = jax.jit(jnp.sum)
    read = timed(lambda: total(data).block_until_ready(), 10)
    return {
        "float64": flops(jnp.float64),
        "float32": flops(jnp.float32),
        "bytes": data.nbytes / read["least"],
    }
