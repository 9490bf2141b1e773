"""Other methods for the same problems, as values for the argument ``method`` of ``solve``.

For example ``solve(domain, pose, method=methods.LBFGS(memory=5))``. Methods in the harmonic
subspace use the line search and the certificate of our Newton method. Maps of methods on a mesh may
fold.
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
"""All methods by name, in the order of menus."""


def available() -> dict[str, type[Method]]:
    """All methods by name, except those whose optional package is not installed."""
    return {name: method for name, method in METHODS.items() if method.available()}


def by_name(name: str, /, **settings: Any) -> Method:
    """The method with this name and these settings, for example from a file or a menu.

    Raises a MethodError for an unknown method, an unknown setting, or a setting out of range.
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
