"""Make a moving picture from the poses of a session.

SOURCE is a session (.glid) or a file of `Motion.save`. The poses of a session are the keyframes, at
the times of its timeline. A file of `Motion.save` needs --picture. The suffix of --out selects the
format: .gif, .apng, .mp4 and .webm (with the extra `video`), .html for a page, .glb for a mesh with
morph targets, .sheet.png for a sprite sheet with its JSON, .zip for frames as PNG, no suffix for a
folder of frames. .motion.json writes the motion, and its proof for `glid-check` to
.motion.proof.json.
"""

import argparse
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from PIL import ImageColor

import glid_nb
from glid_nb._errors import InputError, InputFileError
from glid_nb.cli.many import refuse_standard_output
from glid_nb.cli.output import check_files, check_folder, step
from glid_nb.export.formats import names_for_parts
from glid_nb.export.moving import MovingPart
from glid_nb.imaging.backdrop import WHITE, Background
from glid_nb.session.posed_shapes import shapes_of
from glid_nb.session.timeline import LEAST_GAP, Timeline
from glid_nb.session.unsolved import solved_document

_Range = tuple[float, float]


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("source", type=Path, metavar="SOURCE", help="a session, or a saved motion")
    add("--out", type=Path, metavar="walk.mp4", required=True, help="the file to write")
    add("--picture", type=Path, metavar="IMAGE", help="the picture of a saved motion")
    size = "pixels of the longer side (default: %(default)s); not for .html and .glb"
    add("--size", type=int, default=480, metavar="N", help=size)
    add("--fps", type=float, default=25.0, metavar="N", help="frames per second, 0 to 100")
    seconds = "length of the whole motion (default: that of the timeline or of the saved motion)"
    add("--seconds", type=float, metavar="S", help=seconds)
    part = "only this part, on the way forth, which then repeats; in seconds, after --seconds"
    range_ = parser.add_mutually_exclusive_group()
    range_.add_argument("--range", type=float, nargs=2, metavar=("START", "END"), help=part)
    marked = "only the session's loop range, between the two marks on the timeline's ruler"
    range_.add_argument("--loop-range", action="store_true", help=marked)
    loop = "after the last pose: go to the first one, go back, or stop (default: as saved)"
    add("--loop", choices=("loop", "ping-pong", "once"), help=loop)
    color = "a name, #rrggbb, or `transparent`, but not for .gif and .mp4 (default: that of the "
    color += "session, or white)"
    add("--background", type=_color, default=argparse.SUPPRESS, metavar="COLOR", help=color)


def run(chosen: argparse.Namespace) -> None:
    out: Path = chosen.out
    refuse_standard_output(out, "--out", "the suffix determines the format, so name a file")
    _check_places(chosen, [""])
    glid_nb.enable_compilation_cache()
    parts, behind, marked = _read(chosen)
    within = marked if chosen.range is None else (chosen.range[0], chosen.range[1])
    if within is not None:
        parts = [part.between(*within) for part in parts]
    motion = parts[0].motion
    with step("proving and drawing (Ctrl-C stops, and nothing is written)") as detail:
        how: Any = {"size": chosen.size, "frames_per_second": chosen.fps}
        how |= {
            "background": getattr(chosen, "background", behind),
            "loop": chosen.loop_range or within is not None or motion.repeat != "once",
        }
        how |= {"progress": lambda done, total: detail(f"frame {done} of {total}")}
        if len(parts) > 1:
            files = glid_nb.export.animate_parts(out, parts, **how)
        else:
            files = glid_nb.export.animate(out, parts[0].image, motion, parts[0].poses, **how)
    written = ", ".join(map(str, files)) if out.suffix else f"{out}: {len(files)} files"
    print(f"{written}; {motion.duration:g} s. {_proofs(parts)}")


def _proofs(parts: Sequence[MovingPart]) -> str:
    """What is proved of each part, by its name if there are several."""
    if len(parts) == 1:
        return parts[0].motion.certificate.reason
    return " ".join(f"{part.name}: {part.motion.certificate.reason}" for part in parts)


def _check_places(chosen: argparse.Namespace, parts: Sequence[str]) -> None:
    """Raise an error if a file for parts with these names cannot be made."""
    out: Path = chosen.out
    if not glid_nb.export.suffix_of(out.name):
        check_folder(out)
    else:
        files = map(out.with_name, names_for_parts(out.name, parts))
        check_files(list(files), [chosen.source, chosen.picture])


def _read(chosen: argparse.Namespace) -> tuple[list[MovingPart], Background, _Range | None]:
    """The visible shapes with their motions, what lies behind them, and the range of --loop-range;
    None for all of the motion."""
    if chosen.source.suffix.lower() != ".json":
        document = glid_nb.io.load_document(chosen.source)
        if (count := len(document.poses)) < 2:
            raise InputFileError(f"{chosen.source} holds {count} poses; a motion needs at least 2")
        if chosen.picture is not None:
            raise InputError("--picture is for saved motions; a session holds its picture")
        if len(visible := [part.name for part in document.parts if part.visible]) > 1:
            _check_places(chosen, visible)
        if document.unsolved:  # saved while the solver was paused, or by an older version
            with step("solving the poses that were saved unsolved") as detail:
                document = solved_document(document, detail)
        shapes, behind = shapes_of(document)
        timeline = shapes[0].timeline
        timeline = replace(timeline, repeat=chosen.loop or timeline.repeat)
        if chosen.loop_range:
            _check_marked(chosen.source, timeline)
        if chosen.seconds is not None:
            there = 2 if timeline.repeat == "ping-pong" else 1
            timeline = timeline.lasting(_seconds(chosen) / there)
        parts = [replace(shape, timeline=timeline).moving for shape in shapes]
        marked = timeline.played_range if chosen.loop_range else None
        return parts, WHITE if behind is None else behind, marked
    motion = glid_nb.Motion.load(chosen.source)
    if chosen.picture is None or chosen.loop not in (None, motion.repeat):
        advice = "name its picture with --picture, and leave out --loop: it has its own setting"
        raise InputError(f"{chosen.source} is a saved motion: {advice}")
    if chosen.loop_range:
        what = f"{chosen.source} is a saved motion, which has no loop range"
        raise InputError(f"{what}; give times with --range")
    if motion.image_size is None:
        doubt = f"{chosen.source} does not say how large its picture is"
        advice = f"make sure that its cage was traced from {chosen.picture}"
        print(f"glid-nb: {doubt}; {advice}", file=sys.stderr)
    if chosen.seconds is not None:
        times = [_seconds(chosen) / motion.duration * time for time in motion.times]
        motion = glid_nb.Motion(motion.keyframes, times, **motion.settings)
    return [MovingPart(glid_nb.read_image(chosen.picture), motion)], WHITE, None


def _check_marked(source: Path, timeline: Timeline) -> None:
    """Raise an InputError unless a part of the motion lies in the timeline's loop range."""
    if timeline.loop_range is None:
        what = f"{source} has no loop range; set it on the timeline in the editor"
        raise InputError(f"{what}, or give times with --range")
    (start, end), first, last = timeline.loop_range, timeline.times[0], timeline.end
    if min(end, last) - max(start, first) < LEAST_GAP:
        where = f"lies from {start:g} to {end:g} s, but the motion from {first:g} to {last:g} s"
        raise InputError(f"{source}: the loop range {where}; give times with --range")


def _seconds(chosen: argparse.Namespace) -> float:
    if not 0 < chosen.seconds < 1e6:
        raise InputError(f"--seconds is {chosen.seconds:g}; it must be above 0, up to a million")
    return chosen.seconds


def _color(text: str) -> tuple[int, int, int] | None:
    if text == "transparent":
        return None
    try:
        red, green, blue, *_ = ImageColor.getrgb(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r:.40} is not a colour") from None
    return red, green, blue
