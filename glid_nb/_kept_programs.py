"""A folder of compiled programs, kept between processes. It only saves time.

A program that cannot be read is compiled again. If the folder cannot be written to, one warning
says so, and the process continues without it.
"""

import hashlib
import os
import pickle
import zlib
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from glid_nb._cache_folder import is_refused, refuse
from glid_nb._features import executables
from glid_nb._files import write_atomically
from glid_nb._runtime import stage

_CHECKSUM = hashlib.sha256().digest_size


class KeptPrograms:
    """The programs in a folder. Each has a name and may have aliases."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def has(self, alias: str) -> bool:
        """Whether a program was saved under ``alias``. It is not read."""
        return bool(self._read(alias))

    def by_alias(self, alias: str) -> Any | None:
        """The program that was last saved under ``alias``; None if there is none."""
        try:
            name = self._read(alias).decode("ascii")
        except UnicodeDecodeError:
            return None
        return self.by_name(name) if name.isidentifier() else None

    def by_name(self, name: str) -> Any | None:
        """The program, ready to be called; None if there is none or it cannot be used."""
        data = self._read(name)
        checksum, content = data[:_CHECKSUM], data[_CHECKSUM:]
        if hashlib.sha256(content).digest() != checksum or (library := executables()) is None:
            return None
        stage("load")
        try:
            return library.deserialize_and_load(*pickle.loads(zlib.decompress(content)))
        except Exception:  # a file of another version can raise any error
            return None

    def keep(self, program: Any, name: str, aliases: Iterable[str]) -> None:
        """Write a compiled program and its aliases. If that is not possible, one warning says
        so."""
        if is_refused(self._folder) or (library := executables()) is None:
            return
        try:
            content = zlib.compress(pickle.dumps(library.serialize(program)), 1)
        except Exception as error:  # JAX raises many kinds of errors
            refuse(self._folder, f"this JAX cannot write them: {error}")
            return
        self._write(name, hashlib.sha256(content).digest() + content)
        for alias in aliases:
            self.name_again(name, alias)

    def name_again(self, name: str, alias: str) -> None:
        """Add an alias to the program ``name``."""
        self._write(alias, name.encode("ascii"))

    def _read(self, name: str) -> bytes:
        """The bytes of a file; empty if it is missing, cannot be read, or has another owner."""
        path = self._folder / name
        try:
            if not path.is_file():
                return b""
            if not _is_trusted(path):
                refuse(self._folder, "they belong to another user")
                return b""
            return path.read_bytes()
        except OSError as error:
            refuse(self._folder, str(error))
            return b""

    def _write(self, name: str, data: bytes) -> None:
        if is_refused(self._folder):
            return
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
            write_atomically(self._folder / name, data)
        except OSError as error:
            refuse(self._folder, error.strerror or str(error))


def _is_trusted(path: Path) -> bool:
    """Whether this user or the administrator wrote a program.

    Loading a program executes it, so programs of other users must not be loaded.
    """
    owners = trusted_owners()
    return owners is None or path.stat().st_uid in owners


def trusted_owners() -> set[int] | None:
    """The users whose programs are loaded; None if files have no owners here."""
    if not hasattr(os, "geteuid"):  # Windows keeps a user's folders from other users
        return None
    return {0, os.geteuid()}
