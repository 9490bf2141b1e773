"""The machine, and the floor that its own matrix products and memory set for an iteration."""

from __future__ import annotations

import functools
import hashlib
import os
import platform
from importlib.metadata import version
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

import glid_nb
from glid_nb._runtime import double_precision
from glid_nb.solvers.discretisation import Matrices
from studies.benchmarks.timing import timed

_PRODUCTS = (512, 1024)  # sizes of the matrix products whose best rate counts
_TIMED = ("_runtime.py", "geometry", "harmonic", "energies", "certificate", "solvers")
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
        "sources": _sources(),
    }


def _sources() -> str:
    """A digest of the code that is timed: two states of it can have one version."""
    digest, package = hashlib.sha256(), Path(glid_nb.__file__).parent
    for name in _TIMED:
        place = package / name
        for path in [place] if place.is_file() else sorted(place.rglob("*.py")):
            digest.update(path.read_bytes())
    return digest.hexdigest()[:12]


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
def floor(matrices: Matrices, n_unknowns: int, lines: float) -> dict[str, float]:
    """Seconds that one iteration takes at least on this machine, by part.

    ``products``: for each of its ``lines`` (a step and its corrections) the basis matrices are read
    once for the direction and, at the energy's nodes, once more for the gradient; the Hessian reads
    its own and the certificate its remainders once. ``hessian``: twelve real products of (c, h) by
    (h, c), in the precision of the stored basis. ``factor``: Cholesky factor of so many unknowns at
    the best rate of products, and for each line two triangular solves, which read it.
    """
    rate = rates()
    columns, h = matrices.whitened.shape[0] // 2, matrices.whitened.shape[1]
    flops = 12 * 2 * h * columns**2
    line = 8 * (2 * matrices.nodes.size + matrices.slopes.size)
    once = 8 * matrices.remainder.size + matrices.whitened.nbytes
    solves = lines * 2 * 8 * n_unknowns**2 / 2
    return {
        "products": (lines * line + once) / rate["bytes"],
        "hessian": flops / rate[str(matrices.whitened.dtype)],
        "factor": n_unknowns**3 / 3 / rate["float64"] + solves / rate["bytes"],
    }


def factor_flops(n: int) -> float:
    """Of a Cholesky factorisation and two triangular solves."""
    return n**3 / 3 + 2 * n**2
