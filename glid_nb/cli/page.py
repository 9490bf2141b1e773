"""Make a live page of a picture: click to pin, drag, and nothing ever folds.

The page is one HTML file, for any browser of 2023 or later, on phones too. It needs no Python and
no network. The picture is traced as by `glid-nb trace`. The page proves every map that it shows.
`--out -` is standard output.

With --pose, a file of handles and targets, the page begins with these pins, and solves them itself.

IMAGE may also be a session (.glid). Its page has all visible parts and their pins, and plays its
motion if it has several poses. A session has its own energy and outlines.
"""

import argparse
from collections.abc import Sequence
from pathlib import Path

import glid_nb
from glid_nb._errors import InputError, InputFileError, about
from glid_nb._files import read_file
from glid_nb.cli.flags import (
    add_energy_flags,
    add_trace_flags,
    energy_of,
    sets_energy,
    sets_tracing,
    trace_options_of,
)
from glid_nb.cli.many import destination
from glid_nb.cli.output import STANDARD_OUTPUT, check_files, step, tell, write
from glid_nb.session.posed_shapes import live_parts, shapes_of
from glid_nb.session.unsolved import solved_document


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("image", type=Path, metavar="IMAGE", help="the picture's file, or a session")
    out = "the file to write; - for standard output"
    add("--out", type=destination, metavar="page.html", required=True, help=out)
    add("--title", metavar="TEXT", help="the page's title (default: the picture's name)")
    pose = "a file with handles and targets, which are pinned at first"
    add("--pose", type=Path, metavar="pose.json", help=pose)
    add_energy_flags(parser)
    add_trace_flags(parser)


def run(chosen: argparse.Namespace) -> None:
    out = chosen.out.path
    check_files([out], [chosen.image, chosen.pose, chosen.scribbles])
    with_session = chosen.image.suffix.lower() == ".glid"
    page, notes = (_page_of_session if with_session else _page_of_picture)(chosen)
    write(out, page)
    size = "" if out is STANDARD_OUTPUT else f", {len(page.encode()) / 1000:.0f} kB"
    tell(f"{out}: a live page{size}; open it in a browser", out)
    for note in notes:
        tell(f"  {note}", out)


def _page_of_picture(chosen: argparse.Namespace) -> tuple[str, Sequence[str]]:
    """The page, and what tracing noticed."""
    energy, options = energy_of(chosen), trace_options_of(chosen)
    path: Path | None = chosen.pose
    pose = None if path is None else glid_nb.io.load_pose(path)
    if chosen.image.is_file() and read_file(chosen.image).startswith(b"PK"):
        what = f"{chosen.image} is a session or another zip file"
        raise InputFileError(f"{what}; the name of a session must end in .glid")
    image = glid_nb.read_image(chosen.image)
    with about(chosen.image), step(f"tracing {chosen.image.name}"):
        tracing = glid_nb.trace(image, options)
        domain = glid_nb.Domain.from_cage(tracing.cage)
        image = glid_nb.cut_out(image, tracing)
    if path is not None and pose is not None:
        with about(path):
            pose.check_inside(domain)
    with step("making the page"):
        page = glid_nb.export.live_page_html(image, domain, pose, energy, title=_title(chosen))
    return page, tracing.notes


def _page_of_session(chosen: argparse.Namespace) -> tuple[str, Sequence[str]]:
    _refuse_settings(chosen)
    document = glid_nb.io.load_document(chosen.image)
    with about(chosen.image):
        if document.unsolved:
            with step("solving the poses that were saved unsolved") as detail:
                document = solved_document(document, detail)
        shapes, behind = shapes_of(document)
        with step("making the page"):
            return glid_nb.export.parts_live_html(live_parts(shapes), _title(chosen), behind), ()


def _refuse_settings(chosen: argparse.Namespace) -> None:
    """Raise an InputError if something was set that a session has already."""
    if sets_energy(chosen) or sets_tracing(chosen) or chosen.pose is not None:
        what = f"{chosen.image} is a session, with its own outlines, pins and energy"
        raise InputError(f"{what}; leave out --pose, --energy, --s and the flags of the tracing")


def _title(chosen: argparse.Namespace) -> str:
    return chosen.image.stem if chosen.title is None else chosen.title
