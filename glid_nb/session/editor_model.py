"""The model of the whole editor: a picture, its cage, its poses, and their file."""

import functools
import warnings
import weakref
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from glid_nb import samples
from glid_nb._arrays import Array
from glid_nb._files import portable_name
from glid_nb.geometry import Domain
from glid_nb.imaging.read import ImageSource
from glid_nb.session import autosave
from glid_nb.session.autosave import OwnFiles
from glid_nb.session.deformation import Deformation
from glid_nb.session.document import Document, DocumentError
from glid_nb.session.document_file import load_document, save_document
from glid_nb.session.edit_state import EditError, EditState
from glid_nb.session.look import Layers, Look
from glid_nb.session.model import History, Observed
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

    @property
    def image(self) -> Array:
        assert self.tracing.image is not None
        return self.tracing.image


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
        self._layers: Layers | None = None
        with self.locked():
            if document is None:
                self.tracing = TracingModel(image)
                """The open picture and its cage."""
                if not self.tracing.doubt:
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
        states = (one.deformation.state for one in (self._session, *self._shelf))
        posed = (state for state in states if any(len(pose.pose) for pose in state.poses))
        return any(_work_of(state) != self._saved_work for state in posed)

    @property
    def image(self) -> Array | None:
        """The deformed picture. The tracing may have another one that is not applied yet."""
        return None if self._session is None else self._session.image

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
            domain, session = self.deformation.state.domain, self._session
            assert session is not None
            known, look = self._layers, self._look
            if known is None or known.cage is not domain.cage:
                state = self._sources.get(domain, session.tracing)
                tracing = self.tracing.outcome_of(state).tracing
                known = Layers(session.image, tracing, domain.cage, look)
            elif known.look != look:
                known = known.seen_as(look)
            self._layers = known
            return known

    @property
    def name(self) -> str:
        """The stem for names of files: that of the picture's file or sample, else "session"."""
        if self._session is None:
            return "session"
        known = portable_name(self._session.tracing.name)
        return known or samples.name_of(self._session.image) or "session"

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
        )

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
                    self._keep_in(autosave.new_kept_file(self.document.image))
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
        image, done = self.document.image if own is None else None, weakly(self._saved)
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
        domain, state = self.tracing.domain, self.tracing.state
        if domain is not None:
            self._sources[domain] = state
        return _Session(state, domain, deformation)

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
            state = EditState(domain, poses, document.active, timeline, document.pins)
        self._shelf.clear()
        self._replace(Deformation.from_history(History(state)))

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
            if what == "state" and session.domain is not deformation.state.domain:
                self._follow(session, deformation.state.domain)
        if deformation.dragged:
            return
        if what == "state" or (what == "frame" and deformation.moment.solved):
            self.autosave()

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
    poses = ((p.name, p.pose, p.energy, p.options, p.method) for p in state.poses)
    return (state.timeline, state.pins, *poses)


def _check_place(path: Path) -> None:
    if path.is_dir():
        raise DocumentError(f"{path.absolute()} is a folder; name a file")
    if not path.parent.is_dir():
        missing = f"{path}: the folder {path.parent.absolute()} does not exist"
        raise DocumentError(f"{missing}; make it first, or name a file elsewhere")
