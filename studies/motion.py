"""The motion between two poses: bounded motion and blending compared, and attacks on the proofs."""

from itertools import pairwise
from typing import Any

import numpy as np

from glid_nb import HarmonicMap, Motion, solve
from glid_nb._runtime import single_blas_thread
from glid_nb.certificate import certificate_of
from glid_nb.certificate.pieces import certify_pieces
from glid_nb.geometry import Domain, uniform_panels
from glid_nb.samples import names
from studies.bench.scaling import flower
from studies.cases import Case
from studies.store import Measurement
from studies.study import Plan, Study, Task, on_cases
from studies.tables import Row
from studies.timing import timed
from tests.support.reference_map import DenseCheck

QUARTERS = (0.25, 0.5, 0.75)
_SIZES = (0.01, 0.02, 0.04)  # of the noise added to the identity's coefficients
_PAIRS = 12  # pairs of random maps for each number of holes
TIMES, _POINTS = 200, 200_000


def extremes(maps: Any) -> np.ndarray:
    """(n, 2) largest k and least sigma_2 of each map, at points of the boundary."""
    points = uniform_panels(maps[0].domain.cage, 2000).start
    sizes = [np.abs(map_.wirtinger(points)) for map_ in maps]
    return np.array([[(fzb / fz).max(), (fz - fzb).min()] for fz, fzb in sizes])


def excess(motion: Motion, shares: Any) -> float:
    """The share by which k or sigma_2 is worse between two maps than at the worse of the two."""
    curve, found = motion.curve, [0.0]
    for pair, (start, end) in zip(pairwise(curve.maps), pairwise(curve.times), strict=True):
        ends, way = extremes(pair), extremes([curve.map(start + s * (end - start)) for s in shares])
        found += [way[:, 0].max() / ends[:, 0].max() - 1, 1 - way[:, 1].min() / ends[:, 1].min()]
    return float(max(found))


@single_blas_thread()
def measure(case: Case, plan: Plan) -> Measurement:
    """From the identity to the converged pose."""
    domain, pose, times = case.problem.domain, case.problem.pose, np.arange(1, 40) / 40
    ends: Any = [HarmonicMap.identity(domain), solve(domain, pose).map]
    bounded, linear = (Motion(ends, between=between) for between in ("auto", "linear"))
    solved: Any = ends[:1]
    for t in QUARTERS:
        targets = pose.handles + t * (pose.targets - pose.handles)
        solved.append(solve(domain, pose.with_targets(targets), start=solved[-1]).map)
    back = solve(domain, pose.with_targets(1.6 * pose.handles - 0.6 * pose.targets)).map
    loop = Motion([*ends, back], [0, 1, 1.3, 3], repeat="loop")
    proof, piece, curve = bounded.certificate, bounded.pieces[0], bounded.curve
    return {
        "size": f"{domain.n_coefficients - domain.n_holes}, {domain.n_holes}",
        "end": extremes(ends[1:]),
        "bounded": extremes([*map(curve.map, QUARTERS)]),
        "coefficients": extremes([*map(linear.curve.map, QUARTERS)]),
        "targets": extremes(solved[1:]),
        "least, coefficients": extremes([*map(linear.curve.map, times)])[:, 1].min(),
        "excess": [excess(bounded, times), excess(loop, times)],
        "proved": [len(bounded.pieces), proof.k_upper, proof.sigma2_lower],
        "map": timed(lambda: HarmonicMap(domain, *curve.between(0, 0.37)), plan.repeats),
        "proof": timed(lambda: certify_pieces(piece[2:]), plan.repeats),
    }


def _row(data: Measurement) -> Row:
    def told(name: str, which: int) -> str:
        return " ".join(f"{values[which]:.2f}" for values in data[name])

    pieces, k, sigma2 = data["proved"]
    return {
        "shape": f"{data['name']} ({data['size']})",
        "k at the end": told("end", 0),
        **{f"k, {name}": told(name, 0) for name in ("bounded", "coefficients", "targets")},
        "sigma_2 at the end": told("end", 1),
        "sigma_2, bounded": told("bounded", 1),
        "least, coefficients": f"{data['least, coefficients']:.2f}",
        "least, targets": f"{min(sigma2 for _, sigma2 in data['targets']):.2f}",
        "pieces": pieces,
        "proved": f"{k:.3f}, {sigma2:.3f}",
        "worse": " ".join(f"{share:.1%}" for share in data["excess"]),
        "map, ms": 1e3 * data["map"]["median"],
        "proof, ms": 1e3 * data["proof"]["median"],
    }


def pair(domain: Domain, seed: int) -> list[HarmonicMap]:
    """Two random certified maps; the second is turned as a whole."""
    rng, maps, n = np.random.default_rng(seed), [], domain.n_coefficients - domain.n_holes
    while len(maps) < 2:
        noise = rng.choice(_SIZES) * rng.normal(size=(2, domain.n_coefficients, 2)) @ [1, 1j]
        turn = np.exp(1j * rng.uniform(-3, 3) * len(maps))
        phi, psi = turn * (HarmonicMap.identity(domain).phi + noise[0]), noise[1] / turn
        psi[n:] = phi[n:].conj()
        map_ = HarmonicMap(domain, phi, psi)
        maps += [map_] if certificate_of(map_).certified else []
    return maps


def attack(holes: int, plan: Plan) -> Row:
    """Motions of random maps. Sampling the first pair's motions must not contradict a bound."""
    domain = flower(30, holes)
    pairs = [pair(domain, seed) for seed in range(2 if plan.quick else _PAIRS)]
    motions, rooms = [*map(Motion, pairs)], []
    loops = domain.cage.loops_complex, domain.offset_cage.loops_complex
    dense = DenseCheck.on(*loops, domain.hole_points_complex, 2000 if plan.quick else _POINTS)
    for motion in (motions[0], Motion(pairs[0], between="linear")):
        proof = motion.certificate
        for t in np.linspace(0, proof.until, TIMES, endpoint=proof.certified):
            coefficients = motion(t).phi, motion(t).psi
            f, g = (np.abs(np.concatenate(dense.derivative(c))) for c in coefficients)
            room = (f - g).min() - proof.sigma2_lower, proof.sigma1_upper - (f + g).max()
            above = min(*room, proof.k_upper - (g / f).max())
            rooms.append(above if proof.certified else (f - g).min())
    return {
        "holes": holes,
        "motions": len(motions),
        "certified": sum(motion.certificate.certified for motion in motions),
        "worse": f"{max(excess(motion, QUARTERS) for motion in motions):.2%}",
        "least room of bounds": min(rooms),
    }


def _attacks(plan: Plan) -> list[Task]:
    of = f"quick {plan.quick}"
    return [Task(str(n), of, lambda n=n: {"found": attack(n, plan)}) for n in range(7)]


STUDIES = (
    Study(
        "between",
        on_cases(lambda plan: [*plan.references, *(f"{n}-extreme" for n in names())], measure),
        lambda found: {"between": [*map(_row, found)]},
    ),
    Study("attack", _attacks, lambda found: {"attack": [data["found"] for data in found]}),
)
