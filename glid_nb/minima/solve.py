"""Solve for a deformation: once, or in finer bases until they hardly lower the energy."""

from collections.abc import Callable
from dataclasses import replace
from numbers import Real
from typing import Any

import numpy as np
import shapely

from glid_nb._arguments import check_type
from glid_nb._runtime import double_precision
from glid_nb.energies import Energy, as_energy
from glid_nb.geometry import Cage, Domain, MeshMap, as_points
from glid_nb.geometry._loops import subdivided
from glid_nb.harmonic import HarmonicMap
from glid_nb.minima import search
from glid_nb.pose import DeformationMap, Pose
from glid_nb.solvers.method import Inputs, Method, MethodError, StartError
from glid_nb.solvers.newton import Newton
from glid_nb.solvers.options import Options
from glid_nb.solvers.result import Callback, Refinement, Result, Status

# Offset edges shorter than this many times their distance from the cage are not divided.
_SHORT = 2.0


@double_precision
def solve(
    domain: Domain,
    pose: Pose,
    energy: Energy | str | None = None,
    options: Options | None = None,
    start: DeformationMap | Result | None = None,
    callback: Callback | None = None,
    *,
    method: Method | None = None,
) -> Result:
    """Deform a domain so that its handles go to their targets with the least distortion.

    Minimises (20) by Newton's method from a certified map. Every step is proved locally injective
    before it is taken, so the result is always locally injective. If no certified step lowers the
    energy, the last map is returned with a status that says so.

    The pose's handles must lie in the domain; its targets may be anywhere. The energy is an
    isometric one, or the name of one with its default parameter ("iso", "exp", "amips", "mips",
    "arap"). The default is the symmetric Dirichlet energy, or ARAP for methods that know no other.
    The default method is our Newton method; others are in :mod:`glid_nb.methods`. The map of a
    method on a mesh may fold and has no certificate.

    The default start is the identity. Unless ``options.align`` is off, the start is first moved
    rigidly towards the targets. A start that is the result of an earlier solve on the same domain
    also passes on its panels or its mesh. Maps of a mesh can only start methods on a mesh. Linear
    methods have no start.

    The callback is called with a :class:`Progress` between compiled calls, also after calls without
    a step, when panels must be split first. With other methods it is called at the start and after
    each iteration. If it returns ``True``, the solve stops.

    Targets that cannot be met take the longest: a high energy makes the solve try its restarts, and
    the first solve of this kind compiles further programs. ``Options(restarts=0)`` makes it one
    descent, and a callback can show how far it is and end it after a given time.

    Raises a TypeError that names an argument of the wrong type; a PoseError when a handle lies
    outside the domain; an EnergyError for an unknown energy; a StartError when the start belongs to
    another domain, is not conformal though the options ask for conformal maps, or is not proved
    locally injective; a MethodError when the method cannot minimise the energy, hold an angle or
    use the start, or needs an optional package (the message says which extra to install).

    >>> from glid_nb import Cage, Domain, Pose, methods
    >>> domain = Domain.from_cage(Cage([[0, 0], [4, 0], [4, 2], [0, 2]]))
    >>> pose = Pose([[1, 1], [3, 1]], [[1, 1], [3, 1]])
    >>> solve(domain, pose, method=methods.MovingLeastSquares(n_vertices=50)).flips
    0
    """
    check_type("domain", domain, Domain, "make one with Domain.from_cage(cage)")
    check_type("pose", pose, Pose, "make one with Pose(handles, targets)")
    check_type("options", options, Options | None, "write Options(p2p_weight=...)")
    starts = HarmonicMap | MeshMap | Result | None
    check_type("start", start, starts, "an earlier result or its map")
    check_type("callback", callback, Callable | None, "a function of a Progress")
    check_type("method", method, Method | None, "one of glid_nb.methods, such as LBFGS()")
    method, energy = method_for(method, energy)
    method.check(energy, pose)
    pose.check_inside(domain)
    problem: Any = {"domain": domain, "pose": pose, "energy": energy}
    inputs = Inputs(**problem, options=options or Options(), start=start, callback=callback)
    start_map = inputs.start_map
    if isinstance(start_map, HarmonicMap) and not start_map.domain.equals(domain):
        raise StartError("the map to start from has another domain; pass a map of this domain")
    return search.run(method, inputs)


def method_for(method: Method | None, energy: Energy | str | None) -> tuple[Method, Energy]:
    """A method and an energy, with defaults for None: Newton's method and the energy of (20)."""
    method = Newton() if method is None else method
    if energy is None and method.energies is not None and "iso" not in method.energies:
        energy = method.energies[0]
    return method, as_energy(energy)


def refine(result: Result, gain: float = 0.01, callback: Callback | None = None) -> Result:
    """Solve again with finer bases, until one lowers the energy by less than the share ``gain``.

    Each refinement cuts the edges of the offset cage in half. The finer basis contains the maps of
    the coarser one, because narrow hat functions add up to wide ones. So each solve continues from
    the map of the one before, and its energy is never higher. The certified domain stays the same;
    ``map.domain`` has the new offset cage. Each refinement makes an iteration about 4 to 8 times
    as long.

    Returns the last solve's result. Its ``refinements`` give the sizes, energies and times of all
    solves, the given one first. The callback is as in :func:`glid_nb.solve`. Raises a MethodError
    when the method has no unknowns in the harmonic subspace (a method on a mesh, or BDHM), a
    ValueError when ``gain`` is not between 0 and 1.
    """
    check_type("result", result, Result, "pass what glid_nb.solve returns")
    check_type("gain", gain, Real, "a share of the energy")
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
    """The same map with the offset cage's edges cut in half; ``map`` itself if all are short."""
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
    assert unknowns is not None  # refine has checked this
    return Refinement(unknowns, result.status, result.energy, result.iterations, result.solve_time)
