"""Many problems: outcomes, errors by name, what is refused, the folder, lost workers.

The executors here run in this process, and most of them only repeat what was answered once.
"""

from __future__ import annotations

import dataclasses
import pickle
from concurrent.futures import Executor, Future
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from glid_nb.certificate import certify
from glid_nb.energies import CustomEnergy
from glid_nb.geometry import graded_panels
from glid_nb.harmonic import HarmonicMap
from glid_nb.many import ExecutorLostError, ProblemError, answer, solve_many, worker
from glid_nb.methods import SLIM
from glid_nb.minima import solve
from glid_nb.pose import Pose
from glid_nb.solvers import Options
from glid_nb.solvers.method import MethodError

from ..support.domains import domain

pytestmark = pytest.mark.slow

HANDLES = np.array([[-2.5, 2.5], [2.5, -2.5], [-2.0, -2.0]])
OUTSIDE = Pose([[50, 0]], [[0, 0]])


def poses(count: int) -> list[Pose]:
    moves = np.random.default_rng(0).normal(scale=0.3, size=(count, *HANDLES.shape))
    return [Pose(HANDLES, HANDLES + move) for move in moves]


POSES = poses(4)
PROBLEMS = [(domain("ell"), pose) for pose in POSES]


class Direct(Executor):
    """Solves when a problem is submitted, and keeps the answers by poses."""

    def __init__(self, answers: dict[bytes, bytes] | None = None) -> None:
        self.answers = {} if answers is None else answers
        self.sent = list[tuple[Any, ...]]()

    def submit(self, fn: Any, /, *args: Any, **_: Any) -> Future[Any]:
        self.sent.append(args)
        future = Future[Any]()
        future.set_result(self.answer(fn, *args))
        return future

    def answer(self, fn: Any, *args: Any) -> Any:
        if (pose := args[2]) not in self.answers:
            self.answers[pose] = fn(*args)
        return self.answers[pose]


@pytest.fixture(scope="module")
def answers() -> dict[bytes, bytes]:
    """What a worker answers to POSES."""
    direct = Direct()
    assert all(one.result for one in solve_many(PROBLEMS, executor=direct))
    return direct.answers


@pytest.fixture
def direct(answers: dict[bytes, bytes]) -> Direct:
    return Direct(dict(answers))


def test_a_result_is_that_of_solve_bit_for_bit(direct: Direct) -> None:
    alone = solve(*PROBLEMS[1])
    for one in (
        next(solve_many(PROBLEMS[1:2])).result,
        next(solve_many(PROBLEMS[1:2], executor=direct)).result,
    ):
        np.testing.assert_array_equal([one.map.phi, one.map.psi], [alone.map.phi, alone.map.psi])
        assert (one.status, one.energy, one.message) == (alone.status, alone.energy, alone.message)
        times = {"time": 0.0}
        for mine, theirs in zip(one.history, alone.history, strict=True):
            assert dataclasses.replace(mine, **times) == dataclasses.replace(theirs, **times)
        assert one.pose is POSES[1]
        assert one.map.domain is domain("ell")
        assert one.certificate.certified
        for bound in ("sigma2_lower", "sigma1_upper", "k_upper", "windings"):
            assert getattr(one.certificate, bound) == getattr(alone.certificate, bound)


def test_what_travels_is_small(direct: Direct) -> None:
    list(solve_many(PROBLEMS, executor=direct))
    _, _, pose, _ = direct.sent[0]
    assert len(pose) < 600
    assert max(map(len, direct.answers.values())) < 1000
    assert len(pickle.dumps(solve(*PROBLEMS[0]))) > 100_000


def test_problems_that_raise_are_named_and_the_others_go_on(direct: Direct) -> None:
    given = {
        "first": PROBLEMS[0],
        "outside": (domain("ell"), OUTSIDE),
        "no": 3,
        "last": PROBLEMS[3],
    }
    found = {one.name: one for one in solve_many(given, executor=direct)}
    assert {one.index for one in found.values()} == {0, 1, 2, 3}
    assert all(found[name].result and not found[name].error for name in ("first", "last"))
    assert str(found["outside"].error).startswith("outside: PoseError: handle 0 at (50, 0) lies")
    assert found["outside"].error.kind == "PoseError"
    assert "no: a problem must be a glid_nb.io.Problem" in str(found["no"].error)
    rows = {name: one.to_row() for name, one in found.items()}
    assert rows["first"]["certified"] is True
    assert rows["outside"]["status"] == "failed"
    assert rows["first"].keys() == rows["outside"].keys()


def answered(answer_bytes: bytes, **how: Any) -> Any:
    """The outcome of problem 0 if a worker answers this."""

    class Other(Direct):
        def answer(self, *_: Any) -> Any:
            return answer_bytes

    return next(solve_many(PROBLEMS[:1], executor=Other(), **how))


def own_key(data: bytes) -> str:
    return answer.read(data).header["problem"]


def test_an_answer_to_another_problem_is_refused(answers: dict[bytes, bytes]) -> None:
    first, second, *_ = answers.values()
    error = answered(second).error
    assert str(error) == "problem 0: what came back is the result of another problem"
    # Somebody has put this problem's key on it.
    wrong = answer.of_result(solve(*PROBLEMS[1]), own_key(first))
    assert "misses the targets by" in str(answered(wrong).error)
    assert "it is of another problem" in str(answered(wrong, check=False).error)


def test_a_map_that_is_not_certified_here_is_refused(answers: dict[bytes, bytes]) -> None:
    first = next(iter(answers.values()))
    result = solve(*PROBLEMS[0])
    folded = HarmonicMap(domain("ell"), result.map.psi, result.map.phi)  # a mirror image
    assert not certify(folded).certified
    p2p = 0.5e5 * (np.linalg.norm(folded(HANDLES) - POSES[0].targets, axis=1) ** 2).sum()
    claims = {"map": folded, "energy_p2p": p2p / domain("ell").cage.unit ** 2}
    data = answer.of_result(dataclasses.replace(result, **claims), own_key(first))
    assert "problem 0: the map that came back is not certified here: " in str(answered(data).error)
    assert not answered(data, check=False).result.certificate.certified
    other = HarmonicMap.identity(domain("ring"))
    few = dataclasses.replace(result, map=other, discretisation=None)
    data = answer.of_result(few, own_key(first))
    assert "what came back is no result of this problem: phi has shape" in str(answered(data).error)


@pytest.mark.parametrize("data", [b"", b"nonsense", 7, None])
def test_bytes_that_are_no_answer_are_refused(data: Any) -> None:
    assert "problem 0: it is no answer of a worker" in str(answered(data).error)


def test_a_damaged_answer_is_refused(answers: dict[bytes, bytes]) -> None:
    data = next(iter(answers.values()))
    for wrong in (data[:-1], data[:200], data[:-9] + b"x" + data[-8:]):
        assert "it is cut short or damaged" in str(answered(wrong).error)


def test_another_version_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    with monkeypatch.context() as other:
        other.setattr(answer, "our_version", lambda: "9.9")
        data = answer.of_error(ValueError(), "key")
    assert "the worker has glid_nb 9.9, and here is" in str(answered(data).error)


def test_a_bug_brings_its_traceback(answers: dict[bytes, bytes]) -> None:
    key = own_key(next(iter(answers.values())))
    try:
        raise ZeroDivisionError("by nothing")
    except ZeroDivisionError as bug:
        data = answer.of_error(bug, key)
    error = answered(data).error
    assert str(error) == "problem 0: ZeroDivisionError: by nothing"
    assert "raise ZeroDivisionError" in error.__notes__[0]
    assert isinstance(pickle.loads(pickle.dumps(error)), ProblemError)


class Refuses(Executor):
    """Nothing is solved."""

    def submit(self, *_: Any, **__: Any) -> Future[Any]:
        raise AssertionError("solved again")


def test_a_folder_is_gone_on_from(direct: Direct, tmp_path: Path) -> None:
    list(solve_many(PROBLEMS[:3], executor=direct, folder=tmp_path))
    files = sorted(tmp_path.glob("??/*.solved"))
    assert len(files) == 3
    again = list(solve_many(PROBLEMS[:3], executor=Refuses(), folder=tmp_path))
    assert all(one.kept and one.result.certificate.certified for one in again)
    # A crash, a bad disk and another problem's file. A fourth problem is new.
    files[0].write_bytes(files[0].read_bytes()[:100])
    files[1].write_bytes(files[2].read_bytes())
    some = Direct(direct.answers)
    found = list(solve_many(PROBLEMS, executor=some, folder=tmp_path))
    assert [one.kept for one in found].count(True) == 1
    assert len(some.sent) == 3
    assert len(list(tmp_path.glob("??/*"))) == 4
    softer = Options(p2p_weight=10.0)
    with pytest.raises(ExecutorLostError, match="solved again"):
        next(solve_many(PROBLEMS, options=softer, executor=Refuses(), folder=tmp_path))


def test_a_plan_is_sent_until_a_worker_has_it(direct: Direct) -> None:
    class New(Direct):
        """Its workers have never seen a plan."""

        def answer(self, fn: Any, *args: Any) -> Any:
            return super().answer(fn, *args) if args[1] else worker.NO_PLAN

    new = New(direct.answers)
    found = list(solve_many(PROBLEMS, executor=new, in_flight=1))
    assert all(one.result for one in found)
    # The first problem brings it. Each other one comes without it, and again with it.
    assert [args[1] is not None for args in new.sent] == [True, *[False, True] * 3]
    assert len(new.sent[0][1]) < 5000


class Breaks(Direct):
    """Some futures fail."""

    def __init__(self, answers: dict[bytes, bytes], failures: list[BaseException | None]) -> None:
        super().__init__(answers)
        self.failures = failures

    def submit(self, fn: Any, /, *args: Any, **_: Any) -> Future[Any]:
        future = super().submit(fn, *args)
        if self.failures and (error := self.failures.pop(0)) is not None:
            future = Future[Any]()
            future.set_exception(error)
        return future


def test_a_lost_worker_of_a_callers_executor_costs_its_problem_once_more(direct: Direct) -> None:
    breaks = Breaks(direct.answers, [None, BrokenProcessPool("gone")])
    found = list(solve_many(PROBLEMS, executor=breaks))
    assert sorted(one.index for one in found) == [0, 1, 2, 3]
    assert all(one.result for one in found)
    assert len(breaks.sent) == 5


def test_a_lost_executor_is_named_and_what_came_back_is_kept(
    direct: Direct, tmp_path: Path
) -> None:
    breaks = Breaks(direct.answers, [None, *[BrokenProcessPool("gone")] * 9])
    many = solve_many(PROBLEMS, executor=breaks, folder=tmp_path, in_flight=1)
    assert next(many).result
    lost = r"no more work \(BrokenProcessPool: gone\); .* with the same folder if you named one"
    with pytest.raises(ExecutorLostError, match=lost):
        next(many)
    assert len(list(tmp_path.glob("*/*"))) == 1


def test_what_cannot_be_pickled_is_its_problems_error(direct: Direct) -> None:
    breaks = Breaks(direct.answers, [pickle.PicklingError("no lambda")])
    first, *others = solve_many(PROBLEMS, executor=breaks)
    assert str(first.error) == "problem 0: its worker: PicklingError: no lambda"
    assert all(one.result for one in others)


class Waits(Executor):
    """Never answers."""

    def __init__(self) -> None:
        self.futures = list[Future[Any]]()

    def submit(self, *_: Any, **__: Any) -> Future[Any]:
        if len(self.futures) == 3:
            raise KeyboardInterrupt
        self.futures.append(Future())
        return self.futures[-1]


def test_ctrl_c_cancels_what_has_not_begun() -> None:
    waits = Waits()
    with pytest.raises(KeyboardInterrupt):
        next(solve_many(PROBLEMS, executor=waits))
    assert [future.cancelled() for future in waits.futures] == [True] * 3


def made_for(problems: list[Any], executor: Direct, in_flight: int, wanted: int) -> int:
    """How many problems of an endless row are made until some results are there."""
    made = 0

    def endless() -> Any:
        nonlocal made
        while True:
            made += 1
            yield problems[made % len(problems)]

    many = solve_many(endless(), executor=executor, in_flight=in_flight)
    for _ in range(wanted):
        assert next(many).result
    many.close()
    return made


def test_problems_are_made_when_there_is_room(direct: Direct) -> None:
    assert made_for(PROBLEMS[:4], direct, in_flight=2, wanted=5) <= 8


class Later(Direct):
    """Answers nothing before it is told to."""

    def __init__(self, answers: dict[bytes, bytes]) -> None:
        super().__init__(answers)
        self.waiting = list[tuple[Future[Any], Any]]()

    def submit(self, fn: Any, /, *args: Any, **_: Any) -> Future[Any]:
        self.sent.append(args)
        self.waiting.append((Future(), (fn, *args)))
        if len(self.waiting) == 2:
            for future, how in self.waiting:
                future.set_result(self.answer(*how))
        return self.waiting[-1][0]


def test_equal_problems_under_way_are_solved_once(
    answers: dict[bytes, bytes], tmp_path: Path
) -> None:
    later = Later(dict(answers))
    same = POSES[0].with_targets(POSES[0].targets.copy())
    equal = {"a": PROBLEMS[0], "b": (domain("ell"), same), "c": PROBLEMS[0], "other": PROBLEMS[1]}
    found = {one.name: one for one in solve_many(equal, executor=later, folder=tmp_path)}
    assert len(later.sent) == 2
    assert found.keys() == equal.keys()
    assert found["b"].result.pose is same
    assert found["a"].result.energy == found["b"].result.energy == found["c"].result.energy
    assert all(one.result.certificate.certified and not one.kept for one in found.values())
    assert len(list(tmp_path.glob("*/*"))) == 2


def test_an_error_is_that_of_all_equal_problems(answers: dict[bytes, bytes]) -> None:
    later = Later(dict(answers))
    equal = {"a": (domain("ell"), OUTSIDE), "b": (domain("ell"), OUTSIDE), "c": PROBLEMS[0]}
    found = {one.name: one for one in solve_many(equal, executor=later)}
    assert len(later.sent) == 2
    assert found["c"].result
    for name in ("a", "b"):
        assert str(found[name].error).startswith(f"{name}: PoseError: handle 0")


def test_equal_problems_take_no_more_than_their_room(direct: Direct) -> None:
    assert made_for(PROBLEMS[:1], direct, in_flight=3, wanted=7) <= 10


def test_a_bar_counts(direct: Direct, capsys: pytest.CaptureFixture[str]) -> None:
    given = [*PROBLEMS, None]
    assert len(list(solve_many(given, executor=direct, progress=True))) == 5
    shown = capsys.readouterr().err
    assert "5/5" in shown
    assert "failed=1" in shown


def test_panels_are_told_by_their_depths() -> None:
    shape, rng = domain("triple"), np.random.default_rng(0)
    panels = graded_panels(shape)
    for _ in range(5):
        panels, _ = panels.split(rng.random(len(panels)) < 0.3)
    again = answer.panels_of(shape, Options(), panels.depth.astype(np.uint8))
    np.testing.assert_array_equal(again.start, panels.start)
    for wrong in (panels.depth[:-1], panels.depth[1:], panels.depth + 1):
        assert answer.panels_of(shape, Options(), wrong) is None


@pytest.mark.parametrize(
    ("how", "error", "message"),
    [
        ({"executor": "all"}, TypeError, "executor must be a number of processes, a concurrent"),
        ({"executor": 0}, ValueError, "executor is 0; it must be at least 1 processes"),
        ({"in_flight": 0}, ValueError, "in_flight is 0"),
        ({"options": 3}, TypeError, "options must be Options or None"),
        ({"method": SLIM()}, MethodError, "the maps of the method 'slim' have no certificate"),
        ({"check": "yes"}, TypeError, "check must be bool"),
        (
            {"energy": CustomEnergy(lambda x, y: (x + y) * (1 + 1 / (x - y) ** 2)), "folder": "a"},
            ValueError,
            "a function has none; leave folder= out",
        ),
    ],
)
def test_wrong_arguments_are_refused_at_once(how: Any, error: Any, message: str) -> None:
    with pytest.raises(error, match=message):
        solve_many(PROBLEMS, **how)
