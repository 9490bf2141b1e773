"""The thread that runs the latest task."""

from __future__ import annotations

import gc
import subprocess
import sys
import threading
import time
from typing import Any

import numpy as np
import pytest

from glid_nb.session.worker import LatestWins, weakly

TIMEOUT = 30.0


class Slow:
    """Runs its tasks, each only once it is allowed to."""

    def __init__(self, **settings: Any) -> None:
        self.done: list[int] = []
        self.begun, self.may = threading.Semaphore(0), threading.Semaphore(0)
        self.worker: LatestWins[int] = LatestWins(weakly(self._work), self, "slow", **settings)

    def _work(self, task: int, worker: LatestWins[int]) -> None:
        self.begun.release()
        assert self.may.acquire(timeout=TIMEOUT)
        self.told = worker.overtaken, worker.cancelled
        self.done.append(task)

    def submit(self, task: int) -> None:
        """Submit a task and wait until it has begun."""
        self.worker.submit(task)
        assert self.begun.acquire(timeout=TIMEOUT)


def test_what_was_overtaken_is_never_begun() -> None:
    slow = Slow()
    slow.submit(1)
    for task in (2, 3, 4):
        slow.worker.submit(task)
    assert slow.worker.busy
    slow.may.release(2)
    assert slow.worker.wait(TIMEOUT)
    assert slow.done == [1, 4]
    assert slow.told == (False, False)
    assert not slow.worker.busy


def test_a_long_task_is_told_that_it_is_overtaken() -> None:
    slow = Slow()
    slow.submit(1)
    slow.worker.submit(2)
    slow.may.release()
    assert slow.begun.acquire(timeout=TIMEOUT)
    assert slow.told == (True, False)
    slow.may.release()
    slow.worker.close()
    assert slow.done == [1, 2]


def test_cancelling_forgets_what_is_pending() -> None:
    slow = Slow()
    slow.submit(1)
    slow.worker.submit(2)
    slow.worker.cancel()
    assert not slow.worker.busy  # it is no longer wanted
    assert not slow.worker.wait(0.01)  # but it is still running
    slow.may.release()
    assert slow.worker.wait(TIMEOUT)
    assert slow.done == [1]
    assert slow.told == (True, True)


def test_closing_need_not_wait_for_the_running_task() -> None:
    slow = Slow(waits=False)
    slow.submit(1)
    slow.worker.close()
    assert slow.done == []
    slow.may.release()
    slow.worker.thread.join(TIMEOUT)
    assert slow.told == (True, True)


def test_the_end_of_the_process_waits_for_the_running_task() -> None:
    source = """
import sys, threading, time
from glid_nb.session.worker import LatestWins
class Owner: pass
owner, begun = Owner(), threading.Event()
def work(task, worker):
    begun.set()
    while not worker.cancelled:
        time.sleep(0.01)
    print("ended")
worker = LatestWins(work, owner, "slow", waits=False)
worker.submit(1)
begun.wait()
if "closed" in sys.argv:
    worker.close()
"""
    for arguments in ([], ["closed"]):
        command = [sys.executable, "-c", source, *arguments]
        assert subprocess.run(command, capture_output=True, text=True).stdout == "ended\n"


@pytest.mark.parametrize(("finish", "done"), [(True, [1, 2]), (False, [1])])
def test_closing_finishes_or_forgets(finish: bool, done: list[int]) -> None:
    slow = Slow(finish=finish)
    slow.submit(1)
    slow.worker.submit(2)
    slow.may.release(2)
    slow.worker.close()
    slow.worker.submit(3)
    assert slow.done[: len(done)] == done
    assert 3 not in slow.done
    assert not slow.worker.thread.is_alive()


@pytest.mark.slow
def test_work_is_rare_but_always_done() -> None:
    class Counter:
        def __init__(self) -> None:
            self.times: list[float] = []
            self.worker: LatestWins[None] = LatestWins(
                weakly(self.work), self, "counter", interval=0.05
            )

        def work(self, *_: object) -> None:
            self.times.append(time.monotonic())

    counter = Counter()
    worker = counter.worker
    end = time.monotonic() + 0.3
    while time.monotonic() < end:
        worker.submit(None)
    assert worker.wait(TIMEOUT)
    assert (np.diff(counter.times) >= 0.049).all()
    assert counter.times[-1] >= end - 0.1
    count = len(counter.times)
    worker.submit(None)
    assert worker.hurry(TIMEOUT)
    assert len(counter.times) == count + 1
    # It ends with its owner.
    thread = worker.thread
    assert thread is not None
    del counter
    gc.collect()
    worker.submit(None)
    thread.join(TIMEOUT)
    assert not thread.is_alive()


def test_hurrying_does_not_wait_for_the_interval() -> None:
    slow = Slow(interval=600.0)
    slow.may.release(2)
    slow.submit(1)
    slow.worker.submit(2)
    assert slow.worker.hurry(TIMEOUT)
    assert slow.done == [1, 2]


def test_work_goes_on_after_an_exception(monkeypatch: pytest.MonkeyPatch) -> None:
    caught: list[Any] = []
    monkeypatch.setattr(threading, "excepthook", caught.append)

    class Failing:
        count = 0

        def work(self, *_: object) -> None:
            self.count += 1
            if self.count == 1:
                raise RuntimeError("no more magic smoke")

    failing = Failing()
    worker: LatestWins[None] = LatestWins(weakly(failing.work), failing, "failing", interval=0.01)
    for expected in (1, 2):
        worker.submit(None)
        assert worker.wait(10)
        assert failing.count == expected
    (report,) = caught
    assert "magic smoke" in str(report.exc_value)
    assert report.thread is worker.thread
    worker.close()
