"""What the benchmarks are to reach. Times in seconds, memory in bytes."""

from __future__ import annotations

REX = "rex"
"""The shape that most goals name: 99 coefficients, one hole."""
CORES = 2
"""CPU cores that the goals are for."""

PAPER_ITERATION = 13e-3
"""One iteration of ``paper`` on rex, certificate included."""
FLOOR_FACTOR = 2.0
"""The same over the floor that the machine sets for it."""
DEFAULT_ITERATION = 6e-3
"""One iteration of ``default`` on rex."""
CAGE_VERTICES, CAGE_ITERATION = 224, 50e-3
"""One iteration of ``default`` on a cage with so many vertices."""
MEDIAN_RATIO, LEAST_RATIO = 5.0, 2.5
"""``paper`` over ``default``, from the identity to the gap: median of all shapes, and the least."""
IDENTITY = 80e-3
"""``default`` from the identity to the gap on rex."""
DRAG_STEP = 20e-3
"""A drag step on rex."""
GPU_ITERATION = 1.5e-3
"""One iteration of ``default`` on a GPU, on every shape."""
LARGEST_CAGE, MEMORY = 1000, 2e9
"""Bytes that a process may take at most for a cage of so many vertices."""
COMPILED_AGAIN = 0
"""Programs compiled when targets move, handles are added up to the bucket, panels split or an
energy's parameter changes."""

PUBLISHED_SECONDS = 72e-3
"""Rex from the identity on the paper's GPU."""
