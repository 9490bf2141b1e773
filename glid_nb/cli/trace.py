"""Trace the cage of a shape, with its holes, from a picture.

The result holds the cage and its holes in world coordinates (y up, origin at the picture's centre,
its longer side 20 units long). With the keys handles and targets added it is a problem for
`glid-nb solve`. Pixels count from the picture's top left corner, x to the right and y down.
"""

import argparse
from pathlib import Path
from typing import Any

import glid_nb
from glid_nb._errors import about
from glid_nb._json import write_json
from glid_nb.cli.flags import add_trace_flags, trace_options_of
from glid_nb.cli.output import check_files, step


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("image", type=Path, metavar="IMAGE", help="the picture's file")
    out = "where the cage goes"
    parser.add_argument("--out", type=Path, metavar="cage.json", required=True, help=out)
    add_trace_flags(parser)


def run(chosen: argparse.Namespace) -> None:
    check_files([chosen.out], [chosen.image, chosen.scribbles])
    options = trace_options_of(chosen)
    image = glid_nb.read_image(chosen.image)
    with about(chosen.image), step(f"tracing {chosen.image.name}"):
        tracing = glid_nb.trace(image, options)
    write_json(chosen.out, cage_data(tracing))
    print(f"{chosen.out}: {size_in_words(tracing.cage)}")
    for note in tracing.notes:
        print(f"  {note}")


def cage_data(tracing: glid_nb.Tracing) -> dict[str, Any]:
    """The content of cage.json."""
    size = [tracing.frame.width, tracing.frame.height]
    return {**tracing.cage.to_dict(), "image_size_px": size, "notes": list(tracing.notes)}


def size_in_words(cage: glid_nb.Cage) -> str:
    """For example "84 vertices, 1 hole"."""
    count = len(cage.holes) or "no"
    return f"{cage.n_vertices} vertices, {count} hole{'' if count == 1 else 's'}"
