"""Warp a picture through a map.

The picture must be the one that the map's cage was traced from, or one of the same size. Its
longer side is 20 world units.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import glid_nb
from glid_nb._errors import about
from glid_nb.cli.output import check_file, write_all
from glid_nb.cli.progress import step

MAX_SIDE = 20_000


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("image", type=Path, metavar="IMAGE", help="the picture's file")
    add("map", type=Path, metavar="map.json", help="as `glid-nb solve` writes it")
    add("--out", type=Path, metavar="picture.png", required=True, help="where the result goes")
    size = "pixels of the result (default: the picture's)"
    add("--size", type=_pixels, nargs=2, metavar=("W", "H"), help=size)
    view = "show the part of the plane that the picture covers (default), or all of the result"
    add("--view", choices=("source", "fit"), default="source", help=view)


def run(chosen: argparse.Namespace) -> None:
    check_file(chosen.out, ".png")
    glid_nb.enable_compilation_cache()
    harmonic_map = glid_nb.HarmonicMap.load(chosen.map)
    image = glid_nb.read_image(chosen.image)
    size = tuple(chosen.size or image.shape[1::-1])
    with about(chosen.map), step("rendering"):
        picture = glid_nb.export.picture_png(image, harmonic_map, size, chosen.view)
    write_all({chosen.out: picture})
    print(f"{chosen.out}: {size[0]} x {size[1]} pixels")


def _pixels(text: str) -> int:
    count = int(text)
    if not 1 <= count <= MAX_SIDE:
        raise argparse.ArgumentTypeError(f"a side has 1 to {MAX_SIDE} pixels, not {count}")
    return count
