"""Other methods on the same problems, as values for the argument ``method`` of ``solve``.

``solve(domain, pose, method=methods.LBFGS(memory=5))``. Those in the harmonic subspace use Newton's
own line search and certificate; those on a mesh may fold.
"""

from collections.abc import Mapping
from typing import Any

from glid_nb._errors import did_you_mean
from glid_nb.methods.bdhm.solve import BDHM
from glid_nb.methods.linear import (
    BoundedBiharmonicWeights,
    CauchyCoordinates,
    HarmonicWeights,
    MeanValueCoordinates,
    MovingLeastSquares,
)
from glid_nb.methods.mesh.aqp import AQP
from glid_nb.methods.mesh.libigl import SLIM, ARAPLocalGlobal
from glid_nb.methods.subspace.methods import (
    LBFGS,
    GaussNewton,
    GradientDescent,
    LevenbergMarquardt,
    NewtonEigen,
    NewtonPaper,
    NewtonShift,
    NewtonStaged,
    NewtonUnmodified,
)
from glid_nb.solvers import Method, MethodError, Newton

METHODS: Mapping[str, type[Method]] = {
    method.name: method
    for method in (
        *(Newton, NewtonPaper, NewtonStaged, NewtonUnmodified, NewtonEigen, NewtonShift),
        *(GaussNewton, LevenbergMarquardt, LBFGS, GradientDescent, BDHM, SLIM, AQP),
        *(ARAPLocalGlobal, MovingLeastSquares, BoundedBiharmonicWeights, HarmonicWeights),
        *(MeanValueCoordinates, CauchyCoordinates),
    )
}
"""All methods by name, in the order in which a list of them should show them."""


def available() -> dict[str, type[Method]]:
    """The methods by name whose optional package is installed."""
    return {name: method for name, method in METHODS.items() if method.available()}


def by_name(name: str, /, **settings: Any) -> Method:
    """The method of a name with some settings, as a file or a menu gives them.

    A MethodError for an unknown method, an unknown setting, or one out of its range.
    """
    if not isinstance(name, str) or name not in METHODS:
        hint = did_you_mean(name, METHODS) if isinstance(name, str) else ""
        raise MethodError(f"unknown method {name!r}; choose one of {', '.join(METHODS)}{hint}")
    method = METHODS[name]
    for setting in settings:
        if setting not in method.kinds():
            known = ", ".join(method.kinds()) or "none"
            raise MethodError(f"the method {name!r} has no setting {setting!r}; it has: {known}")
    return method(**settings)
