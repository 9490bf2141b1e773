"""The machine, and the floor that its own matrix products and memory set for an iteration."""

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
from jax import lax

from glid_nb._runtime import double_precision, single_blas_thread
from glid_nb.benchmarks.timing import timed
from glid_nb.solvers.discretisation import Matrices

_LIBRARIES = ("jax", "jaxlib", "numpy", "scipy", "glid-nb")


def machine() -> dict[str, Any]:
    """What to say about a machine beside its numbers."""
    return {
        "processor": _processor(),
        "cores": os.cpu_count(),
        "system": platform.platform(),
        "python": platform.python_version(),
        "devices": [f"{d.platform}: {d.device_kind}" for d in jax.local_devices()],
        "versions": {name: version(name) for name in _LIBRARIES},
    }


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
    """Best seen: flops per second of a large matrix product, bytes per second of reading.

    ``float64`` and ``float32`` are flops by precision, ``bytes`` is the reading.
    """
    rng = np.random.default_rng(0)
    a = rng.normal(size=(512, 2048))
    product = jax.jit(lambda x: x @ x.T)

    def flops(dtype: Any) -> float:
        x = jnp.asarray(a, dtype)
        multiply = timed(lambda: product(x).block_until_ready(), 20)
        return 2 * 512 * 512 * 2048 / multiply["least"]

    # Larger than any cache.
    data = jnp.asarray(rng.normal(size=(1 << 25,)))
    total = jax.jit(jnp.sum)
    read = timed(lambda: total(data).block_until_ready(), 10)
    return {
        "float64": flops(jnp.float64),
        "float32": flops(jnp.float32),
        "bytes": data.nbytes / read["least"],
    }


@double_precision
def floor(matrices: Matrices, n_unknowns: int) -> dict[str, float]:
    """Seconds that one iteration takes at least on this machine, by part.

    ``products``: the basis matrices are read once for the direction and, at the energy's nodes,
    once more for the gradient, and the certificate reads its remainders. ``hessian``: twelve real
    products of (c, h) by (h, c), in the precision of the stored basis. ``factor``: Cholesky factor
    and two triangular solves, timed at this size.
    """
    rate = rates()
    columns, h = matrices.whitened.shape[0] // 2, matrices.whitened.shape[1]
    flops = 12 * 2 * h * columns**2
    read = 8 * (2 * matrices.nodes.size + matrices.slopes.size + matrices.remainder.size)
    return {
        "products": (read + matrices.whitened.nbytes) / rate["bytes"],
        "hessian": flops / rate[str(matrices.whitened.dtype)],
        "factor": _factor(n_unknowns),
    }


@functools.cache
def _factor(n: int) -> float:
    rng = np.random.default_rng(0)
    square = rng.normal(size=(n, n))
    h = jnp.asarray(square @ square.T + n * np.eye(n))

    @jax.jit
    def solve(matrix: Any) -> Any:
        lower = lax.linalg.cholesky(matrix, symmetrize_input=False)
        return jax.scipy.linalg.cho_solve((lower, True), matrix[0])

    with single_blas_thread():
        return timed(lambda: solve(h).block_until_ready(), 20)["least"]
