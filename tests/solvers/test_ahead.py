"""Programs that another process compiles before they are needed."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import jax
import pytest

from glid_nb import solve
from glid_nb._runtime import watched
from glid_nb.energies import SymmetricDirichlet
from glid_nb.pose import Pose, Stiffness
from glid_nb.solvers import Options, ahead
from glid_nb.solvers.method import Inputs

from ..support.cache import kept_in
from ..support.domains import domain

pytestmark = pytest.mark.slow

TIMEOUT = 200.0
OPTIONS = Options(restarts=0, iterations_per_call=1)
POSE = Pose([(2, 0), (-2, 0)], [(2, 0), (-2, 0)])
STIFF = replace(POSE, targets=[(2.2, 0.1), (-2, 0)], stiffness=Stiffness().painted([(2, 0)], 0.3))


@pytest.fixture(autouse=True)
def folder(tmp_path: Path) -> Iterator[Path]:
    with kept_in(tmp_path) as folder:
        yield folder


def inputs(pose: Pose) -> Inputs:
    parts: Any = {"energy": SymmetricDirichlet(), "options": OPTIONS}
    return Inputs(domain=domain("ring"), pose=pose, **parts)


def test_the_first_stiff_stroke_finds_its_program() -> None:
    (*others, stiff, full) = ahead.missing_programs(inputs(POSE))
    assert all(one[0].matrices.stiff is None for one in others)
    assert stiff[0].matrices.stiff is not None
    assert len(full[0].matrices.hessian_index) > len(stiff[0].matrices.hessian_index)
    process = ahead.start([stiff])
    assert process is not None
    assert process.wait(TIMEOUT) == 0
    assert len(ahead.missing_programs(inputs(POSE))) == len(others) + 1
    seen: list[str] = []
    with watched(seen.append):
        result = solve(domain("ring"), STIFF, options=OPTIONS)
    assert result.status.ok
    assert "load" in seen
    assert "compile" not in seen


def test_more_rows_are_made_ahead_once_few_are_free() -> None:
    def rows(pose: Pose) -> set[int]:
        missing = ahead.missing_programs(inputs(pose))
        return {len(one[0].positional.weights) // 2 for one in missing}

    many = [(2, 0.05 * i) for i in range(13)]
    assert rows(POSE) == {16}
    assert rows(Pose(many, many)) == {16, 32}
    few = Pose(many[:7], many[:7], angles=[0.0] * 7)  # a ring needs a row too
    assert rows(few) == {16, 32}


def test_without_a_folder_nothing_is_made_ahead() -> None:
    jax.config.update("jax_compilation_cache_dir", None)
    assert ahead.missing_programs(inputs(POSE)) == []


def test_a_system_without_processes_goes_on(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ahead.sys, "executable", "/no/such/interpreter")
    assert ahead.start(ahead.missing_programs(inputs(POSE))) is None


def test_a_process_that_ends_before_it_reads_is_none(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ahead, "_CODE", "")
    assert ahead.start([("x" * 1_000_000,)]) is None
