"""What decides how Newton's methods fare: where the Hessian is definite, and how well it is met."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from glid_nb._runtime import double_precision
from glid_nb.energies import SymmetricDirichlet
from glid_nb.harmonic import HarmonicMap
from glid_nb.methods import MethodProgress
from glid_nb.methods.subspace import SubspaceProblem
from glid_nb.solvers import Options
from glid_nb.solvers.solve import real_coefficients
from studies.comparisons.cases import Case
from studies.comparisons.runs import run

Array = NDArray[Any]


@double_precision
def negative_eigenvalues(
    case: Case, method: str = "newton-unmodified", **settings: Any
) -> list[int]:
    """How many eigenvalues of the exact Hessian are negative at each iterate of a Newton's method.

    Of the total energy with respect to the unknowns, on the panels of our solver.
    """
    maps: list[HarmonicMap] = []

    def keep(progress: MethodProgress) -> None:
        assert isinstance(progress.map, HarmonicMap)
        maps.append(progress.map)

    run(method, case, callback=keep, **settings)
    problem = _problem(case, Options(align=False))
    return [int((np.linalg.eigvalsh(_hessian(problem, m, "exact")) < 0).sum()) for m in maps]


@double_precision
def contraction(case: Case, minimum: HarmonicMap, samples: int | None = None) -> dict[str, float]:
    """How Newton's iteration with the paper's Hessian contracts the error close to a minimum.

    A full step turns the error ``e`` into ``(I - M^-1 H) e`` with ``H`` the exact Hessian and ``M``
    the one that is used, so the eigenvalues of ``M^-1 H`` decide: at 1 the error is gone, above 2
    it grows and the line search has to shorten steps, close to 0 it stays.

    Parameters
    ----------
    case : Case
    minimum : HarmonicMap
    samples : int, optional
        Of ``M``; by default the paper's 1,000.

    Returns
    -------
    dict
        ``least`` and ``most`` eigenvalue of ``M^-1 H``, and ``least_projected``, that with as many
        samples for ``M`` as for ``H``, so that only the projection tells.
    """
    paper = Options(sampling="uniform", certificate="lipschitz", align=False)
    coarse = _problem(case, paper, hessian_samples=samples)
    fine = _problem(case, paper, hessian_samples=len(coarse.discretisation.panels))
    exact = _hessian(fine, minimum, "exact")
    used = _hessian(coarse, minimum, "projected")
    # A Hessian of very few samples is singular but for the handles.
    used += 1e-12 * float(np.diag(used).mean()) * np.eye(len(used))
    values = scipy.linalg.eigvalsh(exact, used)
    projected = scipy.linalg.eigvalsh(exact, _hessian(fine, minimum, "projected"))
    return {
        "least": float(values[0]),
        "most": float(values[-1]),
        "least_projected": float(projected[0]),
    }


def _problem(case: Case, options: Options, **more: Any) -> SubspaceProblem:
    problem = case.problem
    return SubspaceProblem(problem.domain, problem.pose, SymmetricDirichlet(), options, **more)


def _hessian(problem: SubspaceProblem, map_: HarmonicMap, curvature: Any) -> Array:
    """The total energy's Hessian with respect to the unknowns alone."""
    point = problem.evaluate(real_coefficients(problem.discretisation.basis, map_))
    free = np.flatnonzero(problem.unknowns.free > 0)
    full = problem.hessian(point, curvature) + problem.p2p_hessian
    return full[np.ix_(free, free)]
