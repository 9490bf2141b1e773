"""What a study is, and how several of them are run."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from studies.cases import Case, sample_case
from studies.machine import machine
from studies.processes import StudyError
from studies.store import Measurement, Store
from studies.tables import Row, update_page, write_csv


@dataclass
class Plan:
    """The settings of a run, for all its studies."""

    references: Mapping[str, Case] = field(default_factory=dict)
    """Problems from files, by name. If there are none, the bundled samples are measured."""
    repeats: int = 9
    quick: bool = False
    """Small sizes only, to test that everything runs."""
    detail: Callable[[str], None] = lambda _: None
    """Called with the name of each step."""

    def case(self, name: str) -> Case:
        """The reference problem of this name, or a sample with a pose such as ``gecko-extreme``."""
        if name in self.references:
            return self.references[name]
        sample, _, kind = name.rpartition("-")
        return sample_case(sample, "extreme" if kind == "extreme" else "gentle")


class Task(NamedTuple):
    """One measurement of a study."""

    name: str
    of: str
    """The problem's digest and the settings."""
    measure: Callable[[], Measurement]


@dataclass(frozen=True)
class Study:
    """Measurements, and the tables and figures made of them.

    ``tasks`` lists the measurements to take. ``tables`` makes tables, by name, of all existing
    measurements; ``draw`` draws figures of them into a folder.
    """

    name: str
    tasks: Callable[[Plan], Sequence[Task]]
    tables: Callable[[list[Measurement]], Mapping[str, Sequence[Row]]] = lambda _: {}
    draw: Callable[[list[Measurement], Path], None] = lambda *_: None


def on_cases(
    names: Callable[[Plan], Sequence[str]], measure: Callable[[Case, Plan], Measurement]
) -> Callable[[Plan], list[Task]]:
    """The tasks of a study with one measurement for each case."""

    def tasks(plan: Plan) -> list[Task]:
        def task(case: Case) -> Task:
            of = f"{case.digest}, repeats {plan.repeats}, quick {plan.quick}"
            return Task(case.name, of, lambda: {"name": case.name, **measure(case, plan)})

        return [task(plan.case(name)) for name in names(plan)]

    return tasks


def run_studies(
    studies: Sequence[Study],
    out: Path,
    plan: Plan,
    *,
    only: Sequence[str] | None = None,
    fresh: bool = False,
    measuring: bool = True,
) -> Path:
    """Measure; write tables and figures into ``out``, the tables into ``out.md`` and ``out-*.md``.

    Measurements are kept in ``out/data``. An existing measurement is repeated only with ``fresh``,
    or if the problem, the settings or the machine differ. ``only`` names the studies to measure;
    tables and figures show all existing measurements. Returns the page. Raises a StudyError for
    an unknown study, or if a measurement fails.
    """
    known = [study.name for study in studies]
    for name in only or ():
        if name not in known:
            raise StudyError(f"unknown study {name!r}; choose one of {', '.join(known)}")
    if plan.repeats < 1:
        raise StudyError(f"repeats is {plan.repeats}; it must be at least 1")
    store = Store(out / "data", machine(), fresh)
    for study in studies if measuring else ():
        if only and study.name not in only:
            continue
        for task in study.tasks(plan):
            plan.detail(f"{study.name}: {task.name}")
            store.get(f"{study.name}-{task.name}", task.of, task.measure)
    out.mkdir(parents=True, exist_ok=True)
    for study in studies:
        if found := store.all(study.name):
            study.draw(found, out)
            for name, rows in study.tables(found).items():
                write_csv(out / f"{name}.csv", rows)
    page = out.with_name(out.name + ".md")
    for each in (page, *out.parent.glob(f"{out.name}-*.md")):
        update_page(each, out)
    return page
