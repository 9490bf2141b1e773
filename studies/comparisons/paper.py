"""The numbers that the paper prints, each with the place where it does.

Nothing here is measured by this package. Where a figure of the paper shows curves or bars without
numbers there is no entry, and the page says so.
"""

from __future__ import annotations

from typing import NamedTuple


class IterationTimes(NamedTuple):
    """A row of Table 2: unknowns, and milliseconds of one iteration."""

    unknowns: int
    newton_gpu: float
    newton_cpu: float
    newton_eigen: float
    lbfgs: float
    slim: float
    aqp: float
    aqp_start: float


TABLE_2 = {
    "deer": IterationTimes(364, 8.87, 38.8, 49.6, 54.4, 58.3, 7.84, 1239.7),
    "archery": IterationTimes(596, 15.31, 71.2, 95.1, 88.3, 59.4, 9.27, 1266.3),
    "giraffe": IterationTimes(624, 14.05, 58.1, 86.8, 54.9, 56.4, 8.27, 1182.9),
    "rex": IterationTimes(392, 11.7, 61.6, 77.6, 49.5, 57.2, 8.52, 1141.0),
    "racoon": IterationTimes(320, 7.25, 34.4, 39.9, 68.1, 53.7, 9.01, 904.6),
    "raptor": IterationTimes(416, 10.18, 45.2, 56.5, 82.3, 55.1, 8.64, 883.4),
}
"""Table 2."""


class Iterations(NamedTuple):
    """Iterations of the solvers in a figure; ``None`` where it names none."""

    figure: str
    newton: int
    halts: int | None
    """After how many iterations Newton's method halts without a modification."""
    newton_eigen: int
    lbfgs: int | None
    slim: int | None
    aqp: int | None


ITERATIONS = {
    "rex": Iterations("1", 6, 9, 32, 1818, None, None),
    None: Iterations("10", 15, 15, 35, None, 120, 400),
    "raptor": Iterations("11", 8, None, 11, 1612, 170, 188),
}
"""Figures 1, 10 and 11 by shape; the text does not name the shape of Figure 10."""

SPEED = {"newton-eigen": (25, 34), "slim": (58, 116), "aqp": (31, 39)}
"""How many times slower than its GPU solver the paper has these: Figure 10 and, from the times, of
Newton-Eigen Figure 1 and of the others Figure 11."""
SPEED_ON_CPU = {"slim": 30, "aqp": 8}
"""Against the paper's CPU solver, from the times of Figure 11."""

FIGURE_2 = {"asked": (0.8, 5.0, 0.3), "bdhm": (0.50, 4.3, 0.31), "newton": (0.32, 2.25, 0.43)}
"""k, sigma_1 and sigma_2: those asked of BDHM, and those that the maps have."""
FIGURE_2_ITERATIONS = (28, 8)
"""BDHM, ours."""
FIGURE_2_SECONDS = (3.71, 0.0297)
"""BDHM with Mosek, ours on the GPU."""
FIGURE_2_RATIO = 125

FIGURE_7_SEGMENTS = 529
FIGURE_7_RATIO = 6.74
"""Mean of BDHM's Lipschitz constants over the mean of the paper's."""
FIGURE_7_SHAPES = ("raptor", "horse")

FIGURE_8_ENOUGH = 400
"""Hessian samples from which on the rate of convergence is that of 50,000."""
FIGURE_8_MOST, FIGURE_8_SLOWER = 50_000, 3
"""Samples of the slowest run, and how many times slower it is."""
