"""Exports of an editor. The file's suffix selects the format. Motions export in the background."""

import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import ipywidgets

from glid_nb import export as to
from glid_nb._errors import InputError, plainly
from glid_nb._files import read_file, write_atomically
from glid_nb._json import json_text, parse_json
from glid_nb._runtime import data_directory
from glid_nb.certificate import certificate_of
from glid_nb.certificate.certify import proof_text
from glid_nb.export.formats import (
    FORMATS,
    MOTION_FORMATS,
    ExportError,
    file_names,
    names_for_parts,
    part_names,
    suffix_of,
)
from glid_nb.imaging.backdrop import WHITE, Backdrop
from glid_nb.imaging.read import png
from glid_nb.imaging.render import View
from glid_nb.session.animation import Animation
from glid_nb.session.document import Document
from glid_nb.session.document_file import document_bytes
from glid_nb.session.edit_state import EditError
from glid_nb.session.editor_model import EditorModel, Shape
from glid_nb.session.look import FILLED, WHOLE_CAGE, Look
from glid_nb.session.posed_shapes import PosedShape, live_parts
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


def written_names(model: EditorModel, path: Path, *, moving: bool) -> tuple[str, ...]:
    """The names of all files that an export of the model with this name writes."""
    formats = MOTION_FORMATS if moving else FORMATS
    return names_for_parts(path.name, [shape.name for shape in shown_shapes(model)], formats)


def shown_shapes(model: EditorModel) -> list[Shape]:
    """The visible shapes, the rearmost first. Raises an EditError if all parts are hidden."""
    shapes = [shape for shape in model.shapes if shape.visible]
    if not shapes:
        raise EditError("all parts are hidden, so there is nothing to export; show one first")
    return shapes


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
        model.deformation.solved_state()
        files = {path.name: live_page(shown_shapes(model), model.background, path.name)}
    elif path.name.lower().endswith(tuple(MOTION_FORMATS.keys() - FORMATS.keys())):
        moving = _moving_parts(model)
        how: dict[str, Any] = {"size": max(size)} if size else {}
        files = _motion_files(model, moving, path.name, **how)
    else:
        files = exported(model, path, size, view)
    if path.name not in files:  # several parts, with a file for each
        return tuple(write(model, path, files, replace=True))
    (name, data), *others = files.items()
    # If the named file exists, the additional files belong to it.
    beside = write(model, path, dict(others), replace=path.exists())
    return (*write(model, path, {name: data}, replace=True), *beside)


def exported(
    model: EditorModel, path: Path, size: tuple[int, int] | None, view: View
) -> dict[str, bytes]:
    """The contents of the exported files, by name. Arguments are as in `Editor.export`.

    A picture and a page show all visible parts; formats in `OF_ONE_SHAPE` have the files of each
    part. The edited pose is solved first; for sessions and scripts, all poses. Raises an EditError
    if a pose cannot be solved, so that a picture, a mesh or a proof would show another map.
    """
    deformation, suffix = model.deformation, suffix_of(path.name, FORMATS)
    if suffix in (".glid", ".py"):
        deformation.finish()
    else:
        deformation.solved_state(only_current=suffix != ".live.html")
    shapes = shown_shapes(model)
    if suffix == ".glid":
        return {path.name: document_bytes(model.document)}
    if suffix == ".png":
        still = [to.StillPart(s.layers.image, s.state.map, s.state.pose) for s in shapes]
        return {path.name: to.parts_png(still, size, view, model.background)}
    if suffix == ".live.html":
        return {path.name: live_page(shapes, model.background, path.name)}
    if suffix == ".html":
        return {path.name: still_page(shapes, model.background, path.stem)}
    if suffix in (".glb", ".obj") and len(shapes) > 1:
        meshes = {
            s.name: to.textured_mesh(s.layers.image, s.state.map, pose=s.state.pose) for s in shapes
        }
        if suffix == ".glb":
            return {path.name: to.parts_glb(meshes)}
        return to.parts_obj(meshes, path.name[: -len(suffix)])
    files: dict[str, bytes] = {}
    for own, shape in _own_paths(path, suffix, shapes):
        files |= _files_of(shape, _document_of(model, shape), own, suffix)
    return files


def _own_paths(path: Path, suffix: str, shapes: Sequence[Shape]) -> list[tuple[Path, Shape]]:
    """The file of each shape; that of the only one is the named file."""
    if len(shapes) == 1:
        return [(path, shapes[0])]
    names = part_names(path.name, suffix, [shape.name for shape in shapes])
    return [(path.with_name(own), shape) for own, shape in zip(names, shapes, strict=True)]


def _document_of(model: EditorModel, shape: Shape) -> Document:
    """The document with this shape only."""
    return model.document.of_part(model.deformation.state.keys.index(shape.key))


def _files_of(shape: Shape, document: Document, path: Path, suffix: str) -> dict[str, bytes]:
    """The files of one shape."""
    layers, map_, pose = shape.layers, shape.state.map, shape.state.pose
    names = [file.name for file in files_of(path)]
    match suffix:
        case ".obj":
            files = to.mesh_obj(to.textured_mesh(layers.image, map_, pose=pose), path.stem)
            contents = [files[path.stem + rest] for rest in (".obj", *FORMATS[".obj"].beside)]
        case ".glb":
            contents = [to.mesh_glb(to.textured_mesh(layers.image, map_, pose=pose))]
        case ".svg":
            height, width = document.image.shape[:2]
            contents = [to.cage_svg(map_, (width, height), source=True, pose=pose).encode()]
        case ".proof.json":
            depths = pose.to_dict() if pose.depths.any() else {}
            proof = proof_text(certificate_of(map_))
            contents = [proof.encode(), json_text({**map_.to_dict(), **depths}).encode()]
        case _:
            contents = [python_code(document, names[1]).encode(), png(document.image)]
    return dict(zip(names, contents, strict=True))


def still_page(shapes: Sequence[Shape], background: Backdrop, title: str) -> bytes:
    """A page that shows the edited pose of all shapes and says what is proved of each."""
    parts = [
        to.PagePart(s.layers.image, s.state.map, certificate_of(s.state.map), s.state.pose, s.name)
        for s in shapes
    ]
    return to.parts_page_html(parts, title, background=background).encode()


def live_page(shapes: Sequence[Shape], background: Backdrop, name: str) -> bytes:
    """A page with solvers of its own, at the edited pose; with several poses, with their motion.

    Raises an InputError for an energy of one's own.
    """
    title = re.sub(r"(\.live)?\.html$", "", name, flags=re.IGNORECASE)
    return to.parts_live_html(live_parts(list(map(_posed, shapes))), title, background).encode()


def _posed(shape: Shape) -> PosedShape:
    state = shape.state
    return PosedShape(shape.layers.image, state.poses, state.active, state.timeline, shape.name)


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


def _moving_parts(model: EditorModel) -> list["to.MovingPart"]:
    """The visible shapes with their motions, once all poses are solved.

    Raises a MotionError if a motion cannot be made, an EditError if a pose cannot be solved.
    """
    model.deformation.solved_state()
    return [_posed(shape).moving for shape in shown_shapes(model)]


def _motion_files(
    model: EditorModel,
    parts: Sequence["to.MovingPart"],
    name: str,
    within: tuple[float, float] | None = None,
    **how: Any,
) -> dict[str, bytes]:
    """The files of moving shapes, or of a range of their time, which then plays over and over."""
    background = model.background
    if background is None and name.lower().endswith((".gif", ".mp4")):
        background = WHITE  # they have no transparency
    how |= {"loop": within is not None or parts[0].motion.repeat != "once"}
    how["background"] = background
    if within is not None:
        parts = [part.between(*within) for part in parts]
    if len(parts) > 1:
        return to.parts_motion_files(name, parts, **how)
    return to.motion_files(name, parts[0].image, parts[0].motion, parts[0].poses, **how)


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
            parts = _moving_parts(self._model)
            steps = [(part.motion, i) for part in parts for i in range(len(part.motion.times) - 1)]
            counted = enumerate(steps)
            if any(report(n, len(steps)) or not motion.interval(i) for n, (motion, i) in counted):
                return self._say("Stopped; nothing was written.", "")
            name, deliver = task
            how: Any = {"size": self.size.value, "frames_per_second": self.rate.value}
            if self.part.value:
                how["within"] = self._animation.deformation.state.timeline.played_range
            files = _motion_files(self._model, parts, name, progress=report, **how)
            stopped = worker.cancelled or not files
            self._say("Stopped; nothing was written." if stopped else deliver(files), "")
        except (OSError, ValueError) as error:  # messages for the user; other errors are bugs
            self._say(plainly(error), REFUSED)
        finally:
            self._show(False)

    def _show(self, running: bool) -> None:
        for part in self._running:
            part.layout.display = None if running else "none"
        self.progress.value = 0
