"""A solver whose preparation goes on stage by stage, as a test wants."""

from __future__ import annotations

from queue import Queue
from types import SimpleNamespace
from typing import Any, Self

import pytest

from glid_nb._runtime import stage

FIRST_REPORT = "first report"
"""Another stage for `go_on`: the solver calls back before its first iteration."""
_TIMEOUT = 120.0


class Preparation:
    """Replaces ``solve``: it goes through the stages that it gets, and never ends."""

    def __init__(self) -> None:
        self._names, self._begun = Queue[str](), Queue[str]()

    @classmethod
    def instead_of_solving(cls, monkeypatch: pytest.MonkeyPatch) -> Self:
        new = cls()
        monkeypatch.setattr("glid_nb.session.live_solver.solve", new.solve)
        return new

    def solve(self, *arguments: Any, **_: object) -> None:
        while True:
            name = self._names.get(timeout=_TIMEOUT)
            if name == FIRST_REPORT:
                callback = arguments[-1]
                callback(SimpleNamespace(sigma2_lower=None, history=()))
            else:
                stage(name)
            self._begun.put(name)

    def go_on(self, *names: str, wait: bool = True) -> None:
        """Begin these stages, one after the other."""
        for name in names:
            self._names.put(name)
            if wait:
                assert self._begun.get(timeout=_TIMEOUT) == name
