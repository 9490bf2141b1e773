"""The flags of the energy, the solver and the tracing, made from the fields that they set.

A missing flag is None and leaves its field at the library's default. The library checks the values
and lists the choices.
"""

import argparse
import dataclasses
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Literal, get_args, get_origin

import glid_nb
from glid_nb._arguments import field_kinds
from glid_nb.energies import ENERGIES, SymmetricDirichlet

_WITH_S = " and ".join(name for name, energy in ENERGIES.items() if "s" in energy.parameters())

_USUAL = SymmetricDirichlet.name  # of the energies

_PIXEL = {"type": float, "nargs": 2, "metavar": ("X", "Y")}
_ARGUMENTS: dict[Any, dict[str, Any]] = {  # argparse's keywords for each annotation of a field
    bool: {"action": argparse.BooleanOptionalAction},
    int: {"type": int, "metavar": "N"},
    float: {"type": float, "metavar": "X"},
    tuple[float, float]: _PIXEL,
    Sequence[tuple[float, float]]: {**_PIXEL, "action": "append"},
    tuple[float, float, float]: {"type": float, "nargs": 3, "metavar": ("R", "G", "B")},
    glid_nb.Scribbles: {"type": Path, "metavar": "FILE.json"},
}


def add_solver_flags(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("energy and solver")
    add_energy_flags(group)
    _add_flags(group, glid_nb.Options)


def add_energy_flags(group: Any) -> None:
    """Add ``--energy`` and ``--s`` to a parser or a group."""
    energies = "; ".join(f"{name}: {energy.label}" for name, energy in ENERGIES.items())
    names = f"{{{','.join(ENERGIES)}}}"
    group.add_argument("--energy", metavar=names, help=f"{energies} (default: {_USUAL})")
    s = f"parameter of {_WITH_S}, above 0 (default 1)"
    group.add_argument("--s", type=float, metavar="S", help=s)


def add_trace_flags(parser: argparse.ArgumentParser) -> None:
    _add_flags(parser.add_argument_group("tracing"), glid_nb.TraceOptions)


def _add_flags(group: Any, settings: Any) -> None:
    """Add a flag for every field of a dataclass, for example ``--keep-hole`` for ``keep_holes``."""
    for field in dataclasses.fields(settings):
        kind, flag = field_kinds(settings)[field.name], f"--{field.name.replace('_', '-')}"
        if type(None) in get_args(kind):
            kind = get_args(kind)[0]
        text = field.metadata["help"][0].lower() + field.metadata["help"][1:]
        if field.default not in (None, ()):
            text += f" (default {field.default})"
        if labels := field.metadata["choices"]:
            text += "; " + ", ".join(f"{value}: {label}" for value, label in labels.items())
        choice = get_origin(kind) is Literal
        argument = {"metavar": f"{{{','.join(get_args(kind))}}}"} if choice else _ARGUMENTS[kind]
        if argument.get("action") == "append":
            text, flag = f"{text}; may be repeated", flag.removesuffix("s")
        group.add_argument(flag, dest=field.name, help=text, **argument)


def energy_of(chosen: argparse.Namespace) -> glid_nb.energies.Energy:
    """The chosen energy. Raises an InputError for an unknown name, or for --s with an energy that
    has no s."""
    energy = glid_nb.energies.by_name(chosen.energy or _USUAL, chosen.s)
    if chosen.s is not None and not hasattr(energy, "s"):
        raise glid_nb.InputError(f"--s is the parameter of {_WITH_S}; {energy.name} has none")
    return energy


def options_of(chosen: argparse.Namespace) -> glid_nb.Options:
    return glid_nb.Options(**_given(chosen, glid_nb.Options))


def trace_options_of(chosen: argparse.Namespace) -> glid_nb.TraceOptions:
    options = _given(chosen, glid_nb.TraceOptions)
    if "scribbles" in options:
        options["scribbles"] = glid_nb.Scribbles.load(chosen.scribbles)
    return glid_nb.TraceOptions(**options)


def sets_energy(chosen: argparse.Namespace) -> bool:
    """Whether a flag of the energy was given, with any value."""
    return chosen.energy is not None or chosen.s is not None


def sets_tracing(chosen: argparse.Namespace) -> bool:
    """Whether a flag of the tracing was given, with any value."""
    return bool(_given(chosen, glid_nb.TraceOptions))


def _given(chosen: argparse.Namespace, kind: Any) -> dict[str, Any]:
    """The values of the given flags, by the names of the dataclass's fields."""
    known = field_kinds(kind)
    return {k: value for k, value in vars(chosen).items() if k in known and value is not None}
