"""Solve many problems, of one domain or of many, on processes and machines."""

import functools
from collections import deque
from collections.abc import Generator, Iterable, Iterator, Mapping, Sized
from concurrent.futures import Executor, Future
from dataclasses import dataclass, field
from pathlib import Path
from queue import Empty, SimpleQueue
from typing import Any
from weakref import WeakValueDictionary

import numpy as np

from glid_nb._arguments import check_type
from glid_nb._errors import InputError
from glid_nb._files import path_of
from glid_nb.energies import CustomEnergy, Energy
from glid_nb.geometry import Domain
from glid_nb.many import worker
from glid_nb.many.answer import DamagedError, ProblemError, received
from glid_nb.many.folder import Folder
from glid_nb.many.plan import Plan
from glid_nb.many.pool import ExecutorLostError, Pool, is_loss, lost, pool_for
from glid_nb.minima.solve import method_for
from glid_nb.pose import Pose
from glid_nb.solvers.method import Method, MethodError
from glid_nb.solvers.options import Options
from glid_nb.solvers.result import Result

# A problem whose worker died goes back to the others this often. After that it is tried once
# alone, so that it takes no other problem with it.
_TOGETHER = 1
_POLL = 0.5  # seconds between looks for Ctrl-C, which Windows does not deliver to a waiting thread


@dataclass(frozen=True, eq=False)
class Solved:
    """The outcome of one of many problems: a result or an error."""

    index: int
    """The problem's place among the given ones, from 0."""
    name: str
    """Its name, such as "problem 3"."""
    result: Result | None
    """The result; None if there is an error. Its map is on the problem's own domain, or on an equal
    domain of an earlier problem. It has no matrices of the solve (``discretisation``)."""
    error: InputError | None
    """The reason why there is no result; the message begins with the name."""
    kept: bool = False
    """Whether the result was read from the folder instead of solved."""

    def to_row(self) -> dict[str, Any]:
        """Plain values for a table: energies, proved bounds, times, or the error's message."""
        row: dict[str, Any] = {"index": self.index, "name": self.name}
        names = ("status", "certified", "energy", "E_iso", "E_p2p", "largest_miss")
        names += ("sigma2_lower", "sigma1_upper", "k_upper", "iterations")
        names += ("compile_time", "solve_time", "kept", "error")
        row.update(dict.fromkeys(names), kept=self.kept)
        if self.result is None:
            return {**row, "status": "failed", "error": str(self.error)}
        result, proof = self.result, self.result.certificate
        assert proof is not None  # the maps are harmonic
        return {
            **row,
            "status": result.status.value,
            "certified": proof.certified,
            "energy": result.energy,
            "E_iso": result.energy_distortion,
            "E_p2p": result.energy_p2p,
            "largest_miss": float(np.max(result.misses, initial=0.0)),
            **{name: getattr(proof, name) for name in ("sigma2_lower", "sigma1_upper", "k_upper")},
            "iterations": result.iterations,
            "compile_time": result.compile_time,
            "solve_time": result.solve_time,
        }


def solve_many(
    problems: Iterable[Any] | Mapping[Any, Any],
    energy: Energy | str | None = None,
    options: Options | None = None,
    *,
    method: Method | None = None,
    executor: Executor | int | None = None,
    folder: str | Path | None = None,
    check: bool = True,
    progress: bool = False,
    in_flight: int | None = None,
) -> Generator[Solved, None, None]:
    """Solve many problems and yield each outcome when it is there, in the order in which they end.

    A problem is a :class:`glid_nb.io.Problem` or another object with a ``domain`` and a ``pose``,
    or a pair of the two. An iterable may make problems when they are asked for. A mapping gives
    them names for the messages. Problems of equal domains share its matrices; give them one after
    the other, because a worker keeps the matrices of the last 8 domains. Energy, options and method
    are as in :func:`glid_nb.solve`, for a method whose maps are certified.

    ``executor`` is a number of processes of this machine, started by "spawn" and ended afterwards;
    or any executor of the kind of ``concurrent.futures``, which stays open: of dask
    (``client.get_executor()``), ipyparallel, mpi4py, loky. None solves here, one after the other.
    ``in_flight`` problems are handed over at a time, by default 3 for each process, 1000 to other
    executors. Equal ones among them are solved once.

    With ``check``, every map that comes back is certified here, from its coefficients. With
    ``folder``, each result is kept in a file there, found by a hash of the problem, the options and
    the version; a later call with the same folder reads it instead of solving. Damaged files are
    solved again. ``progress`` shows a bar of tqdm, also in a notebook.

    A problem that raises is one outcome with an ``error``, and the others go on. If a process of
    ours dies, its problems are tried once more, in new processes. Ctrl-C, or closing the iterator,
    cancels what has not begun and waits for the rest.

    Raises a TypeError or InputError for wrong arguments. While it runs, raises an ExecutorLostError
    if the executor accepts no more work, and an OSError if the folder cannot be written to.

    >>> from glid_nb import Cage, Domain, Pose
    >>> domain = Domain.from_cage(Cage([[0, 0], [4, 0], [4, 2], [0, 2]]))
    >>> poses = [Pose([[1, 1], [3, 1]], [[1, 1], [3, y]]) for y in (1.2, 1.4)]
    >>> for one in solve_many([(domain, pose) for pose in poses]):
    ...     print(one.name, one.result.status.value, one.result.certificate.certified)
    problem 0 converged True
    problem 1 converged True
    """
    check_type("problems", problems, Iterable, "give a list of glid_nb.io.Problem, or a mapping")
    check_type("options", options, Options | None, "write Options(p2p_weight=...)")
    check_type("method", method, Method | None, "one of glid_nb.methods, such as LBFGS()")
    check_type("folder", folder, str | Path | None, "the folder that keeps the results")
    for name, value in (("check", check), ("progress", progress)):
        check_type(name, value, bool, "write True or False")
    method, energy = method_for(method, energy)
    if not method.certified:
        what = f"the maps of the method {method.name!r} have no certificate to travel with"
        raise MethodError(f"{what}; solve them one by one with glid_nb.solve")
    if folder is not None and isinstance(energy, CustomEnergy):
        what = "folder= finds results by a hash of the energy, and a function has none"
        raise InputError(f"{what}; leave folder= out, or register the energy as a class")
    bar = _bar_class() if progress else None
    run = _Run(
        energy=energy,
        options=options or Options(),
        method=method,
        pool=pool_for(executor, in_flight),
        folder=None if folder is None else Folder(path_of(folder)),
        check=check,
    )
    outcomes = run.outcomes(_named(problems))
    if bar is None:
        return outcomes
    return _shown(outcomes, bar, len(problems) if isinstance(problems, Sized) else None)


def _named(problems: Iterable[Any] | Mapping[Any, Any]) -> Iterator[tuple[int, str, Any]]:
    if isinstance(problems, Mapping):
        for index, (name, problem) in enumerate(problems.items()):
            yield index, str(name), problem
    else:
        for index, problem in enumerate(problems):
            yield index, f"problem {index}", problem


def _bar_class() -> Any:
    try:
        from tqdm.auto import tqdm  # noqa: PLC0415 - an optional package
    except ImportError:
        how = "pip install 'glid-nb[cluster]', or pip install tqdm"
        raise InputError(f"progress=True needs the package tqdm; install it with: {how}") from None
    return tqdm


def _shown(
    outcomes: Generator[Solved, None, None], bar_class: Any, total: int | None
) -> Generator[Solved, None, None]:
    bar, failed = bar_class(total=total, unit="pose"), 0
    try:
        for one in outcomes:
            failed += one.error is not None
            if failed:
                bar.set_postfix(failed=failed, refresh=False)
            bar.update()
            yield one
    finally:
        outcomes.close()
        bar.close()


@dataclass(eq=False)
class _Job:
    """A problem on its way."""

    index: int
    name: str
    plan: Plan
    pose: Pose
    losses: int = 0
    """How often its worker died."""
    age: int = 0
    """The pool's renewals before it was handed over."""
    equals: list["_Job"] = field(default_factory=list)
    """Equal problems, which wait for its answer."""

    @functools.cached_property
    def key(self) -> str:
        return self.plan.problem_key(self.pose)

    @property
    def goes_alone(self) -> bool:
        return self.losses > _TOGETHER


class _Run:
    """One call of `solve_many`."""

    def __init__(
        self,
        *,
        energy: Energy,
        options: Options,
        method: Method,
        pool: Pool,
        folder: Folder | None,
        check: bool,
    ) -> None:
        self._how = {"energy": energy, "options": options, "method": method}
        self._pool, self._folder, self._check = pool, folder, check
        self._by_domain = WeakValueDictionary[Domain, Plan]()
        self._plans = WeakValueDictionary[str, Plan]()
        self._again = deque[_Job]()  # whose workers died
        self._flying = dict[Future[Any], _Job]()
        self._first = dict[str, _Job]()  # by keys: of equal problems, the one that is solved
        self._waiting = 0  # how many others wait for those
        self._arrived = SimpleQueue[Future[Any]]()
        self._known = set[str]()  # keys of plans that a worker has
        self._renewals, self._answers = 0, 0

    def outcomes(self, given: Iterator[tuple[int, str, Any]]) -> Generator[Solved, None, None]:
        """Hand over problems while there is room, and yield what has arrived."""
        try:
            while True:
                while (job := self._next(given)) is not None:
                    if isinstance(job, Solved):
                        yield job
                    elif kept := self._kept(job):
                        yield from kept
                    elif not self._joined(job):
                        self._send(job)
                if not self._flying:
                    return
                yield from self._arrivals(self._next_arrived())
        finally:
            for future in self._flying:
                future.cancel()
            self._pool.close()

    def _next(self, given: Iterator[tuple[int, str, Any]]) -> _Job | Solved | None:
        """The next problem to hand over, or its error; None if there is no room or no problem."""
        if len(self._flying) + self._waiting >= self._pool.in_flight:
            return None
        if any(job.goes_alone for job in self._flying.values()):
            return None
        if self._again:
            waits = self._again[0].goes_alone and self._flying
            return None if waits else self._again.popleft()
        for index, name, problem in given:
            try:
                domain, pose = _parts(problem)
            except TypeError as error:
                return Solved(index, name, None, _error(name, error))
            return _Job(index, name, self._plan(domain), pose)
        return None

    def _plan(self, domain: Domain) -> Plan:
        """The plan of a domain; one for all domains that are equal."""
        if (known := self._by_domain.get(domain)) is None:
            made = Plan(domain, **self._how)
            known = self._by_domain[domain] = self._plans.setdefault(made.key, made)
        return known

    def _kept(self, job: _Job) -> list[Solved]:
        """The outcomes of a problem and its equals if its answer is in the folder; none if it is
        not there, damaged, or not certified."""
        if self._folder is None or (data := self._folder.read(job.key)) is None:
            return []
        try:
            return self._solved(job, data, kept=True)
        except InputError:
            return []

    def _joined(self, job: _Job) -> bool:
        """Whether an equal problem is under way, for whose answer this one now waits."""
        first = self._first.setdefault(job.key, job)
        if first is job:
            return False
        first.equals.append(job)
        self._waiting += 1
        return True

    def _solved(self, job: _Job, data: Any, *, kept: bool = False) -> list[Solved]:
        """The outcomes of a problem and its equals, by an answer. Raises as `received` does."""
        results = [received(data, one.plan, one.pose, self._check) for one in (job, *job.equals)]
        ended = self._ended(job)
        return [
            Solved(one.index, one.name, result, None, kept=kept)
            for one, result in zip(ended, results, strict=True)
        ]

    def _failed(self, job: _Job, error: Exception, whose: str = "") -> list[Solved]:
        """The outcomes of a problem and its equals, by an error."""
        return [
            Solved(one.index, one.name, None, _error(one.name, error, whose))
            for one in self._ended(job)
        ]

    def _ended(self, job: _Job) -> list[_Job]:
        """A problem and its equals, which are no longer under way."""
        self._first.pop(job.key, None)
        self._waiting -= len(job.equals)
        return [job, *job.equals]

    def _send(self, job: _Job, with_plan: bool = False) -> None:
        plan, pool = None, self._pool
        if pool.is_here:
            plan = job.plan
        elif with_plan or job.plan.key not in self._known:
            plan = job.plan.packed
        sent = worker.work, job.plan.key, plan, worker.packed(job.pose), worker.HERE
        try:
            future = pool.submit(*sent)
        except Exception as error:
            if not (is_loss(error) and self._renewed(self._renewals, error)):
                raise
            future = pool.submit(*sent)
        job.age = self._renewals
        self._flying[future] = job
        future.add_done_callback(self._arrived.put)

    def _next_arrived(self) -> Future[Any]:
        while True:
            try:
                return self._arrived.get(timeout=_POLL)
            except Empty:
                continue

    def _arrivals(self, future: Future[Any]) -> list[Solved]:
        """What a future has brought; nothing if its problem is under way again."""
        job = self._flying.pop(future)
        try:
            data = future.result()
        except Exception as error:
            return self._after(error, job)
        self._answers += 1
        if data == worker.NO_PLAN:
            self._send(job, with_plan=True)
            return []
        self._known.add(job.plan.key)
        try:
            outcomes = self._solved(job, data)
        except (ProblemError, DamagedError) as error:
            return self._failed(job, error)
        if self._folder is not None:
            self._folder.write(job.key, data)
        return outcomes

    def _after(self, error: Exception, job: _Job) -> list[Solved]:
        """What follows from a future that failed: the worker itself returns errors as answers."""
        if not is_loss(error):
            return self._failed(job, error, "its worker: ")
        was_alone = job.goes_alone
        job.losses += 1
        if not self._renewed(job.age, error) and job.losses > 1:
            raise lost(error) from error
        if was_alone:
            what = f"its process died {job.losses} times, at last with no other problem under way"
            return self._failed(job, ProblemError(f"{what}; is there enough memory?"))
        self._again.append(job)
        return []

    def _renewed(self, age: int, error: BaseException) -> bool:
        """Replace the processes, unless that was done since. False for a caller's executor."""
        if age < self._renewals:
            return True
        if self._renewals and not self._answers:
            what = "the processes end before they answer anything"
            guard = "a script needs `if __name__ == '__main__':` around what it runs"
            raise ExecutorLostError(f"{what} ({type(error).__name__}: {error}); {guard}") from error
        if not self._pool.renew():
            return False
        self._renewals += 1
        self._known.clear()
        return True


def _parts(problem: Any) -> tuple[Domain, Pose]:
    """Domain and pose of a problem. Raises a TypeError for anything else."""
    if isinstance(problem, tuple) and len(problem) == 2:
        domain, pose = problem
    else:
        domain, pose = getattr(problem, "domain", None), getattr(problem, "pose", None)
    if not (isinstance(domain, Domain) and isinstance(pose, Pose)):
        wanted = "a problem must be a glid_nb.io.Problem or a pair (domain, pose)"
        raise TypeError(f"{wanted}, not {type(problem).__name__}")
    return domain, pose


def _error(name: str, error: BaseException, whose: str = "") -> ProblemError:
    """An error with the problem's name in front."""
    text = " ".join(str(error).split())
    if not isinstance(error, InputError | TypeError) or whose:
        text = f"{whose}{type(error).__name__}{': ' * bool(text)}{text}"
    made = ProblemError(f"{name}: {text}", getattr(error, "kind", ""))
    for note in getattr(error, "__notes__", ()):
        made.add_note(note)
    made.__cause__ = error
    return made
