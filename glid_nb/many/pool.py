"""Where problems are solved: in this process, in processes of ours, or on a caller's executor."""

import os
import pickle
import signal
import threading
from concurrent.futures import BrokenExecutor, CancelledError, Executor, Future, ProcessPoolExecutor
from multiprocessing import get_context, parent_process
from typing import Any, Protocol

from glid_nb._arguments import check_count
from glid_nb._errors import InputError

# Problems that are handed over before their turn. Processes take the next ones from a short queue,
# other executors should learn early what there is to do.
_AHEAD, _AHEAD_OF_OTHERS = 3, 1000


class ExecutorLostError(InputError):
    """The executor accepts no more work. Results that have come back are valid."""


class Pool(Protocol):
    """Runs functions, one future each."""

    in_flight: int
    """Problems that are handed over at a time."""
    is_here: bool
    """Whether arguments stay in this process."""

    def submit(self, function: Any, *arguments: Any) -> Future[Any]:
        """Raises an ExecutorLostError if no function can be run."""
        ...

    def renew(self) -> bool:
        """Replace processes of which one has died. False for an executor of the caller."""
        ...

    def close(self) -> None:
        """Wait for what has begun. An executor of the caller stays open."""
        ...


def pool_for(executor: Executor | int | None, in_flight: int | None) -> Pool:
    """The pool for the argument ``executor`` of `solve_many`."""
    if in_flight is not None:
        in_flight = check_count("in_flight", in_flight, 1, "problems")
    if executor is None:
        return ThisProcess()
    if isinstance(executor, Executor) or callable(getattr(executor, "submit", None)):
        return Callers(executor, in_flight or _AHEAD_OF_OTHERS)
    if isinstance(executor, int):
        jobs = check_count("executor", executor, 1, "processes")
        return Processes(jobs, in_flight or _AHEAD * jobs)
    wanted = "a number of processes, a concurrent.futures.Executor or None"
    raise TypeError(f"executor must be {wanted}, not {type(executor).__name__}")


class ThisProcess:
    """Solves in this process and thread, one problem after the other."""

    in_flight, is_here = 1, True

    def submit(self, function: Any, *arguments: Any) -> Future[Any]:
        future = Future[Any]()
        future.set_result(function(*arguments))
        return future

    def renew(self) -> bool:
        return False

    def close(self) -> None:
        pass


class Processes:
    """Processes of this machine, started by "spawn": threads of JAX do not survive a fork."""

    is_here = False

    def __init__(self, jobs: int, in_flight: int) -> None:
        self._jobs, self.in_flight = jobs, in_flight
        self._made: ProcessPoolExecutor | None = None

    def submit(self, function: Any, *arguments: Any) -> Future[Any]:
        if self._made is None:
            how = {"mp_context": get_context("spawn"), "initializer": _depend_on_the_parent}
            self._made = ProcessPoolExecutor(self._jobs, **how)
        return self._made.submit(function, *arguments)

    def renew(self) -> bool:
        self.close()
        return True

    def close(self) -> None:
        made, self._made = self._made, None
        if made is not None:
            made.shutdown(wait=True, cancel_futures=True)


def _depend_on_the_parent() -> None:
    """Leave Ctrl-C to the parent, and end when the parent ends.

    In a terminal Ctrl-C reaches all processes, and the parent ends the others in order. A parent
    that is killed cannot do so. Its processes would wait for work for ever.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_the_parent, daemon=True).start()


def _end_with_the_parent() -> None:
    if (parent := parent_process()) is not None:
        parent.join()
        os._exit(1)


class Callers:
    """An executor of the caller, who also closes it."""

    is_here = False

    def __init__(self, executor: Any, in_flight: int) -> None:
        self._executor, self.in_flight = executor, in_flight

    def submit(self, function: Any, *arguments: Any) -> Future[Any]:
        try:
            return self._executor.submit(function, *arguments)
        except (pickle.PicklingError, TypeError, AttributeError) as error:  # not to be pickled
            failed = Future[Any]()
            failed.set_exception(error)
            return failed
        except Exception as error:  # of each kind of executor another class
            raise lost(error) from error

    def renew(self) -> bool:
        return False

    def close(self) -> None:
        pass


def lost(error: BaseException | None) -> ExecutorLostError:
    """The error for an executor that takes no more work, with what to do."""
    what = "the executor accepts no more work"
    if error is not None:
        told = " ".join(str(error).split())
        what += f" ({type(error).__name__}{': ' * bool(told)}{told:.200})"
    remedy = "what has come back is valid: make a new executor and call again, with the same folder"
    return ExecutorLostError(f"{what}; {remedy} if you named one, and only the others are solved")


def is_loss(error: BaseException) -> bool:
    """Whether a future failed because its worker or the scheduler is gone."""
    return isinstance(error, BrokenExecutor | CancelledError)
