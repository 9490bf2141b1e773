"""The flags that choose the energy and the solver, shared by ``demo`` and ``solve``."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

import glid_nb

if TYPE_CHECKING:
    from glid_nb.energies import Energy
    from glid_nb.solvers import Options


def add_solver_arguments(parser: argparse.ArgumentParser) -> None:
    """Add them; their defaults are the library's, so a flag that is not given stays ``None``.

    The names are checked by the library, which says in one place what there is to choose from.
    """
    group = parser.add_argument_group("energy and solver")
    group.add_argument(
        "--energy",
        metavar="{iso,exp,amips,mips,arap}",
        default="iso",
        help="symmetric Dirichlet (default), its exponential, AMIPS, MIPS (conformal distortion "
        "only), or as rigid as possible",
    )
    group.add_argument(
        "--s", type=float, metavar="S", help="parameter of exp and amips, above 0 (default 1)"
    )
    group.add_argument(
        "--p2p-weight", type=float, metavar="L", help="weight of the targets (default 1e5)"
    )
    group.add_argument(
        "--conformal", action="store_true", help="allow conformal maps only (no shear)"
    )
    group.add_argument(
        "--sampling",
        metavar="{graded,uniform}",
        help="where the energy is integrated: graded panels (default) or the paper's samples",
    )
    group.add_argument(
        "--certificate",
        metavar="{hermite,lipschitz,bdhm}",
        help="how injectivity is proved: ours (default), the paper's Lipschitz bounds, or BDHM's "
        "looser ones",
    )
    group.add_argument(
        "--hessian",
        metavar="{adaptive,projected,exact}",
        help="exact where positive definite (default), the paper's projection, or always exact",
    )
    group.add_argument(
        "--no-align",
        action="store_true",
        help="begin at the identity itself, not at its best rigid motion to the targets",
    )
    group.add_argument(
        "--restarts",
        type=int,
        metavar="N",
        help="other ways to try where the first ends at a high energy (default 3)",
    )
    group.add_argument(
        "--max-iterations", type=int, metavar="K", help="most Newton iterations (default 200)"
    )


def energy_of(chosen: argparse.Namespace) -> Energy:
    """The energy that the flags name.

    Raises
    ------
    InputError
        It is unknown, its parameter is not positive, or it has none and one is given.
    """
    if chosen.s is not None and chosen.energy in ("iso", "arap"):
        raise glid_nb.InputError(f"--s is the parameter of exp and amips; {chosen.energy} has none")
    return glid_nb.energy_by_name(chosen.energy, chosen.s)


def options_of(chosen: argparse.Namespace) -> Options:
    """The solver's options that the flags name."""
    names = ("sampling", "certificate", "hessian", "p2p_weight", "restarts", "max_iterations")
    given = {name: getattr(chosen, name) for name in names if getattr(chosen, name) is not None}
    return glid_nb.Options(conformal=chosen.conformal, align=not chosen.no_align, **given)
