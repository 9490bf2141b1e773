"""Warp a picture through a map.

The picture must be the one from which the map's cage was traced, or one of the same size. Other
pictures are refused. The picture's longer side is 20 world units. If a map has no image_size_px,
its cage must lie on the picture. A line on stderr names each map that is not proved injective. For
many maps, --out is a folder, and a map that fails does not stop the others. `--out -` is standard
output.

With --interpolation nearest, values are never mixed, so label images stay label images. Then the
picture and the result may also be .npy or .tif files of any numbers and channels.
"""

import argparse
import sys
from pathlib import Path
from typing import Any

import glid_nb
from glid_nb._errors import InputFileError, about
from glid_nb._json import read_object
from glid_nb.cli.many import destination, for_each, planned
from glid_nb.cli.output import STANDARD_OUTPUT, check_files, step, tell, write

MAX_SIDE = 20_000
_NEAREST = (".png", ".npy", ".tif", ".tiff")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("image", type=Path, metavar="IMAGE", help="the picture's file")
    maps = "as `glid-nb solve` writes it; or several"
    add("map", type=Path, nargs="+", metavar="map.json", help=maps)
    out = "the file to write; a folder for several, - for standard output"
    add("--out", type=destination, metavar="picture.png", required=True, help=out)
    size = "pixels of the result (default: the picture's)"
    add("--size", type=_pixels, nargs=2, metavar=("W", "H"), help=size)
    view = "show the part of the plane that the picture covers (default), or all of the result"
    add("--view", choices=("source", "fit"), default="source", help=view)
    how = "smooth (default), or nearest: pixels keep the picture's values, for labels"
    add("--interpolation", choices=("smooth", "nearest"), default="smooth", help=how)
    fill = "the value outside the shape with --interpolation nearest (default: 0)"
    add("--fill", type=float, default=0.0, metavar="X", help=fill)


def run(chosen: argparse.Namespace) -> None:
    nearest = chosen.interpolation == "nearest"
    own = chosen.image.suffix.lower()
    suffix = own if nearest and own in _NEAREST else ".png"
    results = planned(chosen.map, "--out", chosen.out, suffix)
    for out in results:
        assert out is not None
        allowed = _NEAREST if nearest else (".png",)
        if out is not STANDARD_OUTPUT and out.suffix.lower() not in allowed:
            known = ", ".join(allowed)
            what = f"only {known} {'are' if nearest else 'is'} written"
            raise InputFileError(f"{out}: {what}; name a file that ends in {' or '.join(allowed)}")
    check_files(results, [chosen.image, *chosen.map])
    glid_nb.enable_compilation_cache()
    # This import is slow, and --help does not need it.
    from glid_nb.imaging.values import Values, read_values  # noqa: PLC0415

    picture = read_values(chosen.image) if nearest else glid_nb.read_image(chosen.image)
    array = picture.array if isinstance(picture, Values) else picture

    def one(i: int) -> None:
        out = results[i]
        assert out is not None
        data = read_object(chosen.map[i])
        with about(chosen.map[i]):
            map = glid_nb.HarmonicMap.from_dict(data)
            pose = glid_nb.Pose.from_dict(data) if "depths" in data else None
        _check_size(array, data, chosen.image, chosen.map[i])
        _render(picture, map, pose, out, chosen.map[i], chosen)

    for_each(chosen.map, one, chosen.debug)


def _check_size(image: Any, data: dict[str, Any], path: Path, map: Path) -> None:
    own = image.shape[1::-1]
    traced = data.get("image_size_px")
    if traced not in (None, list(own)):
        other = f"but {map} is of a picture of {traced!r:.60}"
        advice = "take the picture that its cage was traced from"
        raise InputFileError(f"{path} has {own[0]} x {own[1]} pixels, {other}; {advice}")


def _render(
    picture: Any,
    map: glid_nb.HarmonicMap,
    pose: glid_nb.Pose | None,
    out: Path,
    path: Path,
    chosen: argparse.Namespace,
) -> None:
    from glid_nb.imaging.values import Values, values_file  # noqa: PLC0415 - as above

    own = (picture.array if isinstance(picture, Values) else picture).shape[1::-1]
    size = tuple(chosen.size or own)
    with about(path), step("rendering (Ctrl-C stops, and nothing is written)") as detail:
        shown: Any = {"view": chosen.view, "pose": pose}
        shown["progress"] = lambda done, total: detail(f"{done / total:.0%}")
        if isinstance(picture, Values):
            fill = int(chosen.fill) if chosen.fill % 1 == 0 else chosen.fill
            shown |= {"interpolation": "nearest", "fill": fill}
            drawn = Values(glid_nb.render(picture.array, map, size, **shown), picture.palette)
            content = values_file(drawn, ".png" if out is STANDARD_OUTPUT else out.suffix.lower())
        else:
            content = glid_nb.export.picture_png(picture, map, size, **shown)
    write(out, content)
    tell(f"{out}: {size[0]} x {size[1]} pixels", out)
    if not (proof := glid_nb.certify(map)).certified:
        print(f"glid-nb: {path} is not proved locally injective. {proof.reason}", file=sys.stderr)


def _pixels(text: str) -> int:
    if len(text) > 9 or not text.isdecimal() or not 1 <= int(text) <= MAX_SIDE:
        wanted = f"a side is a whole number of pixels, 1 to {MAX_SIDE}"
        raise argparse.ArgumentTypeError(f"{wanted}, not {text!r:.40}")
    return int(text)
