"""A folder of answers, one file each, from which an interrupted run goes on."""

import contextlib
from pathlib import Path

from glid_nb._files import write_atomically


class Folder:
    """Files by the keys of their problems. The keys' first two digits name folders inside."""

    def __init__(self, path: Path) -> None:
        self._path = path

    def read(self, key: str) -> bytes | None:
        """The bytes of an answer; None if there are none, or if they cannot be read."""
        with contextlib.suppress(OSError):
            return self._file(key).read_bytes()
        return None

    def write(self, key: str, data: bytes) -> None:
        """Keep an answer. The file is complete or not there, also after a crash."""
        file = self._file(key)
        file.parent.mkdir(parents=True, exist_ok=True)
        write_atomically(file, data)

    def _file(self, key: str) -> Path:
        return self._path / key[:2] / f"{key[2:]}.solved"
