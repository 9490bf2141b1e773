"""Exports of an editor. The file's suffix selects the format. Motions export in the background."""

import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import ipywidgets

from glid_nb import export as to
from glid_nb._errors import InputError
from glid_nb._files import read_file, write_atomically
from glid_nb._json import json_text, parse_json
from glid_nb._runtime import data_directory
from glid_nb.certificate import certificate_of
from glid_nb.certificate.certify import proof_text
from glid_nb.export.formats import FORMATS, MOTION_FORMATS, ExportError, file_names, suffix_of
from glid_nb.imaging.backdrop import WHITE
from glid_nb.imaging.read import png
from glid_nb.imaging.render import View
from glid_nb.motion import Motion, unlike_turns
from glid_nb.session.animation import Animation, motion_of, order_at
from glid_nb.session.document_file import document_bytes
from glid_nb.session.editor_model import EditorModel
from glid_nb.session.look import FILLED, WHOLE_CAGE, Look
from glid_nb.session.script import python_code
from glid_nb.session.worker import LatestWins, weakly
from glid_nb.widgets.closing import ClosingWidget
from glid_nb.widgets.controls import REFUSED, button, toggle

_MOST_CHOICES = 10_000  # most bytes of the file with an export's choices
_NUMBER = {"width": "70px", "flex": "0 0 auto"}

_LOOKS = {
    "Transparent": Look(),
    "The old picture, filled in": Look(background=FILLED),
    "White": Look(background=WHITE),
    "Black": Look(background=(0, 0, 0)),
    "Transparent; shape not cut out": WHOLE_CAGE,
}
# A picture with transparency of its own is cut out already.
_LOOKS_OF_CUT_OUTS = {name: _LOOKS[name] for name in ("Transparent", "White", "Black")}

# A name, and a function that takes the files and returns a text about where they are.
_Task = tuple[str, Callable[[dict[str, bytes]], str]]


class OccupiedError(ExportError):
    """An export would replace files that the editor did not write. ``plain`` asks the user."""

    def __init__(self, paths: Sequence[Path]) -> None:
        names = ", ".join(str(path.absolute()) for path in paths)
        super().__init__(f"already there: {names}; choose another name, or move it away")
        verb = "is" if len(paths) == 1 else "are"
        self.plain = (
            f"{names_of(paths)} {verb} in {paths[0].absolute().parent} already, not written by "
            "this editor. Click again to replace, or choose another name."
        )


def names_of(paths: Sequence[Path]) -> str:
    """The names of files as text, such as "a, b and c"."""
    *others, last = (path.name for path in paths)
    return f"{', '.join(others)} and {last}" if others else last


def files_of(path: Path) -> tuple[Path, ...]:
    """The files that `export` writes for this name: itself, then the additional files."""
    return tuple(map(path.with_name, file_names(path.name, FORMATS)))


def check_free(model: EditorModel, paths: Sequence[Path], owner: Path) -> None:
    """Raise an `OccupiedError` if a file exists that the editor did not write for ``owner``."""
    if strangers := model.own_files.strangers(paths, owner):
        raise OccupiedError(strangers)


def export(
    model: EditorModel,
    path: str | Path,
    size: tuple[int, int] | None = None,
    view: View = "source",
    live: bool = False,
) -> tuple[Path, ...]:
    """Write `exported` files. They may replace files of an earlier export. Raises an
    `OccupiedError` if additional files would replace others."""
    path = Path(path)
    if live:
        if not path.name.lower().endswith(".html"):
            raise ExportError(f"{path.name!r:.200}: the name of a live page must end in .html")
        files = {path.name: live_page(model, path.name)}
    elif path.name.lower().endswith(tuple(MOTION_FORMATS.keys() - FORMATS.keys())):
        motion = motion_of(model.deformation.solved_state())
        sized: dict[str, Any] = {"size": max(size)} if size else {}
        files = _motion_files(model, motion, path.name, **sized)
    else:
        files = exported(model, path, size, view)
    (name, data), *others = files.items()
    # If the named file exists, the additional files belong to it.
    beside = write(model, path, dict(others), replace=path.exists())
    return (*write(model, path, {name: data}, replace=True), *beside)


def exported(
    model: EditorModel, path: Path, size: tuple[int, int] | None, view: View
) -> dict[str, bytes]:
    """The contents of the files `files_of(path)`, by name. Arguments are as in `Editor.export`.

    The edited pose is solved first; for sessions and scripts, all poses. Raises an EditError if a
    pose cannot be solved, so that a picture, a mesh or a proof would show another map.
    """
    deformation, suffix = model.deformation, suffix_of(path.name, FORMATS)
    if suffix == ".live.html":
        return {path.name: live_page(model, path.name)}
    if suffix in (".glid", ".py"):
        deformation.finish()
        state = deformation.state
    else:
        state = deformation.solved_state(only_current=True)
    document, layers = model.document, model.layers
    map_, pose = state.map, state.pose
    background = layers.background if suffix in (".png", ".html") else None
    names = [file.name for file in files_of(path)]
    match suffix:
        case ".png":
            shown = {"view": view, "pose": pose, "background": background}
            contents = [to.picture_png(layers.image, map_, size, **shown)]
        case ".obj":
            files = to.mesh_obj(to.textured_mesh(layers.image, map_, pose=pose), path.stem)
            contents = [files[path.stem + rest] for rest in (".obj", *FORMATS[".obj"].beside)]
        case ".glb":
            contents = [to.mesh_glb(to.textured_mesh(layers.image, map_, pose=pose))]
        case ".svg":
            height, width = document.image.shape[:2]
            contents = [to.cage_svg(map_, (width, height), source=True, pose=pose).encode()]
        case ".html":
            shown = {"title": path.stem, "pose": pose, "background": background}
            contents = [to.page_html(layers.image, map_, certificate_of(map_), **shown).encode()]
        case ".glid":
            contents = [document_bytes(document)]
        case ".proof.json":
            depths = pose.to_dict() if pose.depths.any() else {}
            proof = proof_text(certificate_of(map_))
            contents = [proof.encode(), json_text({**map_.to_dict(), **depths}).encode()]
        case _:
            contents = [python_code(document, names[1]).encode(), png(document.image)]
    return dict(zip(names, contents, strict=True))


def live_page(model: EditorModel, name: str) -> bytes:
    """A page with a solver of its own, at the edited pose; with several poses, with their motion.

    Raises an EditError if a pose cannot be solved, and an InputError for an energy of one's own.
    """
    state = model.deformation.solved_state()
    current = state.current
    shown, pose = state.map, state.pose
    turns = [certificate_of(one.map) for one in state.poses]
    if len(turns) > 1 and not any(unlike_turns(turns[0], one) for one in turns[1:]):
        shown, pose = motion_of(state), [one.pose for one in state.poses]
    layers = model.layers
    page = to.live_page_html(
        layers.image,
        shown,
        pose,
        current.energy,
        current.options.p2p_weight,
        title=re.sub(r"(\.live)?\.html$", "", name, flags=re.IGNORECASE),
        background=layers.background,
    )
    return page.encode()


def write(
    model: EditorModel, owner: Path, files: Mapping[str, bytes], *, replace: bool
) -> list[Path]:
    """Write files of ``owner`` beside it. Without ``replace``, raises an `OccupiedError` if they
    would replace other files."""
    contents = {owner.parent / name: data for name, data in files.items()}
    new = {p: data for p, data in contents.items() if not (p.is_file() and p.read_bytes() == data)}
    if not replace:
        check_free(model, list(new), owner)
    for path, data in new.items():
        write_atomically(path, data)
    model.own_files.note(contents, owner)
    return list(contents)


def _motion_files(
    model: EditorModel,
    motion: Motion,
    name: str,
    part: tuple[float, float] | None = None,
    **how: Any,
) -> dict[str, bytes]:
    """The files of a motion, or of its part between two times, which then plays over and over."""
    layers, background = model.layers, model.layers.background
    if background is None and name.lower().endswith((".gif", ".mp4")):
        background = WHITE  # they have no transparency
    poses: list[Any] = [pose.pose for pose in model.document.poses]
    if part is not None:
        motion = motion.part(*part)
        poses = [order_at(model.deformation.state, time) for time in motion.times]
    how |= {"loop": part is not None or motion.repeat != "once", "background": background}
    return to.motion_files(name, layers.image, motion, poses, **how)


def last_export() -> dict[str, Any]:
    """The choices that `remember_export` wrote last; empty if they cannot be read."""
    try:
        data = read_file(_last_export(), most=_MOST_CHOICES)
        known = parse_json(data, "last-export.json", nan=False)
    except (OSError, InputError):  # none yet, or damaged
        return {}
    return known if isinstance(known, dict) else {}


def remember_export(choices: Mapping[str, Any]) -> None:
    """Save the choices of an export in the user's data folder. Raises an OSError if that fails."""
    path = _last_export()
    path.parent.mkdir(parents=True, exist_ok=True)
    write_atomically(path, json_text(choices))


def _last_export() -> Path:
    return data_directory() / "last-export.json"


class LookChoice(ipywidgets.Dropdown):
    """Chooses whether the shape is cut out, and what lies behind it."""

    def __init__(self, model: EditorModel, **kwargs: Any) -> None:
        self._model = model
        super().__init__(tooltip="What the canvas and exports show behind the shape", **kwargs)
        self.follow()
        self.observe(lambda change: model.set_look(change["new"]), ["value"])

    def follow(self) -> None:
        """Show the model's look, which the list may not have."""
        look, opaque = self._model.look, self._model.layers.opaque
        known = dict(_LOOKS if opaque else _LOOKS_OF_CUT_OUTS)
        if look not in known.values():
            known["Another"] = look
        if list(self.options) != list(known.items()):
            self.options = list(known.items())
        self.value = look


class MotionExport(ClosingWidget, ipywidgets.HBox):
    """Size, frame rate and progress of a motion's export. ``say(text, style)`` shows a message."""

    def __init__(
        self, model: EditorModel, animation: Animation, say: Callable[[str, str], None]
    ) -> None:
        self._model, self._animation, self._say = model, animation, say
        tip = "Pixels of the longer side"
        self.size = ipywidgets.BoundedIntText(480, min=16, max=4096, tooltip=tip, layout=_NUMBER)
        tip = "Frames per second"
        self.rate = ipywidgets.BoundedFloatText(25, min=1, max=100, tooltip=tip, layout=_NUMBER)
        tip = "Only the part between the two marks on the timeline's ruler"
        self.part = toggle("Loop range", "repeat", tip, {"width": "auto"})
        self.progress = ipywidgets.IntProgress(layout={"width": "auto", "flex": "1 1 40px"})
        """The number of drawn frames; hidden without an export."""
        self.worker: LatestWins[_Task] = LatestWins(weakly(self._draw), self, "export")
        self.cancel = button("Cancel", "stop", "Stop drawing", self.worker.cancel)
        self._running = (self.progress, self.cancel)
        self._show(False)
        names = "Size", "px", "fps"
        name, px, fps = (ipywidgets.Label(text, layout={"flex": "0 0 auto"}) for text in names)
        layout = {"flex": "1 1 auto", "min_width": "0", "flex_flow": "row wrap"}
        shown = [name, self.size, px, self.rate, fps, self.part, *self._running]
        super().__init__(shown, layout=layout)
        self._endings = (animation.deformation.observe(weakly(self._on_model)), self.worker.close)
        self._on_model("state")

    def _on_model(self, what: str) -> None:
        if what == "state":
            part = self._animation.deformation.state.timeline.played_range
            self.part.layout.display = "none" if part is None else None

    def start(self, name: str, deliver: Callable[[dict[str, bytes]], str]) -> str:
        """Draw a file in the background, then deliver it. Returns a message at once."""
        self._show(True)
        self.worker.submit((name, deliver))
        return f"Drawing {name}…"

    def _draw(self, task: _Task, worker: LatestWins[_Task]) -> None:
        def report(done: int, total: int) -> bool:
            self.progress.max, self.progress.value = total, done
            return worker.overtaken

        try:
            while not self._animation.deformation.finish(timeout=0.2):
                if worker.overtaken:
                    return self._say("Stopped; nothing was written.", "")
            motion = self._animation.motion
            count = len(motion.times) - 1
            if any(report(i, count) or not motion.interval(i) for i in range(count)):
                return self._say("Stopped; nothing was written.", "")
            name, deliver = task
            how: Any = {"size": self.size.value, "frames_per_second": self.rate.value}
            if self.part.value:
                how["part"] = self._animation.deformation.state.timeline.played_range
            files = _motion_files(self._model, motion, name, progress=report, **how)
            stopped = worker.cancelled or not files
            self._say("Stopped; nothing was written." if stopped else deliver(files), "")
        except (OSError, ValueError) as error:  # messages for the user; other errors are bugs
            self._say(str(error), REFUSED)
        finally:
            self._show(False)

    def _show(self, running: bool) -> None:
        for part in self._running:
            part.layout.display = None if running else "none"
        self.progress.value = 0
