"""Warp a picture through a map.

The picture must be the one that the map's cage was traced from, or another one of the same size.
Its longer side is 20 world units.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import glid_nb
from glid_nb.cli.errors import about
from glid_nb.cli.output import check_png, png_bytes, write_all
from glid_nb.cli.progress import Progress

MAX_SIDE = 20_000


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument("image", type=Path, metavar="IMAGE")
    parser.add_argument("map", type=Path, metavar="map.json")
    parser.add_argument("--out", type=Path, metavar="picture.png", required=True)
    parser.add_argument(
        "--size",
        type=_pixels,
        nargs=2,
        metavar=("W", "H"),
        help="pixels of the result (the picture's)",
    )
    parser.add_argument(
        "--view",
        choices=("source", "fit"),
        default="source",
        help="show the part of the plane that the picture covers (default), or all of the result",
    )


def run(chosen: argparse.Namespace) -> None:
    """Run the command."""
    check_png(chosen.out)
    glid_nb.enable_compilation_cache()
    progress = Progress()
    harmonic_map = glid_nb.HarmonicMap.load(chosen.map)
    image = glid_nb.read_image(chosen.image)
    with about(chosen.map), progress.step("rendering"):
        size = tuple(chosen.size) if chosen.size else None
        picture = glid_nb.render(image, harmonic_map, size=size, view=chosen.view)
    write_all({chosen.out: png_bytes(picture)})
    height, width = picture.shape[:2]
    print(f"{chosen.out}: {width} x {height} pixels")


def _pixels(text: str) -> int:
    count = int(text)
    if not 1 <= count <= MAX_SIDE:
        raise argparse.ArgumentTypeError(f"a side has 1 to {MAX_SIDE} pixels, not {count}")
    return count
