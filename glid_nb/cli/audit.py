"""Prove that a warp of any origin is free of folds, or say where it folds.

FILE is a displacement field (.npy, .npz, .nii, .nii.gz, .nrrd, .nhdr) of shape (h, w, 2), in
pixels: the pixel (x, y) goes to (x + dx, y + dy), and cells between pixels are bilinear. Medical
files have (x, y, 2) or (x, y, 1, 1, 2) instead, and need the extra `imaging`. Or FILE is a mesh
(.obj): its vertices are the images, and its texture coordinates, or the vertices of --source, are
where they come from. Every sign is exact.

The exit code is 0 if every warp is proved free of folds, 3 if one is not, 1 for files that cannot
be read. For many files, --figure and --report are folders.
"""

import argparse
import itertools
import json
import math
from pathlib import Path

import glid_nb
from glid_nb._errors import InputFileError, about
from glid_nb._json import json_text
from glid_nb.auditing.files import read_warp
from glid_nb.cli.many import destination, for_each, planned
from glid_nb.cli.output import STANDARD_OUTPUT, check_files, step, tell, write

NOT_PROVED = 3


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("file", type=Path, nargs="+", metavar="FILE", help="the warp, or several")
    add("--source", type=Path, metavar="rest.obj", help="where the vertices of a mesh come from")
    order = "of a field: xy for (dx, dy) (default), yx for (dy, dx)"
    add("--order", choices=("xy", "yx"), default="xy", help=order)
    spacing = "steps between pixels in the displacements' unit (default: as the file says, or 1 1)"
    add("--spacing", type=_step, nargs=2, metavar=("SX", "SY"), help=spacing)
    figure = "where a picture of the determinant and the folds goes"
    add("--figure", type=destination, metavar="folds.png", help=figure)
    add("--report", type=destination, metavar="audit.json", help="where the result goes, as JSON")
    add("--json", action="store_true", help="print the result as JSON")


def run(chosen: argparse.Namespace) -> int:
    files: list[Path] = chosen.file
    flags = {"--figure": (chosen.figure, ".png"), "--report": (chosen.report, ".json")}
    standard = [flag for flag, (to, _) in flags.items() if to and to.path is STANDARD_OUTPUT]
    if len(standard) > 1 or (standard and chosen.json):
        both = " and ".join([*standard, *(["--json"] if chosen.json else [])])
        raise InputFileError(f"{both} would share standard output; name a file for one of them")
    figures, reports = (planned(files, flag, *how) for flag, how in flags.items())
    for figure in figures:
        if figure and figure is not STANDARD_OUTPUT and figure.suffix.lower() != ".png":
            raise InputFileError(f"{figure}: only .png is written; name a file that ends in .png")
    check_files(itertools.chain(figures, reports), [*files, chosen.source])
    proved: list[bool] = []

    def one(i: int) -> None:
        proved.append(_audit(files[i], figures[i], reports[i], chosen))

    for_each(files, one, chosen.debug)
    return 0 if all(proved) else NOT_PROVED


def _audit(
    path: Path, figure: Path | None, report: Path | None, chosen: argparse.Namespace
) -> bool:
    with step(f"auditing {path.name}"):
        warp = read_warp(path, chosen.source, chosen.spacing)
        with about(path):
            found = warp.audit(chosen.order)
    if figure:
        write(figure, glid_nb.figures.figure_png(glid_nb.figures.folds(found)))
    data = {"file": str(path), **found.to_dict()}
    if report:
        write(report, json_text(data))
    if chosen.json:
        print(json.dumps(data))
    else:
        tell(f"{path}: {found.message}", figure, report)
    return found.proved


def _step(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not math.isfinite(value) or not value:
        raise argparse.ArgumentTypeError(f"a step is a number other than 0, not {text!r:.40}")
    return value
