"""Trace the cage of a shape, with its holes, from a picture.

The result contains the cage and its holes in world coordinates (y up, origin at the picture's
centre, its longer side 20 units long). With added keys handles and targets, it is a problem for
`glid-nb solve`. Pixels are counted from the picture's top left corner, x to the right and y down.

For many pictures, --out is a folder, and a picture that cannot be traced does not stop the others.
`--out -` is standard output.
"""

import argparse
from pathlib import Path
from typing import Any

import glid_nb
from glid_nb._errors import about
from glid_nb._json import json_text
from glid_nb.cli.flags import add_trace_flags, trace_options_of
from glid_nb.cli.many import destination, for_each, planned
from glid_nb.cli.output import check_files, step, tell, write


def add_arguments(parser: argparse.ArgumentParser) -> None:
    image = "the picture's file, or several"
    parser.add_argument("image", type=Path, nargs="+", metavar="IMAGE", help=image)
    out = "file for the cage; a folder for several, - for standard output"
    parser.add_argument("--out", type=destination, metavar="cage.json", required=True, help=out)
    add_trace_flags(parser)


def run(chosen: argparse.Namespace) -> None:
    results = planned(chosen.image, "--out", chosen.out, ".json")
    check_files(results, [*chosen.image, chosen.scribbles])
    options = trace_options_of(chosen)
    for_each(chosen.image, lambda i: _trace(chosen.image[i], options, results[i]), chosen.debug)


def _trace(path: Path, options: glid_nb.TraceOptions, out: Path | None) -> None:
    assert out is not None
    image = glid_nb.read_image(path)
    with about(path), step(f"tracing {path.name}"):
        tracing = glid_nb.trace(image, options)
    write(out, json_text(cage_data(tracing)))
    tell(f"{out}: {size_in_words(tracing.cage)}", out)
    for note in tracing.notes:
        tell(f"  {note}", out)


def cage_data(tracing: glid_nb.Tracing) -> dict[str, Any]:
    """The content of cage.json."""
    size = [tracing.frame.width, tracing.frame.height]
    return {**tracing.cage.to_dict(), "image_size_px": size, "notes": list(tracing.notes)}


def size_in_words(cage: glid_nb.Cage) -> str:
    """For example "84 vertices, 1 hole"."""
    count = len(cage.holes) or "no"
    return f"{cage.n_vertices} vertices, {count} hole{'' if count == 1 else 's'}"
