"""Names of session files, and opening one before there is a picture."""

from __future__ import annotations

import html
from pathlib import Path
from typing import Any

import ipywidgets

from glid_nb._errors import InputError
from glid_nb.session.editor_model import EditorModel

_SUFFIX = ".glid"


class FileNameError(InputError):
    """A session file cannot have that name; the message says which it can have."""


def session_path(text: str) -> Path:
    """The session file that somebody named, with its suffix.

    Raises
    ------
    FileNameError
        For no name, or one with another suffix.
    """
    name = text.strip()
    path = Path(name).expanduser()
    if not path.name or name.endswith(("/", "\\")):
        raise FileNameError("Give the session file a name, such as session.glid")
    if not path.suffix:
        return path.with_suffix(_SUFFIX)
    if path.suffix.lower() != _SUFFIX:
        raise FileNameError(
            f"{path.name} cannot be a session file: its name must end in {_SUFFIX}, as in "
            f"{path.stem}{_SUFFIX}"
        )
    return path


def existing_path(text: str) -> Path:
    """The file that somebody wants to open: any that is there, else as in :func:`session_path`."""
    path = Path(text.strip()).expanduser()
    return path if path.is_file() else session_path(text)


class OpenPanel(ipywidgets.VBox):
    """Opens a session file by its name, before there is a picture."""

    def __init__(self, model: EditorModel, **kwargs: Any) -> None:
        self.model = model
        """The model that takes what is opened."""
        self.path = ipywidgets.Text(
            placeholder="session.glid", layout=ipywidgets.Layout(width="280px")
        )
        """The file, relative to the notebook."""
        self.button = ipywidgets.Button(
            description="Open session", icon="folder-open", tooltip="Go on with a session file"
        )
        self.message = ipywidgets.HTML()
        """Why it cannot be opened."""
        row = ipywidgets.HBox([self.path, self.button])
        super().__init__([row, self.message], **kwargs)
        self.layout.padding = "0 0 2em 2em"
        self.button.on_click(self._open)

    def _open(self, _: Any) -> None:
        try:
            self.model.load(existing_path(self.path.value))
        except (OSError, ValueError) as error:  # refusals for the user; anything else is a bug
            self.message.value = html.escape(str(error))
