"""The paper's Lipschitz constants and BDHM's, and Newton's method with each (Figure 7)."""

from typing import Any

import jax.numpy as jnp
import numpy as np
from numpy.typing import NDArray

from glid_nb._runtime import double_precision
from glid_nb.certificate import BDHMLipschitz, EndValues, Lipschitz, certify
from glid_nb.certificate.paper import variation
from glid_nb.geometry import uniform_panels
from glid_nb.harmonic import HarmonicMap, basis_of
from glid_nb.solvers.discretisation import UNIFORM_SAMPLES
from studies.cases import Case
from studies.compare.shapes import some
from studies.runs import outcome, run
from studies.store import Measurement
from studies.study import Plan, Study, on_cases
from studies.tables import Row, percent

Array = NDArray[Any]

_MOST_ITERATIONS = 100
PAPER_SEGMENTS = 529
"""The number in Figure 7. Ours differs a little, because each edge has a whole number of them."""


def measure(case: Case, plan: Plan) -> Measurement:
    """Both kinds of constants on one map, and Newton's method with each."""
    runs = {}
    for name, certificate in (("ours", "lipschitz"), ("bdhm", "bdhm")):
        plan.detail(f"{case.name}: Newton with the Lipschitz constants of {name}")
        result = run(
            "newton-staged", case, certificate=certificate, max_iterations=_MOST_ITERATIONS
        )
        runs[name] = outcome(result)
    map_ = run("newton", case).map
    assert isinstance(map_, HarmonicMap)
    ours, theirs = lipschitz_constants(map_, PAPER_SEGMENTS)
    fine = [float(values.mean()) for values in lipschitz_constants(map_, UNIFORM_SAMPLES)]
    return {
        "runs": runs,
        "fine_means": fine,
        "refused": {
            "ours": refused_segments(map_, "lipschitz"),
            "bdhm": refused_segments(map_, "bdhm"),
        },
        "arrays": {"ours": ours, "bdhm": theirs},
    }


@double_precision
def lipschitz_constants(map_: HarmonicMap, segments: int) -> tuple[Array, Array]:
    """Constants of ``f_z`` on about ``segments`` segments: the paper's (Section 8), and BDHM's."""
    panels = uniform_panels(map_.domain.cage, segments)
    basis = basis_of(map_.domain)
    sing, start, end = basis.singularities, jnp.asarray(panels.start), jnp.asarray(panels.end)
    phi = jnp.asarray(basis.pad(map_.phi))[None]
    fz, _ = map_.wirtinger(panels.start)
    along = map_.wirtinger_derivatives(panels.start, 1)[0]
    slopes = along * panels.length, along[panels.next] * panels.length
    ends = EndValues(*map(jnp.asarray, (fz, fz[panels.next], *slopes)))
    remainder = Lipschitz.on(start, end, sing).remainder(phi, sing)[0]
    ours = np.asarray(variation(ends, remainder)) / panels.length
    theirs = BDHMLipschitz.on(start, end, sing).constants(phi, sing)[0]
    return ours, np.asarray(theirs)


def refused_segments(map_: HarmonicMap, constants: Any) -> int:
    """The number of the solver's fixed segments on which a map is not proved locally injective."""
    panels = uniform_panels(map_.domain.cage, UNIFORM_SAMPLES)
    proof = certify(map_, constants, panels, split=False)
    return int((~(proof.panels.sigma2_lower > 0)).sum())


def tables(found: list[Measurement]) -> dict[str, list[Row]]:
    """Means of the constants, and how Newton's method ends with each."""
    rows: list[Row] = []
    for data in found:
        ours, theirs = data["arrays"]["ours"], data["arrays"]["bdhm"]
        ends = {
            name: f"{run['status']} after {run['iterations']}, energy {run['energy'][-1]:.4g}"
            for name, run in data["runs"].items()
        }
        rows.append(
            {
                "shape": data["name"],
                "segments": len(ours),
                "mean, paper's": float(ours.mean()),
                "mean, BDHM's": float(theirs.mean()),
                "ratio": f"{theirs.mean() / ours.mean():.1f}",
                "paper's is smaller on": percent(float((ours < theirs).mean())),
                "ratio on 10,000": f"{data['fine_means'][1] / data['fine_means'][0]:.1f}",
                "Newton, paper's": ends["ours"],
                "Newton, BDHM's": ends["bdhm"],
                "segments unproved at the minimum, BDHM's": data["refused"]["bdhm"],
            }
        )
    return {"lipschitz": rows}


STUDY = Study("lipschitz", on_cases(some(("raptor", "giraffe"), "gecko-extreme"), measure), tables)
