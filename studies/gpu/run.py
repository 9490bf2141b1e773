"""The parts of the study, each with its share of the time, and the tables made of them."""

import importlib.util
import json
import re
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

from glid_nb.samples import names
from studies.cases import reference_cases
from studies.gpu.tables import tables
from studies.processes import Printed, StudyError, in_new_process, printed_by
from studies.store import Measurement, Store
from studies.tables import update_page, write_csv

SECONDS = 480.0
"""The time limit of the whole study; every part has a share of it."""
SHARES = {
    ("solves", "device"): 0.3,
    ("solves", "cpu"): 0.2,
    ("batches", "device"): 0.2,
    ("batches", "cpu"): 0.06,
    ("tests", "device"): 0.18,
}
"""Each part's largest share of the time, in running order. The rest is for starting."""

SIZES = (1, 4, 16, 64, 256, 1024, 4096)
LOCKSTEP = (1, 4, 16, 64, 256)
TESTS = ("energies", "certificate", "harmonic", "solvers", "methods", "motion")
"""Folders of tests; the fast tests in them run on the device."""

_TESTS = Path(__file__).resolve().parents[2] / "tests"
_MOST_PROCESSES = 4
_STAGES_OF = 2  # shapes whose stages are timed; each stage is another program to compile
_MACHINE = """
import json
import jax
from studies.machine import machine
print(json.dumps({**machine(), "platform": jax.default_backend()}))
"""
_SEVERAL = re.compile(r"\[gw\d+\].* (PASSED|FAILED|ERROR|SKIPPED) (\S+::.*\S)")
_ONE = re.compile(r"(\S+::.*\S) (PASSED|FAILED|ERROR|SKIPPED)\b")


@dataclass(frozen=True)
class GpuPlan:
    """The settings of all parts. ``platform`` is "gpu", or "cpu" for a trial."""

    platform: str = "gpu"
    reference: Path | None = None
    seconds: float = SECONDS
    repeats: int = 9
    quick: bool = False
    detail: Callable[[str], None] = field(default=lambda _: None)

    @property
    def shapes(self) -> list[str]:
        """The reference shapes, then the samples' poses. Batches use the first one."""
        named = [] if self.reference is None else list(reference_cases(self.reference))
        named.sort(key=lambda name: name != "rex")
        samples = [f"{name}-{kind}" for kind in ("gentle", "extreme") for name in names()]
        return [*named, *samples][: 1 if self.quick else None]

    def environment(self, device: str) -> dict[str, str]:
        """Environment variables of a process on the GPU, or on the CPU of its machine."""
        on_cpu = device == "cpu" or self.platform == "cpu"
        return {"JAX_PLATFORMS": "cpu"} if on_cpu else {}


Part = Callable[[GpuPlan, str, float], Measurement]
"""Measures a part on a device, ``"device"`` or ``"cpu"``, within a number of seconds."""


def solves(plan: GpuPlan, device: str, limit: float) -> Measurement:
    """Solves of each shape: results and times."""
    shapes = plan.shapes
    given = {
        "shapes": shapes,
        "stages": _STAGES_OF,
        "repeats": plan.repeats,
        "reference": _text(plan.reference),
    }
    return lines_of(printed_by(["-m", "studies.gpu.solving"], given, limit, **_on(plan, device)))


def batches(plan: GpuPlan, device: str, limit: float) -> Measurement:
    """Batches of poses of one shape."""
    given = {
        "shape": plan.shapes[0],
        "reference": _text(plan.reference),
        "sizes": SIZES[:2] if plan.quick else SIZES,
        # The CPU runs no lockstep batches; a trial runs one size, to test the lines.
        "lockstep": LOCKSTEP[: 1 if plan.quick else None] if device == "device" else [],
        "seconds": limit,
    }
    return lines_of(printed_by(["-m", "studies.gpu.batches"], given, limit, **_on(plan, device)))


def tests(plan: GpuPlan, device: str, limit: float) -> Measurement:
    """The fast tests of the layers that compute; those that end within the time count."""
    folders = TESTS[:1] if plan.quick else TESTS
    # Several processes share the GPU, if pytest-xdist is installed.
    several = importlib.util.find_spec("xdist") is not None and not plan.quick
    words = ["-v", "-m", "not slow and not browser", "-p", "no:cacheprovider", "-p", "no:nbval"]
    words += ["-n", str(_MOST_PROCESSES)] if several else []
    where = [str(_TESTS / folder) for folder in folders]
    printed = printed_by(["-m", "pytest", *words, *where], None, limit, **_on(plan, device))
    outcomes = outcomes_of(printed.lines)
    rows = []
    for folder in folders:
        own = {name: how for name, how in outcomes.items() if f"tests/{folder}/" in name}
        failing = sorted(name for name, how in own.items() if how in ("FAILED", "ERROR"))
        passed = list(own.values()).count("PASSED")
        rows.append({"folder": folder, "passed": passed, "failing": failing})
    # Exit code 1 means that tests fail; the table names them.
    ended = "" if printed.ending.startswith("ended with exit code 1:") else printed.ending
    return {"rows": rows, "seconds": printed.seconds, "ended": ended}


def outcomes_of(lines: Sequence[str]) -> dict[str, str]:
    """How each test ended, read from the lines of ``pytest -v``, with or without xdist."""
    found = dict[str, str]()
    for line in lines:
        if said := _SEVERAL.search(line):
            found[said[2]] = said[1]
        elif said := _ONE.match(line):
            found[said[1]] = said[2]
    return found


PARTS: dict[str, Part] = {"solves": solves, "batches": batches, "tests": tests}


def run(out: Path, plan: GpuPlan, only: Sequence[str] | None, fresh: bool, measuring: bool) -> Path:
    """Measure on the GPU, then on the CPU; returns the page of the tables.

    Tables are written after every part, so that a stop loses little. A trial on the CPU writes
    tables named ``trial-*``, for which no page has a place. Raises a StudyError for an unknown
    part, or if JAX finds no GPU.
    """
    for name in only or ():
        if name not in PARTS:
            raise StudyError(f"unknown study {name!r}; choose one of {', '.join(PARTS)}")
    if plan.repeats < 1 or plan.seconds <= 0:
        raise StudyError(
            f"repeats is {plan.repeats} and seconds is {plan.seconds:g}; both must be positive"
        )
    prefix = "gpu" if plan.platform == "gpu" else "trial"
    store = Store(out / "data", {}, fresh)
    if measuring:
        plan.detail("the machine")
        store.here = machine(plan)
        began = time.perf_counter()
        store.get(f"{prefix}-machine", "", dict)
        for (name, device), share in SHARES.items():
            if only and name not in only:
                continue
            limit = min(share * plan.seconds, plan.seconds - (time.perf_counter() - began))
            plan.detail(f"{name}, {device}, {limit:.0f} s at most")
            of = f"{plan.shapes}, repeats {plan.repeats}, quick {plan.quick}"
            measure = partial(PARTS[name], plan, device, max(limit, 1.0))
            store.get(f"{prefix}-{name}-{device}", of, measure)
            _write(out, prefix, store)
    return _write(out, prefix, store)


def machine(plan: GpuPlan) -> Measurement:
    """The machine and its GPU; raises a StudyError if JAX finds no GPU."""
    found = in_new_process("-c", _MACHINE, None, **_on(plan, "device"))
    if found["platform"] != plan.platform:
        versions = found["versions"]
        raise StudyError(
            f"jax {versions['jax']} with jaxlib {versions['jaxlib']} finds no GPU here, only "
            f"{', '.join(found['devices'])}; install jax[cuda13] of the same version, or try the "
            "study out with --platform cpu"
        )
    return found


def _on(plan: GpuPlan, device: str) -> dict[str, str]:
    return plan.environment(device)


def _text(path: Path | None) -> str | None:
    return None if path is None else str(path)


def lines_of(printed: Printed) -> Measurement:
    # If the process was stopped, its last line may be cut off.
    whole = [line for line in printed.lines if line.endswith("\n") and line.startswith("{")]
    rows = [json.loads(line) for line in whole]
    return {"rows": rows, "seconds": printed.seconds, "ended": printed.ending}


def _write(out: Path, prefix: str, store: Store) -> Path:
    """Write all tables of the measurements so far."""
    kept = {name: store.kept(f"{prefix}-{name}") for name in _kept_names()}
    found = {name: value for name, value in kept.items() if value is not None}
    out.mkdir(parents=True, exist_ok=True)
    for name, rows in tables(found).items():
        write_csv(out / f"{prefix}-{name}.csv", rows)
    page = out.with_name(out.name + ".md")
    update_page(page, out)
    return page


def _kept_names() -> list[str]:
    return ["machine", *(f"{name}-{device}" for name, device in SHARES)]
