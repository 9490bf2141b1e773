"""Check whether compiled programs can be kept in a folder. If not, one warning says so."""

import os
import threading
import warnings
from pathlib import Path

_lock = threading.Lock()
refused = set[Path]()  # folders that this process no longer writes to


class CacheWarning(RuntimeWarning):
    """Compiled programs cannot be kept between processes."""


def refuse(folder: Path, why: str) -> None:
    """Stop writing to ``folder``, with one warning per process."""
    with _lock:
        if folder in refused:
            return
        refused.add(folder)
    text = (
        f"compiled programs are not kept in {folder} ({why}), so every new process compiles them "
        "again; name a folder of your own in the environment variable GLID_NB_CACHE"
    )
    warnings.warn(text, CacheWarning, stacklevel=3)


def can_write(folder: Path) -> bool:
    """Whether files can be made in ``folder``, which is made if missing. If not, warns once."""
    probe = folder / f".probe-{os.getpid()}-{threading.get_ident()}"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        try:
            probe.write_bytes(bytes(1 << 16))  # enough to notice a full disk
        finally:
            probe.unlink(missing_ok=True)
    except OSError as error:
        refuse(folder, error.strerror or str(error))
        return False
    return True


def is_refused(folder: Path) -> bool:
    """Whether this process has given up writing to ``folder``."""
    return folder in refused
