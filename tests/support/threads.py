"""The threads that a test starts, by their names."""

from __future__ import annotations

import threading


class NewThreads:
    """The threads that began after this was made and are still alive."""

    def __init__(self) -> None:
        self._before = set(threading.enumerate())

    def named(self, name: str) -> threading.Thread | None:
        """The one of this name, if there is one."""
        new = set(threading.enumerate()) - self._before
        found = [thread for thread in new if thread.name == name]
        assert len(found) <= 1, found
        return found[0] if found else None
