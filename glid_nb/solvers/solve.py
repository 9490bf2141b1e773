"""Solving for a deformation."""

from collections.abc import Callable
from typing import Any

from glid_nb._arguments import check_type
from glid_nb._runtime import double_precision
from glid_nb.energies import Energy, as_energy
from glid_nb.geometry import Domain, MeshMap
from glid_nb.harmonic import HarmonicMap
from glid_nb.solvers.method import Inputs, Method
from glid_nb.solvers.newton import Newton
from glid_nb.solvers.options import Options
from glid_nb.solvers.pose import Pose
from glid_nb.solvers.result import Callback, DeformationMap, Result
from glid_nb.solvers.subspace import StartError


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

    Minimises (20) by Newton's method from a certified map. Every step is proved locally
    injective before it is taken, so the result always is: when no certified step lowers the
    energy, the last map is returned with a status that says so.

    Parameters
    ----------
    domain : Domain
    pose : Pose
        Handles, which must lie in the domain, and their targets, which may be anywhere.
    energy : Energy or str, optional
        Isometric energy, or the name of one with its default parameter ("iso", "exp", "amips",
        "mips", "arap"); by default the symmetric Dirichlet energy, or ARAP for the methods that
        know no other.
    options : Options, optional
    start : HarmonicMap, MeshMap or Result, optional
        Where to start; by default the identity. Unless ``options.align`` is off, the start is
        first moved rigidly towards the targets. The result of an earlier solve on the same domain
        also passes on its panels or its mesh. Maps of a mesh are for methods on a mesh; linear
        methods have no start.
    callback : callable, optional
        Called with a :class:`Progress` between compiled calls, also after those that took no step
        because panels must be split first; for other methods than ours at the start and after
        each iteration. Returning ``True`` stops the solve.
    method : Method, optional
        By default ours, Newton's; others are in :mod:`glid_nb.methods`. What a method on a mesh
        returns may fold and has no certificate.

    Raises
    ------
    TypeError
        An argument is of the wrong type; the message names it.
    PoseError, EnergyError
        A handle lies outside the domain; the energy is unknown, or no energy at all.
    StartError
        The starting map belongs to another domain, is not conformal though the options ask for it,
        or is not proved locally injective.
    MethodError
        The method cannot minimise the energy, hold an angle or take the start, or lacks an optional
        package (the message says which extra to install).

    Examples
    --------
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
    method = Newton() if method is None else method
    if energy is None and method.energies is not None and "iso" not in method.energies:
        energy = method.energies[0]
    energy = as_energy(energy)
    method.check(energy, pose)
    pose.check_inside(domain)
    problem: Any = {"domain": domain, "pose": pose, "energy": energy}
    inputs = Inputs(**problem, options=options or Options(), start=start, callback=callback)
    start_map = inputs.start_map
    if isinstance(start_map, HarmonicMap) and not start_map.domain.equals(domain):
        of = "the map to start from belongs to another domain"
        raise StartError(f"{of}; start from a map of this one")
    return method.run(inputs)
