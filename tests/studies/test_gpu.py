"""The study on a GPU, run from end to end on the CPU. No number is judged here."""

from __future__ import annotations

import csv
import os
import select
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest

from glid_nb import InputError
from studies.__main__ import main
from studies.gpu import run
from studies.gpu.run import SHARES, GpuPlan
from studies.gpu.tables import tables
from studies.processes import StudyError, printed_by

pytestmark = pytest.mark.slow

DOCS = Path(__file__).resolve().parents[2] / "docs"


def table(path: Path) -> list[dict[str, str]]:
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


@pytest.mark.timeout(900)
def test_the_study_runs_from_end_to_end(problems: Path, tmp_path: Path) -> None:
    out = tmp_path / "gpu"
    words = ["gpu", "--platform", "cpu", "--quick", "--repeats", "1", "--seconds", "1500"]
    main([*words, "--reference", str(problems), "--out", str(out)])
    (row,) = table(out / "trial-agreement.csv")
    assert (row["shape"], row["same"], row["certified, device / CPU"]) == (
        "bar",
        "yes",
        "True / True",
    )
    (row,) = table(out / "trial-solves.csv")
    assert all(float(n) > 0 for n in row["iteration, ms, device / CPU"].split(" / "))
    rows = table(out / "trial-stages.csv")
    assert [row["on"] for row in rows] == ["device", "cpu"]
    assert all(float(row["factor, ms"]) > 0 and int(row["operations"]) > 0 for row in rows)
    rows = table(out / "trial-batches.csv")
    assert [row["poses"] for row in rows] == ["one by one", "1", "4"]
    assert [row["certified, device"] for row in rows[1:]] == ["1", "4"]
    (row,) = table(out / "trial-lockstep.csv")
    assert float(row["the call, ms"]) <= float(row["with the host, ms"])
    (row,) = table(out / "trial-tests.csv")
    assert int(row["passed"]) > 0
    assert row["failed"] == "0"
    parts = {row[""]: row["what"] for row in table(out / "trial-machine.csv")}
    assert all(parts[f"{name}-{device}"].endswith("complete") for name, device in SHARES)
    assert "trial-agreement" in (tmp_path / "gpu.md").read_text()


def test_a_stopped_process_leaves_what_it_has_printed() -> None:
    began = time.perf_counter()
    script = "import time\nprint('{}', flush=True)\nprint('{', end='', flush=True)\ntime.sleep(60)"
    printed = printed_by(["-c", script], None, 10.0)
    assert time.perf_counter() - began < 50
    assert printed.ending == "stopped after 10 s"
    assert printed.lines == ["{}\n", "{"]
    assert run.lines_of(printed)["rows"] == [{}]


@pytest.mark.skipif(sys.platform == "win32", reason="there are no sessions of processes")
def test_what_a_stopped_process_has_started_is_stopped_too() -> None:
    script = (
        "import subprocess, sys, time\n"
        "child = subprocess.Popen([sys.executable, '-c', 'import time; time.sleep(600)'])\n"
        "print(child.pid, flush=True)\ntime.sleep(600)"
    )
    printed = printed_by(["-c", script], None, 10.0)  # else it would wait for the child's output
    (line,) = printed.lines
    assert printed.seconds < 60
    try:
        child = os.pidfd_open(int(line))
    except ProcessLookupError:  # gone already
        return
    assert select.select([child], [], [], 60)[0], "it still runs"


def test_a_process_that_fails_says_why() -> None:
    printed = printed_by(["-c", "print('{}')\nraise SystemExit('no such device')"], None, 60.0)
    assert printed.lines == ["{}\n"]
    assert printed.ending == "ended with exit code 1: no such device"
    # Also if it ends before it has read all of its input.
    printed = printed_by(["-c", "raise SystemExit('no such device')"], "x" * 1_000_000, 60.0)
    assert printed.ending == "ended with exit code 1: no such device"


def test_without_a_gpu_one_sentence_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("JAX_PLATFORMS", "cpu")
    with pytest.raises(StudyError, match=r"^jax \S+ with jaxlib \S+ finds no GPU here, only cpu"):
        main(["gpu", "--out", str(tmp_path / "gpu")])
    assert not (tmp_path / "gpu").exists()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--only", "hope"], "unknown study 'hope'; choose one of solves, batches, tests"),
        (["--repeats", "0"], "repeats is 0 and seconds is 480; both must be positive"),
        (["--seconds", "0"], "repeats is 9 and seconds is 0; both must be positive"),
    ],
)
def test_what_is_refused(tmp_path: Path, words: list[str], said: str) -> None:
    with pytest.raises(InputError, match=said):
        main(["gpu", *words, "--out", str(tmp_path / "gpu")])
    assert not (tmp_path / "gpu").exists()


def test_the_parts_fit_into_the_time() -> None:
    assert sum(SHARES.values()) <= 0.95
    assert run.SECONDS <= 480


def test_on_a_gpu_only_the_cpus_processes_are_told_their_platform() -> None:
    plan = GpuPlan(platform="gpu")
    assert plan.environment("device") == {}
    assert plan.environment("cpu") == {"JAX_PLATFORMS": "cpu"}
    assert GpuPlan(platform="cpu").environment("device") == {"JAX_PLATFORMS": "cpu"}


def test_outcomes_are_read_from_what_pytest_prints() -> None:
    lines = [
        "tests/energies/test_energies.py::test_one[iso-1.0 2] PASSED  [  8%]\n",
        "[gw3] [ 12%] FAILED tests/solvers/test_pose.py::test_two \n",
        "tests/energies/test_energies.py::test_that_is_still_running \n",
        "FAILED tests/solvers/test_pose.py::test_two - assert 1 == 2\n",
    ]
    assert run.outcomes_of(lines) == {
        "tests/energies/test_energies.py::test_one[iso-1.0 2]": "PASSED",
        "tests/solvers/test_pose.py::test_two": "FAILED",
    }


def test_energies_that_differ_are_said_to() -> None:
    def line(energy: float) -> dict:
        known = {"found": "bar", "status": "converged", "certified": True, "k": 0.5}
        return {**known, "energy": energy, "iterations": 3, "unknowns": 10, "panels": 20}

    def rows(energy: float) -> dict:
        return {"rows": [line(energy)], "seconds": 1.0, "ended": ""}

    for energy, same in ((2.0 + 1e-9, "yes"), (2.0 + 1e-7, "no")):
        (row,) = tables({"solves-device": rows(energy), "solves-cpu": rows(2.0)})["agreement"]
        assert row["same"] == same
    # One device alone gives a table, too: the study was stopped before the other.
    (row,) = tables({"solves-device": rows(2.0)})["agreement"]
    assert row["same"] is None


def test_the_page_has_a_place_for_every_table() -> None:
    page = (DOCS / "benchmarks.md").read_text(encoding="utf-8")
    for name in ("machine", "agreement", "solves", "stages", "batches", "lockstep", "tests"):
        assert f"<!-- table: gpu-{name} -->" in page


@pytest.mark.skipif(sys.platform == "win32", reason="a shell script")
def test_the_script_names_what_is_missing(tmp_path: Path) -> None:
    """With a Python without the libraries, and without a folder of wheels."""
    root = tmp_path / "checkout"
    (root / "tools").mkdir(parents=True)
    shutil.copy(DOCS.parent / "tools" / "gpu.sh", root / "tools")
    python = tmp_path / "python"
    python.write_text(f'#!/bin/sh\nexec "{sys.executable}" -I -S "$@"\n')
    python.chmod(0o755)
    run = subprocess.run(
        [root / "tools" / "gpu.sh"],
        env={**os.environ, "PYTHON": str(python)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 1
    (line,) = run.stderr.splitlines()
    assert f"{python} lacks jax numpy scipy" in line
    assert "tools/gpu.sh wheels jax numpy" in line
