"""Trace the cage of a shape, with its holes, from a picture.

The result holds the cage and its holes in world coordinates (y up, origin at the picture's centre,
its longer side 20 units long). With the keys handles and targets added it is a problem for
`glid-nb solve`. Pixels count from the picture's top left corner, x to the right and y down.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import glid_nb
from glid_nb.cli.errors import about
from glid_nb.cli.output import check_file, json_text, write_all
from glid_nb.cli.progress import Progress

_PIXEL: dict[str, Any] = {"type": float, "nargs": 2, "metavar": ("X", "Y")}
# The flags are named as the fields of TraceOptions; one that is not given is left to the library.
_NUMBERS: tuple[tuple[str, dict[str, Any]], ...] = (
    ("threshold", {"type": float, "metavar": "T", "help": "least value of the foreground, 0 to 1"}),
    (
        "background",
        {
            "type": float,
            "nargs": 3,
            "metavar": ("R", "G", "B"),
            "help": "background colour, each 0 to 1 (default: estimated from the border)",
        },
    ),
    ("background_at", {**_PIXEL, "help": "a pixel that shows the background's colour"}),
    ("smoothing", {"type": float, "metavar": "PX", "help": "blur before the outline is taken"}),
    ("component", {"type": int, "metavar": "I", "help": "which component, 0 being the largest"}),
    ("component_at", {**_PIXEL, "help": "a pixel in the component to trace"}),
    ("min_hole_area", {"type": float, "metavar": "PX2", "help": "smaller holes are filled"}),
    ("offset", {"type": float, "metavar": "PX", "help": "distance of the cage from the outline"}),
    ("simplify", {"type": float, "metavar": "PX", "help": "how far simplification may move it"}),
    ("max_vertices", {"type": int, "metavar": "N", "help": "most vertices of the cage"}),
    ("min_edge", {"type": float, "metavar": "PX", "help": "shorter edges are merged"}),
    ("max_edge", {"type": float, "metavar": "PX", "help": "longer edges are divided"}),
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument("image", type=Path, metavar="IMAGE")
    parser.add_argument("--out", type=Path, metavar="cage.json", required=True)
    add_trace_arguments(parser)


def add_trace_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the flags of the tracing itself."""
    group = parser.add_argument_group("tracing")
    group.add_argument(
        "--method",
        metavar="{auto,alpha,threshold,color,scribbles}",
        default="auto",
        help="how the foreground is found (default: what suits the picture)",
    )
    group.add_argument(
        "--scribbles",
        type=Path,
        metavar="FILE.json",
        help="strokes, as lists of [x, y] pixels, under the keys foreground and background",
    )
    group.add_argument(
        "--invert",
        action=argparse.BooleanOptionalAction,
        help="swap foreground and background",
    )
    for name, settings in _NUMBERS:
        group.add_argument("--" + name.replace("_", "-"), **settings)
    for verb, done in (("keep", "kept"), ("drop", "filled")):
        group.add_argument(
            f"--{verb}-hole",
            action="append",
            default=[],
            help=f"a pixel in a hole that is {done} whatever its size; may be repeated",
            **_PIXEL,
        )


def trace_options_of(chosen: argparse.Namespace) -> glid_nb.TraceOptions:
    """The options that the flags name."""
    given = {n: getattr(chosen, n) for n, _ in _NUMBERS if getattr(chosen, n) is not None}
    if chosen.scribbles is not None:
        given["scribbles"] = glid_nb.Scribbles.load(chosen.scribbles)
    return glid_nb.TraceOptions(
        method=chosen.method,
        invert=chosen.invert,
        keep_holes=chosen.keep_hole,
        drop_holes=chosen.drop_hole,
        **given,
    )


def run(chosen: argparse.Namespace) -> None:
    """Run the command."""
    check_file(chosen.out)
    options = trace_options_of(chosen)
    image = glid_nb.read_image(chosen.image)
    with about(chosen.image), Progress().step(f"tracing {chosen.image.name}"):
        tracing = glid_nb.trace(image, options)
    write_all({chosen.out: json_text(cage_data(tracing))})
    print(f"{chosen.out}: {size_in_words(tracing.cage)}")
    for note in tracing.notes:
        print(f"  {note}")


def cage_data(tracing: glid_nb.Tracing) -> dict[str, Any]:
    """What cage.json holds."""
    return {
        **tracing.cage.to_dict(),
        "image_size_px": [tracing.frame.width, tracing.frame.height],
        "notes": list(tracing.notes),
    }


def size_in_words(cage: glid_nb.Cage) -> str:
    """For example "84 vertices, 1 hole"."""
    count = len(cage.holes) or "no"
    return f"{cage.n_vertices} vertices, {count} hole{'' if count == 1 else 's'}"
