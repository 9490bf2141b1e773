"""Make a certified deformation of a picture, and write all results.

The command traces the cage, poses it, solves, and writes into --out: deformed.png (the deformed
picture), overview.png (a figure of the whole solve), cage.json, map.json and report.json. IMAGE is
a file or the name of a bundled sample (see `glid-nb samples`). Without --pose, a sample gets its
gentle pose. For any other picture, handles are placed automatically, and one or two of them are
moved.
"""

import argparse
from pathlib import Path
from typing import cast

import numpy as np

import glid_nb
from glid_nb._errors import InputFileError, about
from glid_nb._json import json_text
from glid_nb.cli import flags
from glid_nb.cli.many import refuse_standard_output
from glid_nb.cli.output import check_files, check_folder, finish, map_text, run_solver, step
from glid_nb.cli.trace import cage_data, size_in_words

DEFAULT_SAMPLE = "gecko"
DEFAULT_POSE = "gentle"
_FILES = ("deformed.png", "overview.png", "cage.json", "map.json", "report.json")
_CROPPED = 1e-3  # zoom out if more than this share of the shape lies outside the picture's frame


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    image = f"a picture's file, or the name of a sample (default: {DEFAULT_SAMPLE})"
    add("image", nargs="?", default=DEFAULT_SAMPLE, metavar="IMAGE", help=image)
    pose = "handles and targets, world coordinates; for a sample also gentle or extreme"
    add("--pose", metavar="FILE.json", help=pose)
    out = "folder of the results (default: %(default)s)"
    add("--out", type=Path, default=Path("glid-nb-demo"), metavar="DIR", help=out)
    add("--json", action="store_true", help="print the summary as JSON")
    flags.add_solver_flags(parser)
    flags.add_trace_flags(parser)


def run(chosen: argparse.Namespace) -> None:
    out: Path = chosen.out
    refuse_standard_output(out, "--out", f"{len(_FILES)} files are written, so name a folder")
    check_folder(out)
    if out.is_dir():
        check_files([out / name for name in _FILES], [chosen.image, chosen.pose, chosen.scribbles])
    energy, options = flags.energy_of(chosen), flags.options_of(chosen)
    tracing_options = flags.trace_options_of(chosen)
    source, sample = _source(chosen.image)
    image = glid_nb.read_image(source)
    with about(source), step(f"tracing {source.name}"):
        tracing = glid_nb.trace(image, tracing_options)
        domain = glid_nb.Domain.from_cage(tracing.cage)
        image = glid_nb.cut_out(image, tracing)
    pose, origin = _pose(chosen.pose, sample, domain)

    result, report = run_solver(domain, pose, energy, options)
    assert isinstance(result.map, glid_nb.HarmonicMap)
    with step("rendering"):
        # This import is slow, and --help does not need it.
        from glid_nb.imaging.render import share_outside  # noqa: PLC0415

        cropped = share_outside(result.map, tracing.frame) > _CROPPED
        view = "fit" if cropped else "source"
        deformed = glid_nb.export.picture_png(image, result.map, view=view, pose=pose)
    with step("drawing the overview"):
        figure = glid_nb.figures.figure_png(glid_nb.figures.overview(image, result, pose))

    texts = json_text(cage_data(tracing)), map_text(result.map, image.shape[1::-1], pose)
    contents = (deformed, figure, *texts, json_text(report))
    files = {out / name: data for name, data in zip(_FILES, contents, strict=True)}
    out.mkdir(parents=True, exist_ok=True)
    notes = [*tracing.notes, *domain.notes]
    if cropped:
        notes.append("deformed.png is zoomed out, because the shape leaves the picture's frame")
    moved = int((np.linalg.norm(pose.targets - pose.handles, axis=1) > 0).sum())
    rows = [
        ("picture", f"{source}, {tracing.frame.width} x {tracing.frame.height} pixels"),
        ("cage", size_in_words(tracing.cage)),
        *(("notes", note) for note in notes),
        ("pose", f"{origin}: {len(pose)} handles, {moved} moved"),
    ]
    finish(result, report, files, chosen.json, rows, image=str(source), pose=origin, notes=notes)


def _source(image: str) -> tuple[Path, str | None]:
    """The picture's file, and the sample's name if it is a sample. A file with the name of a sample
    has priority."""
    if Path(image).exists():
        return Path(image), None
    names = glid_nb.samples.names()
    if image not in names:
        raise InputFileError(f"{image}: no such file, and no such sample ({', '.join(names)})")
    return glid_nb.samples.path(image), image


def _pose(
    wanted: str | None, sample: str | None, domain: glid_nb.Domain
) -> tuple[glid_nb.Pose, str]:
    if sample is not None and not (wanted and Path(wanted).exists()):
        kind = cast("glid_nb.samples.PoseKind", wanted or DEFAULT_POSE)
        path, origin = glid_nb.samples.pose_path(sample, kind), f"the sample's own, {kind}"
    elif wanted is None:
        return glid_nb.suggest_pose(domain), "chosen automatically (give your own with --pose)"
    else:
        path, origin = Path(wanted), wanted
    pose = glid_nb.io.load_pose(path)
    with about(path):
        pose.check_inside(domain)
    return pose, origin
