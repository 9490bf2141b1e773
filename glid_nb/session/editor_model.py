"""The whole editor without a widget: a picture, its cage, its poses, and their file."""

from __future__ import annotations

import threading
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

from glid_nb.imaging.read import ImageSource
from glid_nb.session.autosave import Autosave
from glid_nb.session.deformation import Deformation
from glid_nb.session.document import Document, load_document, save_document
from glid_nb.session.edit_state import EditError, EditState
from glid_nb.session.own_files import OwnFiles
from glid_nb.session.tracing import TracingModel


class EditorModel:
    """A tracing and the deformation of what was traced.

    Parameters
    ----------
    image
        A picture, as in `glid_nb.read_image`; None to begin without one.
    document : Document, optional
        Go on from there instead.
    path : path, optional
        A file that is saved to every few seconds while something changes.

    Raises
    ------
    TraceError
        The picture cannot be read.
    """

    def __init__(
        self,
        image: ImageSource | None = None,
        *,
        document: Document | None = None,
        path: str | Path | None = None,
    ) -> None:
        self._lock = threading.RLock()
        self._observers: list[Callable[[], None]] = []
        self._save_observers: list[Callable[[], None]] = []
        self._autosave: Autosave | None = None
        self.save_error: Exception | None = None
        """Why the last save in the background failed; None when it did not."""
        self.own_files = OwnFiles()
        """The files that were saved, opened and exported."""
        if document is None:
            self.tracing = TracingModel(image)
            """The picture and its cage."""
            self._deformation: Deformation | None = None
            self._applied: Any = (None, None)
            self.apply_tracing()
        else:
            self._take(document)
        if path is not None:
            self._autosave = Autosave(path, on_done=self._saved)
            self.own_files.note_session(path)

    @property
    def autosave_path(self) -> Path | None:
        """The session file that is kept up to date; None when there is none."""
        return None if self._autosave is None else self._autosave.path

    @property
    def deformation(self) -> Deformation:
        """The shape being deformed.

        Its solver begins with the first change, or when a view says that it has been drawn
        (`Deformation.begin`): compiling beside the page would only make that appear later.

        Raises
        ------
        EditError
            Nothing has been traced yet.
        """
        if self._deformation is None:
            raise EditError("there is no cage yet; open a picture and trace a shape first")
        return self._deformation

    @property
    def has_shape(self) -> bool:
        """Whether there is something to deform."""
        return self._deformation is not None

    def on_replaced(self, callback: Callable[[], None]) -> None:
        """Call ``callback`` when ``deformation`` or ``tracing`` is another object."""
        self._observers.append(callback)

    def on_saved(self, callback: Callable[[], None]) -> None:
        """Call ``callback`` after each save in the background; ``save_error`` says how it went."""
        self._save_observers.append(callback)

    def apply_tracing(self) -> None:
        """Deform what is traced now: a step for undo, or a new start for a new picture."""
        with self._lock:
            domain, image = self.tracing.domain, self.tracing.image
            if domain is None or (domain, id(image)) == self._applied:
                return
            same_picture = self._applied[1] == id(image)
            self._applied = (domain, id(image))
            if same_picture and self._deformation is not None:
                self._deformation.set_domain(domain)
                return
            self._replace(Deformation(domain, begin=False))
        self._tell()

    @property
    def document(self) -> Document:
        """Everything as one value."""
        with self._lock:
            state, image = self.deformation.state, self.tracing.image
            assert image is not None  # a shape comes from a picture
            return Document(
                image,
                state.domain.cage,
                state.domain,
                self.tracing.options,
                self.tracing.scribbles,
                tuple(pose.named() for pose in state.poses),
                state.active,
            )

    def save(self, path: str | Path) -> None:
        """Write everything to a file, atomically.

        Raises
        ------
        DocumentError, OSError
            It cannot be written; what was there before stays.
        """
        save_document(self.document, path)
        self.own_files.note_session(path)

    def load(self, path: str | Path) -> None:
        """Go on with what a file holds.

        Raises
        ------
        DocumentError, OSError
            It cannot be read; nothing has changed then.
        """
        document = load_document(path)
        self.own_files.note_session(path)
        with self._lock:
            self._take(document)
        self._tell()

    def autosave(self) -> None:
        """Save soon, if there is a path to save to and something to save."""
        if self._autosave is not None and self.has_shape:
            self._autosave.submit(self.document)

    def close(self) -> None:
        """Save what is pending and end all threads.

        Warns
        -----
        RuntimeWarning
            The last state could not be saved.
        """
        with self._lock:
            self._observers.clear()
            self._save_observers.clear()
            autosave, self._autosave = self._autosave, None
        if autosave is not None:
            autosave.close()
            if autosave.error is not None:
                text = f"the session was not saved: {autosave.error}"
                warnings.warn(text, RuntimeWarning, stacklevel=2)
        if self._deformation is not None:
            self._deformation.close()

    def _take(self, document: Document) -> None:
        self.tracing = TracingModel.from_document(document)
        state = EditState.from_poses(document.domain, document.poses, document.active)
        self._applied = (self.tracing.domain, id(self.tracing.image))
        self._replace(Deformation.from_state(state, begin=False))

    def _replace(self, deformation: Deformation) -> None:
        old, self._deformation = getattr(self, "_deformation", None), deformation
        if old is not None:
            old.close()
        deformation.observe(self._on_change)

    def _on_change(self, what: str) -> None:
        model = self._deformation
        if self._autosave is None or model is None or model.dragged:
            return
        if what == "state" or (what == "frame" and model.solved):
            self.autosave()

    def _saved(self, error: Exception | None) -> None:
        """After a save in the background, in its thread."""
        self.save_error = error
        for callback in tuple(self._save_observers):
            callback()

    def _tell(self) -> None:
        for callback in tuple(self._observers):
            callback()
