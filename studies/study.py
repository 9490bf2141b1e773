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
    """What all studies of a run are told."""

    references: Mapping[str, Case] = field(default_factory=dict)
    """Problems from files, by name; without them the bundled samples are measured."""
    repeats: int = 9
    quick: bool = False
    """Small sizes only, to see that everything runs."""
    detail: Callable[[str], None] = lambda _: None
    """Told what is being done."""

    def case(self, name: str) -> Case:
        """The problem of a name, or of a sample's name and pose such as ``gecko-extreme``."""
        if name in self.references:
            return self.references[name]
        sample, _, kind = name.rpartition("-")
        return sample_case(sample, "extreme" if kind == "extreme" else "gentle")


class Task(NamedTuple):
    """One measurement of a study."""

    name: str
    of: str
    """What is measured: a problem's digest, the settings."""
    measure: Callable[[], Measurement]


@dataclass(frozen=True)
class Study:
    """Measurements, and the tables and figures made of them.

    ``tasks`` lists what is to be measured; ``tables`` turns all measurements that there are into
    tables by name, and ``draw`` into figures in a folder.
    """

    name: str
    tasks: Callable[[Plan], Sequence[Task]]
    tables: Callable[[list[Measurement]], Mapping[str, Sequence[Row]]] = lambda _: {}
    draw: Callable[[list[Measurement], Path], None] = lambda *_: None


def on_cases(
    names: Callable[[Plan], Sequence[str]], measure: Callable[[Case, Plan], Measurement]
) -> Callable[[Plan], list[Task]]:
    """The tasks of a study that measures one case after the other."""

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

    Measurements are kept in ``out/data``. What is there already is not measured again, unless the
    problem, the settings or the machine differ, or with ``fresh``. ``only`` names the studies to
    measure; tables and figures are made of all measurements that there are. Returns the page. A
    StudyError for an unknown study, or a measurement that fails.
    """
    known = [study.name for study in studies]
    for name in only or ():
        if name not in known:
            raise StudyError(f"unknown study {name!r}; choose of {', '.join(known)}")
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
