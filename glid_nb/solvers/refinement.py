"""Finer bases for a solve that has ended, until they gain next to nothing."""

from dataclasses import replace

import numpy as np
import shapely

from glid_nb._arguments import check_type
from glid_nb.geometry import Cage, Domain, as_points
from glid_nb.geometry._loops import subdivided
from glid_nb.harmonic import HarmonicMap
from glid_nb.solvers.method import MethodError
from glid_nb.solvers.result import Callback, Refinement, Result, Status
from glid_nb.solvers.solve import solve

# Offset edges shorter than so many times their distance from the cage are not divided: the cage
# does not see their ends apart.
_SHORT = 2.0


def refine(result: Result, gain: float = 0.01, callback: Callback | None = None) -> Result:
    """Solve again with a finer basis, until that lowers the energy by less than ``gain`` of it.

    Each time the edges of the offset cage are cut in half. A map of the coarser basis is one of the
    finer (hat functions of half the width add up to those of the whole), so every solve goes on
    from the map of the one before, and no energy is above it. The certified domain stays the same;
    ``map.domain`` has the new offset cage. An iteration takes about 4 to 8 times as long each time.

    Returns the last solve's result, whose ``refinements`` tell the sizes, energies and times of
    all, that of the given one first. The callback is as in :func:`glid_nb.solve`. Raises a
    MethodError when the method has no unknowns in the harmonic subspace (a mesh's, or BDHM), a
    ValueError when ``gain`` is not between 0 and 1.
    """
    check_type("result", result, Result, "what glid_nb.solve returns")
    if not isinstance(result.map, HarmonicMap) or result.n_unknowns is None:
        raise MethodError(f"{result.method} has no basis to refine; use a descent, such as Newton")
    if not 0 < gain < 1:
        raise ValueError(f"gain must be between 0 and 1, not {gain!r}")
    last, steps = result, [*result.refinements] or [_summary(result)]
    while last.status is not Status.STOPPED:
        assert isinstance(last.map, HarmonicMap)
        start = in_finer_basis(last.map)
        if start is last.map:
            break
        options = replace(result.options, align=False)
        problem = start.domain, result.pose, result.energy_measure, options, start, callback
        finer = solve(*problem, method=result.method)
        steps.append(_summary(finer))
        before, last = last.energy, finer
        if before - last.energy < gain * before:
            break
    return replace(last, options=result.options, attempts=result.attempts, refinements=tuple(steps))


def in_finer_basis(map: HarmonicMap) -> HarmonicMap:
    """The same map, the offset cage's edges cut in half; itself where all are short already."""
    domain, counts, coefficients = map.domain, [], []
    rings = shapely.MultiLineString([shapely.LinearRing(loop) for loop in domain.cage.loops])
    for loop in domain.offset_cage.loops_complex:
        edge = np.roll(loop, -1) - loop
        away = shapely.distance(rings, shapely.points(as_points(loop + edge / 2)))
        counts.append(np.where(np.abs(edge) > _SHORT * away, 2, 1))
    if all((count == 1).all() for count in counts):
        return map
    ends = np.cumsum([len(count) for count in counts])
    loops = [
        as_points(subdivided(loop, count))
        for loop, count in zip(domain.offset_cage.loops_complex, counts, strict=True)
    ]
    for values in (map.phi, map.psi):
        *parts, logarithms = np.split(values, ends)
        halves = [subdivided(part, count) for part, count in zip(parts, counts, strict=True)]
        coefficients.append(np.concatenate([*halves, logarithms]))
    finer = Domain(domain.cage, Cage(loops[0], loops[1:]), domain.hole_points, domain.notes)
    return HarmonicMap(finer, *coefficients)


def _summary(result: Result) -> Refinement:
    unknowns = result.n_unknowns
    assert unknowns is not None  # refine looked
    return Refinement(unknowns, result.status, result.energy, result.iterations, result.solve_time)
