"""The programs that the next gestures may need, compiled while nobody works."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from queue import Queue
from typing import Any

import pytest

from glid_nb.session.ahead import ProgramsAhead
from glid_nb.session.deformation import Deformation
from glid_nb.solvers import ahead

from ..support.domains import domain

pytestmark = pytest.mark.slow

TIMEOUT = 120.0
WAITS = [sys.executable, "-c", "input()"]

Process = subprocess.Popen[bytes]


@pytest.fixture
def started(monkeypatch: pytest.MonkeyPatch) -> Iterator[Queue[Process]]:
    """The processes that were started. They do nothing until their input ends."""
    processes, made = Queue[Process](), list[Process]()

    def start(_: Any) -> Process:
        made.append(subprocess.Popen(WAITS, stdin=subprocess.PIPE, stderr=subprocess.DEVNULL))
        processes.put(made[-1])
        return made[-1]

    monkeypatch.setattr(ahead, "missing_programs", lambda _: [("one",)])
    monkeypatch.setattr(ahead, "start", start)
    yield processes
    for process in made:
        process.kill()
        process.communicate()


@pytest.fixture
def model() -> Iterator[Deformation]:
    with Deformation(domain("ring")) as deformation:
        deformation.add_handles([(2, 0), (-2, 0)])
        assert deformation.solve(TIMEOUT)
        yield deformation


def test_a_drag_ends_it_and_the_next_rest_begins_it_again(
    model: Deformation, started: Queue[Process]
) -> None:
    programs = ProgramsAhead(model, rest=0)
    first = started.get(timeout=TIMEOUT)
    assert first.poll() is None
    model.begin_drag([0])
    assert first.wait(TIMEOUT) != 0
    assert programs.worker.wait(TIMEOUT)
    assert started.empty()
    model.drag_to([(2.1, 0.2)])
    model.end_drag()
    assert model.solve(TIMEOUT)
    second = started.get(timeout=TIMEOUT)
    second.communicate()
    assert programs.worker.wait(TIMEOUT)
    # The same kind of problem has the same programs.
    model.drag(0, to=(2, 0.1))
    assert model.solve(TIMEOUT)
    assert programs.worker.wait(TIMEOUT)
    assert started.empty()
    programs.close()


def test_it_waits_for_the_rest_and_closing_ends_it(
    model: Deformation, started: Queue[Process]
) -> None:
    waiting = ProgramsAhead(model, rest=TIMEOUT)
    model.begin_drag([0])
    assert waiting.worker.wait(TIMEOUT / 2)
    model.end_drag()
    waiting.close()
    assert started.empty()
    running = ProgramsAhead(model, rest=0)
    process = started.get(timeout=TIMEOUT)
    running.close()
    assert process.wait(TIMEOUT) != 0


def test_a_paused_solver_needs_no_programs(model: Deformation, started: Queue[Process]) -> None:
    model.paused = True
    programs = ProgramsAhead(model, rest=0)
    assert programs.worker.wait(TIMEOUT)
    assert started.empty()
    model.paused = False
    assert started.get(timeout=TIMEOUT).poll() is None
    programs.close()
