"""All methods by name."""

from __future__ import annotations

import math
import numbers
from typing import Any

from glid_nb.energies import ARAP, Energy, SymmetricDirichlet, as_energy
from glid_nb.geometry import Domain, Triangulation
from glid_nb.methods import subspace
from glid_nb.methods.arguments import check_arguments
from glid_nb.methods.bdhm.methods import METHODS as BDHM_METHODS
from glid_nb.methods.linear.methods import METHODS as LINEAR_METHODS
from glid_nb.methods.mesh.methods import METHODS as MESH_METHODS
from glid_nb.methods.method import Inputs, Method, MethodError, unmet
from glid_nb.methods.result import Callback, DeformationMap, MethodResult
from glid_nb.solvers import Pose

_ALL: tuple[Method, ...] = (*subspace.METHODS, *BDHM_METHODS, *MESH_METHODS, *LINEAR_METHODS)
_TRIANGLE = 3


def methods(*, available: bool = False) -> dict[str, Method]:
    """All methods by name, in the order in which a list of them should show them.

    With ``available``, only those whose optional package is installed.
    """
    return {method.name: method for method in _ALL if method.available or not available}


def run_method(
    name: str,
    domain: Domain,
    pose: Pose,
    energy: Energy | str | None = None,
    *,
    p2p_weight: float = 1e5,
    max_iterations: int | None = None,
    align: bool = True,
    start: DeformationMap | None = None,
    triangulation: Triangulation | None = None,
    n_vertices: int = 10_000,
    callback: Callback | None = None,
    **settings: Any,
) -> MethodResult:
    """Deform a domain by one of :func:`methods`.

    Parameters
    ----------
    name : str
    domain : Domain
    pose : Pose
        Handles, which must lie in the domain, and their targets.
    energy : Energy or str, optional
        Or the name of one with its default parameter. By default the symmetric Dirichlet energy,
        or ARAP for the methods that know no other.
    p2p_weight : float
        ``lambda``; methods with hard constraints do not use it.
    max_iterations : int, optional
        By default the method's own.
    align : bool
        Begin with the rigid motion that brings the handles closest to their targets.
    start : HarmonicMap or MeshMap, optional
        Where the method starts; by default the identity. Methods in the harmonic subspace take
        harmonic maps only, and BDHM only those within its bounds; SLIM leaves out a start with
        triangles turned over. Linear methods have no start.
    triangulation : Triangulation, optional
        For mesh methods; the handles must be among its vertices. By default one of about
        ``n_vertices`` vertices, at least 3, is made, with all of the cage's among them.
    callback : callable, optional
        Called with a :class:`MethodProgress` after the start and after each iteration; returning
        ``True`` stops the method there.
    **settings
        The method's own: ``methods()[name].settings``.

    Raises
    ------
    EnergyError
        When the energy's name is unknown, or it is no energy at all.
    MethodError
        For an unknown method or setting, an argument of the wrong type, a number out of its range,
        an energy that the method cannot minimise, or an optional package that is not installed or
        cannot be imported (the message says which extra to install).
    PoseError
        When a handle lies outside the domain.
    StartError
        When the harmonic map to start from belongs to another domain or, for a method that goes on
        from it in the harmonic subspace, is not proved locally injective.

    Examples
    --------
    >>> from glid_nb import Cage, Domain, Pose
    >>> domain = Domain.from_cage(Cage([[0, 0], [4, 0], [4, 2], [0, 2]]))
    >>> pose = Pose([[1, 1], [3, 1]], [[1, 1], [3, 1]])
    >>> run_method("mls", domain, pose, n_vertices=50).flips
    0
    """
    known = methods()
    if not isinstance(name, str) or name not in known:
        raise MethodError(f"unknown method {name!r}; choose one of {', '.join(known)}")
    method = known[name]
    check_arguments(domain, pose, align, start, triangulation, callback)
    if energy is None:
        only_arap = method.energies is not None and "iso" not in method.energies
        energy = ARAP() if only_arap and "arap" in (method.energies or ()) else SymmetricDirichlet()
    energy = as_energy(energy)
    method.check(energy, settings)
    real = isinstance(p2p_weight, numbers.Real) and not isinstance(p2p_weight, bool)
    if not (real and 0 < float(p2p_weight) < math.inf):
        raise MethodError(f"p2p_weight must be a positive finite number, got {p2p_weight!r}")
    limit = method.max_iterations if max_iterations is None else max_iterations
    for what, count in (("max_iterations", limit), ("n_vertices", n_vertices)):
        if expected := unmet(int, count):
            raise MethodError(f"{what} must be {expected}, got {count!r}")
    if n_vertices < _TRIANGLE:
        raise MethodError(f"n_vertices must be at least {_TRIANGLE}, got {n_vertices!r}")
    pose.check_inside(domain)
    inputs = Inputs(
        name,
        domain,
        pose,
        energy,
        float(p2p_weight),
        int(limit),
        bool(align),
        start,
        triangulation,
        n_vertices,
        callback,
    )
    return method.run(inputs, **settings)
