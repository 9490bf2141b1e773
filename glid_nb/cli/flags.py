"""The flags of the energy, the solver and the tracing, named like the fields that they set.

A flag that is not given is None and leaves its field at the library's default. The library checks
the values and lists the choices.
"""

from __future__ import annotations

import argparse
import dataclasses
from pathlib import Path
from typing import Any, get_args, get_type_hints

import glid_nb
from glid_nb.energies import ENERGIES

_WITH_S = " and ".join(name for name, energy in ENERGIES.items() if "s" in energy.parameters())


def add_solver_flags(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument_group("energy and solver").add_argument
    energies = "; ".join(f"{name}: {energy.label}" for name, energy in ENERGIES.items())
    add("--energy", metavar=f"{{{','.join(ENERGIES)}}}", default="iso", help=energies)
    add("--s", type=float, metavar="S", help=f"parameter of {_WITH_S}, above 0 (default 1)")
    kinds = get_type_hints(glid_nb.Options)
    for field in dataclasses.fields(glid_nb.Options):
        kind, choices = kinds[field.name], field.metadata["choices"]
        text = field.metadata["help"][0].lower() + field.metadata["help"][1:]
        if field.default is not None:
            text += f" (default {field.default})"
        flag = f"--{field.name.replace('_', '-')}"
        if choices:
            text += "; " + ", ".join(f"{value}: {label}" for value, label in choices.items())
            add(flag, metavar=f"{{{','.join(choices)}}}", help=text)
        elif kind is bool:
            add(flag, action=argparse.BooleanOptionalAction, help=text)
        else:
            add(flag, type=get_args(kind)[0] if get_args(kind) else kind, metavar="N", help=text)


def add_trace_flags(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument_group("tracing").add_argument
    pixel: dict[str, Any] = {"type": float, "nargs": 2, "metavar": ("X", "Y")}
    add(
        "--method",
        metavar="{auto,alpha,threshold,color,scribbles}",
        help="how the foreground is found (default: what suits the picture)",
    )
    strokes = "strokes, as lists of [x, y] pixels, under the keys foreground and background"
    add("--scribbles", type=Path, metavar="FILE.json", help=strokes)
    add("--invert", action=argparse.BooleanOptionalAction, help="swap foreground and background")
    add("--threshold", type=float, metavar="T", help="least value of the foreground, 0 to 1")
    color = "background colour, each 0 to 1 (default: estimated from the border)"
    add("--background", type=float, nargs=3, metavar=("R", "G", "B"), help=color)
    add("--background-at", help="a pixel that shows the background's colour", **pixel)
    add("--smoothing", type=float, metavar="PX", help="blur before the outline is taken")
    add("--component", type=int, metavar="I", help="which component, 0 being the largest")
    add("--component-at", help="a pixel in the component to trace", **pixel)
    add("--min-hole-area", type=float, metavar="PX2", help="smaller holes are filled")
    add("--offset", type=float, metavar="PX", help="distance of the cage from the outline")
    add("--simplify", type=float, metavar="PX", help="how far simplification may move it")
    add("--max-vertices", type=int, metavar="N", help="most vertices of the cage")
    add("--min-edge", type=float, metavar="PX", help="shorter edges are merged")
    add("--max-edge", type=float, metavar="PX", help="longer edges are divided")
    for verb, done in (("keep", "kept"), ("drop", "filled")):
        text = f"a pixel in a hole that is {done} whatever its size; may be repeated"
        add(f"--{verb}-hole", dest=f"{verb}_holes", action="append", help=text, **pixel)


def energy_of(chosen: argparse.Namespace) -> glid_nb.Energy:
    """The chosen energy; InputError for an unknown name, or --s for an energy without it."""
    energy = glid_nb.energy_by_name(chosen.energy, chosen.s)
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


def _given(chosen: argparse.Namespace, kind: Any) -> dict[str, Any]:
    """The fields of a dataclass whose flags are given, with their values."""
    known = {field.name for field in dataclasses.fields(kind)}
    return {k: value for k, value in vars(chosen).items() if k in known and value is not None}
