"""The methods of this family."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from glid_nb.energies import Energy
from glid_nb.methods.method import Inputs, Method, MethodError
from glid_nb.methods.recording import record
from glid_nb.methods.result import MethodResult
from glid_nb.methods.subspace.descent import Direction, descend
from glid_nb.methods.subspace.first_order import LBFGS, MEMORY, GradientDescent, Initial
from glid_nb.methods.subspace.newton import run_newton
from glid_nb.methods.subspace.newton_variants import (
    EigenDirection,
    HessianDirection,
    LevenbergMarquardt,
    ShiftDirection,
)
from glid_nb.methods.subspace.problem import SubspaceProblem
from glid_nb.solvers import Options
from glid_nb.solvers.discretisation import CertificateKind, Sampling
from glid_nb.solvers.options import MOST_CORRECTIONS


def _descend(
    inputs: Inputs,
    direction: Direction,
    sampling: Sampling,
    certificate: CertificateKind,
    conformal: bool = False,
    tolerance: float = 1e-10,
    **more: Any,
) -> MethodResult:
    options = Options(
        sampling=sampling,
        certificate=certificate,
        p2p_weight=inputs.p2p_weight,
        conformal=conformal,
        align=inputs.align,
        tolerance=tolerance,
    )
    problem = SubspaceProblem(
        inputs.domain, inputs.pose, inputs.energy, options, inputs.harmonic_start, **more
    )
    run = descend(problem, direction)
    return record(inputs.method, run, inputs.pose, inputs.max_iterations, inputs.callback)


def newton(
    inputs: Inputs,
    sampling: Sampling = "graded",
    certificate: CertificateKind = "hermite",
    conformal: bool = False,
    tolerance: float = 1e-10,
    corrections: int = MOST_CORRECTIONS,
) -> MethodResult:
    """Ours: exact Hessian where definite, else projected."""
    return run_newton(
        inputs,
        sampling=sampling,
        certificate=certificate,
        conformal=conformal,
        tolerance=tolerance,
        corrections=corrections,
    )


def newton_paper(inputs: Inputs, conformal: bool = False, tolerance: float = 1e-10) -> MethodResult:
    """The paper's settings throughout, but for the start."""
    return run_newton(
        inputs,
        sampling="uniform",
        certificate="lipschitz",
        hessian="projected",
        conformal=conformal,
        tolerance=tolerance,
        corrections=0,
    )


def newton_unmodified(
    inputs: Inputs,
    sampling: Sampling = "graded",
    certificate: CertificateKind = "hermite",
    tolerance: float = 1e-10,
) -> MethodResult:
    return run_newton(
        inputs,
        sampling=sampling,
        certificate=certificate,
        hessian="exact",
        tolerance=tolerance,
        corrections=0,
    )


def newton_staged(
    inputs: Inputs,
    sampling: Sampling = "uniform",
    certificate: CertificateKind = "lipschitz",
    tolerance: float = 1e-10,
    hessian_samples: int | None = None,
) -> MethodResult:
    return _descend(
        inputs,
        HessianDirection("projected"),
        sampling,
        certificate,
        tolerance=tolerance,
        hessian_samples=hessian_samples,
    )


def newton_eigen(
    inputs: Inputs,
    sampling: Sampling = "graded",
    certificate: CertificateKind = "hermite",
    tolerance: float = 1e-10,
    absolute: bool = False,
) -> MethodResult:
    direction = EigenDirection(absolute)
    return _descend(inputs, direction, sampling, certificate, tolerance=tolerance)


def newton_shift(
    inputs: Inputs,
    sampling: Sampling = "graded",
    certificate: CertificateKind = "hermite",
    tolerance: float = 1e-10,
    beta: float = 1e-3,
) -> MethodResult:
    return _descend(inputs, ShiftDirection(beta), sampling, certificate, tolerance=tolerance)


def gauss_newton(
    inputs: Inputs,
    sampling: Sampling = "graded",
    certificate: CertificateKind = "hermite",
    tolerance: float = 1e-10,
    damping: float = 0.0,
) -> MethodResult:
    direction = LevenbergMarquardt(damping)
    return _descend(inputs, direction, sampling, certificate, tolerance=tolerance)


def levenberg_marquardt(
    inputs: Inputs,
    sampling: Sampling = "graded",
    certificate: CertificateKind = "hermite",
    tolerance: float = 1e-10,
    damping: float = 1e-4,
) -> MethodResult:
    direction = LevenbergMarquardt(damping)
    return _descend(inputs, direction, sampling, certificate, tolerance=tolerance)


def lbfgs(
    inputs: Inputs,
    sampling: Sampling = "graded",
    certificate: CertificateKind = "hermite",
    memory: int = MEMORY,
    initial: Initial = "identity",
) -> MethodResult:
    return _descend(inputs, LBFGS(memory, initial), sampling, certificate)


def gradient_descent(
    inputs: Inputs,
    sampling: Sampling = "graded",
    certificate: CertificateKind = "hermite",
) -> MethodResult:
    return _descend(inputs, GradientDescent(), sampling, certificate)


def _check_shift(_: Energy, settings: Mapping[str, Any]) -> None:
    beta = settings["beta"]
    if beta <= 0:
        raise MethodError(
            f"beta, the least multiple of the identity, must be positive; got {beta!r}"
        )


METHODS = (
    Method(
        "newton",
        "Newton, ours",
        "harmonic",
        "Newton's method with the exact Hessian where it is positive definite and the paper's "
        "projected one elsewhere.",
        newton,
    ),
    Method(
        "newton-paper",
        "Newton, the paper's",
        "harmonic",
        "The paper's solver: uniform samples, Lipschitz certificate, projected Hessian.",
        newton_paper,
    ),
    Method(
        "newton-staged",
        "Newton, stage by stage",
        "harmonic",
        "Newton's method with the projected Hessian and its stages run one by one, by default with "
        "the paper's sampling and certificate.",
        newton_staged,
    ),
    Method(
        "newton-unmodified",
        "Newton, unmodified",
        "harmonic",
        "Newton's method with the exact Hessian; it halts where that is not positive definite.",
        newton_unmodified,
    ),
    Method(
        "newton-eigen",
        "Newton-Eigen",
        "harmonic",
        "Newton's method with a full eigen-factorisation, negative eigenvalues raised to 1e-10 "
        "or, with absolute, by their modulus.",
        newton_eigen,
    ),
    Method(
        "newton-shift",
        "Newton, shifted diagonal",
        "harmonic",
        "Newton's method with a multiple of the identity added until the Hessian is definite.",
        newton_shift,
        restrict=_check_shift,
    ),
    Method(
        "gauss-newton",
        "Gauss-Newton",
        "harmonic",
        "Gauss-Newton for ARAP, whose energy is a sum of squares.",
        gauss_newton,
        energies=("arap",),
    ),
    Method(
        "levenberg-marquardt",
        "Levenberg-Marquardt",
        "harmonic",
        "Gauss-Newton for ARAP with an adaptive damping.",
        levenberg_marquardt,
        energies=("arap",),
    ),
    Method(
        "lbfgs",
        "L-BFGS",
        "harmonic",
        "L-BFGS with five pairs, started from the identity plus the positional Hessian.",
        lbfgs,
        max_iterations=3000,
    ),
    Method(
        "gradient-descent",
        "Gradient descent",
        "harmonic",
        "Steepest descent.",
        gradient_descent,
        max_iterations=1000,
    ),
)
