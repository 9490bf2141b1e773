"""The files that an editor wrote or opened, so that it replaces no others unasked."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path


class OwnFiles:
    """Remembers the files of one editor, each with what it belongs to.

    A file belongs to the one that was named when it was written: a texture to its mesh, a session
    file to itself. One that somebody else has changed since then is the editor's no longer.
    """

    def __init__(self) -> None:
        self._owners: dict[Path, tuple[Path, tuple[int, ...] | None]] = {}
        self.session: Path | None = None
        """The session file that was saved or opened last."""

    def note(self, paths: Iterable[Path], owner: Path) -> None:
        """These files were written for ``owner``, or opened."""
        owner = owner.resolve()
        self._owners.update((path.resolve(), (owner, version_of(path))) for path in paths)

    def note_session(self, path: str | Path) -> None:
        """This session file was saved or opened."""
        self.session = Path(path)
        self.note([self.session], self.session)

    def strangers(self, paths: Iterable[Path], owner: Path) -> tuple[Path, ...]:
        """Those of the files that exist and do not belong to ``owner``."""
        owner = owner.resolve()
        return tuple(
            path
            for path in paths
            if path.exists() and self._owners.get(path.resolve()) != (owner, version_of(path))
        )


def version_of(path: Path) -> tuple[int, ...] | None:
    """What differs between two versions of a file; None where there is none."""
    try:
        status = path.stat()
    except OSError:  # one that cannot be reached is told of when it is written
        return None
    return status.st_ino, status.st_mtime_ns, status.st_size
