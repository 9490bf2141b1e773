"""The method as it is offered."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from glid_nb.energies import Energy
from glid_nb.methods.bdhm.bounds import DistortionBounds
from glid_nb.methods.bdhm.solve import bdhm
from glid_nb.methods.method import Inputs, Method
from glid_nb.methods.recording import record
from glid_nb.methods.result import MethodResult

TOLERANCE = 1e-5
"""The share of the energy that a program may still promise to gain where the method has converged.

The energy itself may be some twenty times that above its least, for the method is of first order.
"""


def bounded(
    inputs: Inputs,
    k: float = 0.8,
    sigma1: float = 5.0,
    sigma2: float = 0.3,
    tolerance: float = TOLERANCE,
) -> MethodResult:
    """ARAP within bounds by cone programs with fixed frames (Chen & Weber 2015)."""
    bounds = DistortionBounds(k, sigma1, sigma2)
    run = bdhm(
        inputs.domain,
        inputs.pose,
        inputs.p2p_weight,
        bounds,
        inputs.align,
        tolerance,
        inputs.harmonic_start,
    )
    return record(inputs.method, run, inputs.pose, inputs.max_iterations, inputs.callback)


def _check_bounds(_: Energy, settings: Mapping[str, Any]) -> None:
    DistortionBounds(settings["k"], settings["sigma1"], settings["sigma2"])


METHODS = (
    Method(
        "bdhm",
        "Bounded distortion harmonic maps",
        "harmonic",
        "ARAP within given bounds on k, sigma_1 and sigma_2 by cone programs (Clarabel).",
        bounded,
        max_iterations=200,
        energies=("arap",),
        package="clarabel",
        restrict=_check_bounds,
    ),
)
