"""Preparation is made anew for each time it is taken."""

from __future__ import annotations

from typing import Any

import pytest

from glid_nb.session import Problem
from studies.comparisons import preparation
from studies.comparisons.cases import Case

from ...methods.problems import problem


@pytest.mark.parametrize(("method", "on_mesh"), [("newton", False), ("aqp", True)])
def test_nothing_is_left_from_before(
    method: str, on_mesh: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    case = Case("ell", Problem(*problem("ell")))
    seen: list[Any] = []
    run = preparation.run

    def watched(name: str, given: Case, **settings: Any) -> Any:
        seen.append(settings["triangulation"] if on_mesh else given.problem.domain)
        return run(name, given, **settings)

    monkeypatch.setattr(preparation, "run", watched)
    assert preparation.preparation(method, case, on_mesh, 200) > 0
    assert len({id(made) for made in seen}) == len(seen) == 4
    assert case.problem.domain not in seen
