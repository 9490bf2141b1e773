"""The model of the whole editor: a picture, its cage, its poses, and their file."""

import functools
import warnings
import weakref
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from glid_nb import samples
from glid_nb._arrays import Array
from glid_nb._files import portable_name
from glid_nb.geometry import Domain
from glid_nb.imaging import TraceError
from glid_nb.imaging.backdrop import Backdrop
from glid_nb.imaging.read import ImageSource
from glid_nb.session import autosave
from glid_nb.session.autosave import OwnFiles
from glid_nb.session.deformation import Deformation
from glid_nb.session.document import Document, DocumentError, DocumentPart
from glid_nb.session.document_file import load_document, save_document
from glid_nb.session.edit_state import EditError, EditState, Part
from glid_nb.session.look import Layers, Look, background_behind
from glid_nb.session.model import History, Observed
from glid_nb.session.parts import FIRST_KEY, NewPart, add_parts
from glid_nb.session.timeline import Timeline
from glid_nb.session.tracing import TracingModel, TracingState
from glid_nb.session.worker import weakly

_LOST = "{} outside the new outline and removed with the old outline; Undo restores everything."
_REPLACED = (
    "A new picture starts a new session. The session before{place} comes back with {step} in the "
    "Trace tab."
)
_NOT_KEPT = (
    "The editor's data folder cannot be used: {}. Work that is in no session file and export "
    "settings are not kept for the next editor. Save the session, or name another folder in the "
    "environment variable GLID_NB_DATA."
)
_NOT_VALID = "The outline in the Trace tab is not valid yet: this is the last valid one."


class KeptWorkError(OSError):
    """Something cannot be saved in the user's data folder. The editor continues without it."""

    def __init__(self, error: Exception) -> None:
        super().__init__(_NOT_KEPT.format(str(error).removesuffix(".")))


@dataclass(frozen=True, eq=False)
class _Session:
    """A picture being deformed, and its tracing as last applied."""

    tracing: TracingState
    domain: Domain | None
    deformation: Deformation
    path: Path | None = None  # its file, if undo or redo of the tracing may bring the session back
    part: int = FIRST_KEY  # the key of the edited part, which the tracing shows
    traces: dict[int, History[TracingState]] = field(default_factory=dict)  # of the other parts

    @property
    def image(self) -> Array:
        assert self.tracing.image is not None
        return self.tracing.image


@dataclass(frozen=True, eq=False)
class Shape:
    """One shape of a session as it is drawn and exported."""

    key: int
    name: str  # empty in a session with one shape
    state: EditState  # without other parts
    layers: Layers
    visible: bool = True


def open_document(path: str | Path) -> Document:
    """Like `load_document`, but first saves the pending changes of all editors to the file."""
    autosave.flush(path)
    return load_document(path)


def find_document(path: str | Path) -> Document | None:
    """Like `open_document`, but None if the file does not exist.

    Raises a DocumentError if the path is a folder or its folder does not exist.
    """
    _check_place(Path(path))
    autosave.flush(path)
    return load_document(path) if Path(path).exists() else None


class EditorModel(Observed):
    """A tracing and the deformation of the traced shape.

    ``observe`` reports ``"replaced"`` when ``deformation`` or ``tracing`` is another object,
    ``"look"`` when the picture is drawn in another way, and ``"saved"`` after each save in the
    background. ``save_error`` is the exception of a failed save.

    The model begins with a picture, with a document, or without either. Changes are saved to the
    file ``path``. If another program has changed this file, they go to a new file beside it.
    ``parts`` are pictures by the names of the parts, the rearmost first, instead of one picture.
    Without a path, work is saved in the user's data folder (`session.autosave.kept_files`), and the
    next model of the same picture offers it.
    """

    def __init__(
        self,
        image: ImageSource | None = None,
        *,
        document: Document | None = None,
        path: str | Path | None = None,
        look: Look | None = None,
        parts: Mapping[str, ImageSource] | None = None,
    ) -> None:
        if path is not None:
            _check_place(Path(path))
        super().__init__()
        self.saving: autosave.Autosave | None = None  # what saves in the background, if anything
        self.save_error: Exception | None = None
        """Why the last save in the background failed; None if it succeeded.

        It is a `KeptWorkError` for a save to the user's data folder.
        """
        self.own_files = OwnFiles()  # the files that were saved, opened and exported
        self._session: _Session | None = None
        # Sessions of other pictures. Undo of the tracing may bring them back.
        self._shelf: list[_Session] = []
        # The tracing that made each domain. Undo of the deformation restores it.
        self._sources = weakref.WeakKeyDictionary[Domain, TracingState]()
        # The autosave's file as the user named it. Files for other pictures get similar names.
        self._named_path: Path | None = None
        self.kept: Path | None = None
        """The file with the work of an earlier editor of this picture without a session file."""
        self._saved_work: tuple[Any, ...] = ()
        self._look = look or Look()
        self._layers: dict[Domain, Layers] = {}  # of the present shapes
        self._behind: tuple[tuple[Layers, ...], Backdrop] | None = None  # what lies behind them
        with self.locked():
            if document is None:
                self.tracing = TracingModel(image)
                """The open picture and its cage."""
                if parts:
                    self._open_parts(parts)
                elif not self.tracing.doubt:
                    self.apply_tracing()
            else:
                self._take(document)
            if path is not None:
                self._save_to(Path(path))
            elif document is None and self.tracing.image is not None:
                self.kept = next(iter(autosave.kept_files(self.tracing.image)), None)

    @property
    def autosave_path(self) -> Path | None:
        """The session file of the autosave, if any."""
        saving = self.saving if self._named_path is not None else None
        return None if saving is None else saving.path

    @property
    def left_path(self) -> Path | None:
        """The file that the autosave gave up because another program changed it, if any."""
        return None if self.saving is None else self.saving.left

    def take_over_file(self) -> None:
        """Continue saving to the session file, although a closed editor wrote it last."""
        if self.autosave_path is not None:
            self.own_files.note_session(self.autosave_path)

    @property
    def deformation(self) -> Deformation:
        """The deformation of the traced shape, also if its outline is only a guess.

        Raises an EditError if there is no cage. The solver begins with the first change, or when a
        drawn view calls `begin`.
        """
        if self._session is None:
            self.apply_tracing()
        if self._session is None:
            raise EditError("there is no cage yet; open a picture and trace a shape first")
        return self._session.deformation

    @property
    def has_shape(self) -> bool:
        return self._session is not None

    @property
    def unsaved(self) -> bool:
        """Whether poses with handles, of any picture, are not saved in a session file."""
        if self._session is None or self._named_path is not None:
            return False
        states = [one.deformation.state for one in (self._session, *self._shelf)]
        posed = (state for state in states if state.parts or _has_handles(state))
        return any(_work_of(state) != self._saved_work for state in posed)

    @property
    def image(self) -> Array | None:
        """The deformed picture. The tracing may have another one that is not applied yet."""
        return None if self._session is None else self._session.image

    @property
    def _first_image(self) -> Array:
        """The picture that names kept work, whichever part is edited."""
        document, parts = self.document, self.deformation.state.parts
        return next((part.image for part in parts if part.key == FIRST_KEY), document.image)

    @property
    def look(self) -> Look:
        """What is drawn of the picture, and what lies behind it."""
        return self._look

    def set_look(self, look: Look) -> None:
        """Draw the picture in another way. ``observe`` reports ``"look"``."""
        with self.locked():
            if look == self._look:
                return
            self._look = look
            if self._session is not None:
                self.autosave()
        self.tell("look")

    @property
    def layers(self) -> Layers:
        """What is drawn of the picture on the present cage, and what lies behind it."""
        with self.locked():
            state = self.deformation.state
            return self._layers_of(state, state.domain, state.edited_part)

    @property
    def shapes(self) -> tuple[Shape, ...]:
        """All shapes, the rearmost first: the parts of the session, or the only one."""
        with self.locked():
            state = self.deformation.state
            if not state.parts:
                return (Shape(FIRST_KEY, "", state, self.layers),)
            return tuple(
                Shape(
                    part.key,
                    part.name,
                    shape,
                    self._layers_of(state, part.domain, part),
                    part.visible,
                )
                for part, shape in zip(state.parts, state.shapes, strict=True)
            )

    @property
    def background(self) -> Backdrop:
        """What lies behind all shapes."""
        if len(shapes := self.shapes) == 1:
            return shapes[0].layers.background
        layers = tuple(shape.layers for shape in shapes)
        known = self._behind
        if known is None or known[0] != layers:  # the layers are compared by identity
            known = self._behind = layers, background_behind(layers)
        return known[1]

    def _layers_of(self, state: EditState, domain: Domain, part: Part | None) -> Layers:
        session, look = self._session, self._look
        assert session is not None
        known = self._layers.get(domain)
        if known is None or known.cage is not domain.cage:
            source = self._source_of(session, domain, part)
            tracing = None if source is None else self.tracing.outcome_of(source).tracing
            image = session.image if part is None else part.image
            known = Layers(image, tracing, domain.cage, look)
        elif known.look != look:
            known = known.seen_as(look)
        present = {shape.domain for shape in state.shapes}
        self._layers = {d: layers for d, layers in self._layers.items() if d in present}
        self._layers[domain] = known
        return known

    def _source_of(
        self, session: _Session, domain: Domain, part: Part | None
    ) -> TracingState | None:
        """The tracing of a domain, which may be that of a part that is not edited."""
        if (source := self._sources.get(domain)) is not None:
            return source
        if part is None or part.key == session.part:
            return session.tracing
        history = session.traces.get(part.key)
        return None if history is None else history.present

    @property
    def name(self) -> str:
        """The stem for names of files: that of the picture's file or sample, else "glid"."""
        if self._session is None:
            return "glid"
        known = portable_name(self._session.tracing.name)
        return known or samples.name_of(self._session.image) or "glid"

    def apply_tracing(self) -> str:
        """Deform the present tracing. This is a step for undo; another picture starts a new
        session.

        A new session is saved to a new file. A picture that undo brings back also gets its file
        back. Returns a text about effects that the user may not expect; empty if there are none.
        """
        with self.locked():
            self.tracing.accept_guess()
            domain, session, words = self.tracing.domain, self._session, ""
            if domain is None or (session and session.domain is domain):
                pass
            elif session is None:
                self._change_picture(domain)
            elif session.image is self.tracing.image:
                self._session = self._session_of(session.deformation)
                words = _apply(session.deformation, domain)
            else:
                self._shelf.append(replace(session, path=self.autosave_path))
                place = "" if self.autosave_path is None else f" (in {self.autosave_path.name})"
                future = self.tracing.history.future
                step = "Redo" if any(one.image is session.image for one in future) else "Undo"
                words = _REPLACED.format(place=place, step=step)
                self._change_picture(domain)
            return _NOT_VALID if self.tracing.problems else words

    def keep_pieces(self, pieces: Iterable[TracingState]) -> int:
        """Apply the tracing, and add the pieces that other states trace as parts in front.

        Pieces that are parts already are left out. It is one step for undo if the tracing was
        applied before. Returns how many parts were added. Raises an EditError if there are none.
        """
        with self.locked():
            self.apply_tracing()
            new, image = [], self._session.image if self._session is not None else None
            parts = self.deformation.state.parts
            count = len(parts) or 1
            for source in pieces:
                domain = self.tracing.outcome_of(source).domain
                if domain is None or any(p.domain.cage.equals(domain.cage) for p in parts):
                    continue
                if source.image is not None:
                    self._sources[domain] = replace(source, fallback=domain)
                    new.append(NewPart(f"Part {count + len(new) + 1}", source.image, domain))
            if not new:
                raise EditError("there is no other piece to keep; cut the shape apart first")
            self.deformation.add_parts(new, "Part 1", image)
            return len(new)

    def add_picture(self, name: str, image: ImageSource) -> None:
        """Add the shape of another picture of the same size as a part in front.

        Raises a TraceError for a picture that cannot be read, an EditError for another size.
        """
        with self.locked():
            deformation, session = self.deformation, self._session
            assert session is not None
            new = self._traced_part(name, TracingModel(image))
            deformation.add_parts([new], name=self.name, image=session.image)

    def _traced_part(self, name: str, model: TracingModel) -> NewPart:
        """The traced shape of a picture. If that would be a guess, as of a background, it is the
        whole picture."""
        if model.domain is None or model.doubt:
            model.draw()
        domain, image = model.domain, model.image
        if domain is None or image is None:
            raise TraceError(f"the part {name!r} has no shape")
        self._sources[domain] = replace(model.state, fallback=domain)
        return NewPart(name, image, domain)

    def _open_parts(self, images: Mapping[str, ImageSource]) -> None:
        """Begin with a part for each picture. The rearmost is edited."""
        traced = {name: TracingModel(image) for name, image in images.items()}
        every = [self._traced_part(name, model) for name, model in traced.items()]
        first, self.tracing = next(iter(traced.items()))
        self.apply_tracing()
        new = every[1:]
        deformation, image = self.deformation, self.tracing.image
        deformation.history = History(add_parts(deformation.state, new, first, image))

    @property
    def document(self) -> Document:
        """Picture, cage and poses as one value."""
        deformation, session = self.deformation, self._session
        assert session is not None
        if self.tracing.image is session.image:
            session = self._session_of(deformation)
        traced, state = session.tracing, deformation.state
        return Document(
            image=session.image,
            cage=state.domain.cage,
            domain=state.domain,
            trace_options=traced.options,
            scribbles=traced.scribbles or traced.options.scribbles,
            poses=state.poses,
            active=state.active,
            timeline=state.timeline,
            look=self._look,
            pins=state.pins,
            **self._parts_of(session, state),
        )

    def _parts_of(self, session: _Session, state: EditState) -> dict[str, Any]:
        """The document's parts; a session with one part is saved as its only shape."""
        if len(state.parts) < 2:
            return {}
        parts = []
        for part in state.parts:
            traced = self._source_of(session, part.domain, part) or TracingState(part.image)
            strokes = traced.scribbles or traced.options.scribbles
            shape = part.name, part.image, part.domain, traced.options, strokes
            parts.append(DocumentPart(*shape, part.poses, part.visible))
        return {"parts": tuple(parts), "part": state.part}

    def save(self, path: str | Path) -> None:
        """Write the document to a file. If that fails, the old file stays.

        Unsolved poses are solved first. If that is not possible, for example because the solver is
        paused, the file marks them, and they are solved after it is opened.
        """
        if self.has_shape:
            self.deformation.finish()
        saving, path = self.saving, Path(path)
        if saving is not None and saving.path.resolve() == path.resolve():
            saving.write(self.document)
            self._saved(None)
        else:
            save_document(self.document, path)
        self._saved_work = _work_of(self.deformation.state)
        self.own_files.note_session(path)
        with self.locked():
            if (kept := self._end_keeping()) is not None:
                self._remove_kept(kept)  # the work is in a session file now

    def load(self, path: str | Path) -> None:
        """Continue with the document in a file. An autosave then saves to this file."""
        document = open_document(path)
        with self.locked():
            if self._named_path is not None:
                self._save_to(Path(path))
                self._named_path = Path(path)
            self.own_files.note_session(path)
            self._take(document)
            self._saved_work = _work_of(self.deformation.state)

    def autosave(self) -> None:
        """Save soon, if there is something to save. Without a session file, work on handles is
        saved in the user's data folder."""
        with self.locked():
            if self.saving is None and self.unsaved:
                try:
                    self._keep_in(autosave.new_kept_file(self._first_image))
                except OSError as error:
                    self.not_kept(error)
            if self.saving is not None and self.has_shape:
                self.saving.submit(self.document)

    def recover(self) -> None:
        if self.kept is not None:
            document = open_document(self.kept)
            with self.locked():
                self._take(document, self.tracing.state.name)
                self._keep_in(self.kept)
                self.kept = None

    def discard_kept(self) -> None:
        """Delete the kept work, and no longer offer it."""
        kept, self.kept = self.kept, None
        if kept is not None:
            self._remove_kept(kept)

    def close(self) -> None:
        """Save pending changes, with a warning if that fails, and end all threads."""
        with self.locked():
            self._observers.clear()
            saving, self.saving = self.saving, None
        if saving is not None:
            saving.close()
        if self._session is not None:
            self._session.deformation.close()
        # Warn at the end, because a warning may be raised as an exception.
        if saving is not None and self.save_error is not None:
            kept = isinstance(self.save_error, KeptWorkError)
            text = f"{'' if kept else 'the session was not saved: '}{self.save_error}"
            warnings.warn(text, RuntimeWarning, stacklevel=2)

    def not_kept(self, error: OSError) -> None:
        """Report by ``save_error`` that the user's data folder failed, and continue without it."""
        self._saved(KeptWorkError(error))

    def _remove_kept(self, path: Path) -> None:
        try:
            path.unlink(missing_ok=True)
        except OSError as error:
            self.not_kept(error)

    def _keep_in(self, path: Path, own: OwnFiles | None = None) -> None:
        """Save to a file from now on. A kept file is replaced by another one if saving fails."""
        image, done = self._first_image if own is None else None, weakly(self._saved)
        elsewhere = None if image is None else functools.partial(autosave.new_kept_file, image)
        known: Any = {"on_done": done, "own": own, "owner": self, "elsewhere": elsewhere}
        self.saving = autosave.Autosave(path, **known)

    def _end_keeping(self) -> Path | None:
        if self._named_path is not None or self.saving is None:
            return None
        self.saving.close()
        path, self.saving = self.saving.path, None
        return path

    def _session_of(self, deformation: Deformation) -> _Session:
        domain, state, before = self.tracing.domain, self.tracing.state, self._session
        if domain is not None:
            self._sources[domain] = state
        if before is not None and before.deformation is deformation:
            return replace(before, tracing=state, domain=domain)
        edited = deformation.state
        return _Session(state, domain, deformation, part=edited.keys[edited.part])

    def _change_picture(self, domain: Domain) -> None:
        session = next((s for s in self._shelf if s.image is self.tracing.image), None)
        if session is None:
            if self._named_path is not None and self._session is not None:
                if self.saving is not None:
                    self.saving.flush()  # then this file exists and the next gets another name
                self._save_to(autosave.free_sibling(self._named_path))
            self._replace(Deformation(domain, begin=False))
            return
        self._shelf.remove(session)
        if session.path is not None:
            self._save_to(session.path)
        deformation = Deformation.from_history(session.deformation.history)
        self._replace(deformation)
        if self._session is not None:
            self._session = replace(self._session, traces=session.traces)
        if session.domain is not domain:
            _apply(deformation, domain)

    def _save_to(self, path: Path) -> None:
        """Autosave to this file from now on. Pending changes are first saved to the old file."""
        old = self.saving
        if old is not None:
            if old.path.resolve() == path.resolve():
                self.own_files.note_session(path)
                return
            old.close()
        self._named_path = self._named_path or path
        self._keep_in(path, self.own_files)

    def _take(self, document: Document, name: str = "") -> None:
        self.tracing = TracingModel.from_document(document, name)
        self._look = document.look
        domain = document.domain
        state = EditState.initial(domain)
        if poses := document.poses:
            timeline = document.timeline or Timeline.even(len(poses))
            state = EditState(domain, poses, document.active, timeline, pins=document.pins)
        if document.parts:
            state = replace(state, parts=self._read_parts(document, name), part=document.part)
        self._shelf.clear()
        self._replace(Deformation.from_history(History(state)))

    def _read_parts(self, document: Document, name: str) -> tuple[Part, ...]:
        parts = []
        for key, part in enumerate(document.parts):
            if key != document.part:
                traced = TracingModel.from_document(part, name).state
                self._sources[part.domain] = replace(traced, fallback=part.domain)
            shape = part.image, part.domain, part.poses, part.visible
            parts.append(Part(key, part.name, *shape))
        return tuple(parts)

    def _replace(self, deformation: Deformation) -> None:
        self._end_keeping()
        old, self._session = self._session, self._session_of(deformation)
        if old is not None:
            old.deformation.close()  # does not wait for its thread, which may want this lock
        self.tell("replaced")
        deformation.observe(functools.partial(self._on_change, deformation))

    def _on_change(self, deformation: Deformation, what: str) -> None:
        with self.locked():
            session = self._session
            if session is None or session.deformation is not deformation:
                return
            if what == "state":
                state = deformation.state
                if state.keys[state.part] != session.part:
                    session = self._follow_part(session, state)
                if session.domain is not state.domain:
                    self._follow(session, state.domain)
        if deformation.dragged:
            return
        if what == "state" or (what == "frame" and deformation.moment.solved):
            self.autosave()

    def _follow_part(self, session: _Session, state: EditState) -> _Session:
        """Show the tracing of the part that is edited now."""
        tracing, part = self.tracing, state.edited_part
        if tracing.image is session.image:
            session.traces[session.part] = tracing.history
        key = state.keys[state.part]
        history = session.traces.get(key)
        if history is None:
            source = self._sources.get(state.domain)
            if source is None:
                image = session.image if part is None else part.image
                loops = state.domain.cage.loops
                source = TracingState(image, loops=loops, fallback=state.domain)
            history = History(source)
        tracing.show(history.ended())
        new = replace(session, tracing=tracing.state, domain=tracing.domain, part=key)
        self._session = new
        return new

    def _follow(self, session: _Session, domain: Domain) -> None:
        tracing = self.tracing
        if tracing.image is not session.image or tracing.domain is None:
            return
        if not tracing.domain.cage.equals(domain.cage):
            if (source := self._sources.get(domain)) is not None:
                tracing.return_to(source)
            else:
                tracing.set_loops(domain.cage.loops)
        self._session = self._session_of(session.deformation)

    def _saved(self, error: Exception | None) -> None:
        keeps = self._named_path is None  # then documents that no file can hold are no error
        if keeps and isinstance(error, DocumentError):
            error = None
        elif keeps and isinstance(error, OSError) and not isinstance(error, KeptWorkError):
            error = KeptWorkError(error)
        self.save_error = error
        self._announce("saved")  # not tell(): a thread that waits for the save may hold the lock


def _apply(deformation: Deformation, domain: Domain) -> str:
    before = sum(len(pose.pose) for pose in deformation.state.poses)
    deformation.set_domain(domain)
    lost = before - sum(len(pose.pose) for pose in deformation.state.poses)
    many = f"{lost} pins were" if lost > 1 else "A pin was"
    return _LOST.format(many) if lost > 0 else ""


def _work_of(state: EditState) -> tuple[Any, ...]:
    every = (pose for shape in state.shapes for pose in shape.poses)
    poses = ((p.name, p.pose, p.energy, p.options, p.method) for p in every)
    parts = ((part.key, part.name, part.visible) for part in state.parts)
    return (state.timeline, state.pins, *parts, *poses)


def _has_handles(state: EditState) -> bool:
    return any(len(pose.pose) for shape in state.shapes for pose in shape.poses)


def _check_place(path: Path) -> None:
    if path.is_dir():
        raise DocumentError(f"{path.absolute()} is a folder; name a file")
    if not path.parent.is_dir():
        missing = f"{path}: the folder {path.parent.absolute()} does not exist"
        raise DocumentError(f"{missing}; make it first, or name a file elsewhere")
