"""Warp a picture through a map.

The picture must be the one that the map's cage was traced from, or one of the same size; another
is refused. Its longer side is 20 world units. Maps without image_size_px do not tell the size:
their cage must then lie on the picture. A line on stderr says which map is not proved injective.
"""

import argparse
import sys
from pathlib import Path

import glid_nb
from glid_nb._errors import InputFileError, about
from glid_nb._files import write_atomically
from glid_nb._json import read_object
from glid_nb.cli.output import check_files, step

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
    if chosen.out.suffix.lower() != ".png":
        raise InputFileError(f"{chosen.out}: only .png is written; name a file that ends in .png")
    check_files([chosen.out], [chosen.image, chosen.map])
    glid_nb.enable_compilation_cache()
    data = read_object(chosen.map)
    with about(chosen.map):
        harmonic_map = glid_nb.HarmonicMap.from_dict(data)
        pose = glid_nb.Pose.from_dict(data) if "depths" in data else None
    image = glid_nb.read_image(chosen.image)
    own = image.shape[1::-1]
    traced = data.get("image_size_px")
    if traced not in (None, list(own)):
        other = f"but {chosen.map} is of a picture of {traced!r:.60}"
        advice = "take the picture that its cage was traced from"
        raise InputFileError(f"{chosen.image} has {own[0]} x {own[1]} pixels, {other}; {advice}")
    size = tuple(chosen.size or own)
    with about(chosen.map), step("rendering"):
        picture = glid_nb.export.picture_png(image, harmonic_map, size, chosen.view, pose)
    write_atomically(chosen.out, picture)
    print(f"{chosen.out}: {size[0]} x {size[1]} pixels")
    if not (proof := glid_nb.certify(harmonic_map)).certified:
        what = f"{chosen.map} is not proved locally injective"
        print(f"glid-nb: {what}. {proof.reason}", file=sys.stderr)


def _pixels(text: str) -> int:
    if len(text) > 9 or not text.isdecimal() or not 1 <= int(text) <= MAX_SIDE:
        wanted = f"a side is a whole number of pixels, 1 to {MAX_SIDE}"
        raise argparse.ArgumentTypeError(f"{wanted}, not {text!r:.40}")
    return int(text)
