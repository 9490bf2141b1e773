"""Measure, and write tables and figures: ``python -m studies compare``, ``bench``, ``gpu``, ...

``bench`` times the solver on this machine: the paper's settings and ours, drag steps, first solves,
growth with size, batches. ``compare`` measures the other methods on the same problems and
reproduces the paper's figures; SLIM and the bounded distortion maps need the extra ``compare``.
``motion`` measures the numbers of docs/motion.md, ``live`` those of docs/howto/live.md. ``gpu``
measures the solver on a GPU and on the CPU of the same machine, within ``--seconds``.

Tables (CSV) and figures go into the folder OUT, the raw measurements into OUT/data. The tables of
the page OUT.md are replaced; its text stays unchanged. An interrupted run continues where it
stopped.
"""

import argparse
import importlib
from collections.abc import Sequence
from pathlib import Path

import glid_nb
from glid_nb.cli.output import check_folder, step
from studies.cases import reference_cases
from studies.gpu.run import GpuPlan, run
from studies.study import Plan, run_studies


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command."""
    parser = argparse.ArgumentParser(
        prog="python -m studies",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add = parser.add_argument
    add("what", choices=("compare", "bench", "motion", "live", "gpu"))
    add("--out", type=Path, metavar="OUT", help="default: glid-nb-WHAT")
    shapes = "folder of problems with the paper's shapes (default: the bundled samples)"
    add("--reference", type=Path, metavar="DIR", help=shapes)
    one = "one study, may be repeated (default: all)"
    add("--only", action="append", metavar="STUDY", help=one)
    add("--repeats", type=int, default=9, metavar="N", help="timings of each kind (default 9)")
    add("--quick", action="store_true", help="small sizes only, for a trial")
    add("--seconds", type=float, default=480.0, metavar="S", help="gpu: at most (default 480)")
    trial = "gpu: with cpu, a trial run without a GPU"
    add("--platform", choices=("gpu", "cpu"), default="gpu", help=trial)
    how = parser.add_mutually_exclusive_group()
    how.add_argument("--fresh", action="store_true", help="repeat measurements that exist")
    nothing = "measure nothing; make tables and figures from OUT/data"
    how.add_argument("--render", action="store_true", help=nothing)
    chosen = parser.parse_args(arguments)
    out = chosen.out or Path(f"glid-nb-{chosen.what}")
    check_folder(out)
    if chosen.what == "gpu":
        print(_on_gpu(chosen, out))
        return
    studies = importlib.import_module(f"studies.{chosen.what}").STUDIES
    cases = {} if chosen.reference is None else reference_cases(chosen.reference)
    glid_nb.enable_compilation_cache()
    with step("measuring") as detail:
        plan = Plan(cases, chosen.repeats, chosen.quick, detail)
        page = run_studies(
            studies, out, plan, only=chosen.only, fresh=chosen.fresh, measuring=not chosen.render
        )
    print(page)


def _on_gpu(chosen: argparse.Namespace, out: Path) -> Path:
    with step("measuring") as detail:
        plan = GpuPlan(
            platform=chosen.platform,
            reference=chosen.reference,
            seconds=chosen.seconds,
            repeats=chosen.repeats,
            quick=chosen.quick,
            detail=detail,
        )
        return run(out, plan, chosen.only, fresh=chosen.fresh, measuring=not chosen.render)


if __name__ == "__main__":
    main()
