"""Measure the solver's speed on this machine.

Times the paper's settings and ours on the same problems, drag steps, cold and warm starts, growth
with sizes, and batches, and writes OUT.md with figures and the raw measurements in the folder OUT.
A run that was interrupted goes on where it stopped. On a machine with a GPU, after `pip install
"jax[cuda12]"`, the same command measures it.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

import glid_nb
from glid_nb.cli.errors import CommandError
from glid_nb.cli.output import check_folder
from glid_nb.cli.progress import Progress
from studies.benchmarks import bench_all, render


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command."""
    parser = argparse.ArgumentParser(prog="python -m studies.benchmarks", description=__doc__)
    parser.add_argument(
        "--out",
        type=Path,
        default=Path("glid-nb-benchmarks"),
        metavar="OUT",
        help="folder of the figures; the page is OUT.md (default: %(default)s)",
    )
    parser.add_argument(
        "--reference",
        type=Path,
        metavar="DIR",
        help="folder of problems to solve (default: the bundled samples)",
    )
    parser.add_argument(
        "--only",
        action="append",
        metavar="PART",
        help="one part, may be repeated (default: all): solves, drags, start, compilations, "
        "scaling or batches",
    )
    parser.add_argument(
        "--repeats", type=int, default=9, metavar="N", help="timings of each kind (default 9)"
    )
    parser.add_argument("--quick", action="store_true", help="small sizes only, to try it out")
    parser.add_argument("--fresh", action="store_true", help="measure again what is there already")
    parser.add_argument(
        "--render",
        action="store_true",
        help="measure nothing: write the page and the figures from the measurements in OUT",
    )
    chosen = parser.parse_args(arguments)

    check_folder(chosen.out)
    if chosen.render:
        for name in ("reference", "only", "quick", "fresh"):
            if getattr(chosen, name):
                raise CommandError(f"--render measures nothing; leave out --{name}")
        print(render(chosen.out))
        return
    glid_nb.enable_compilation_cache()
    with Progress().step("measuring") as detail:
        page = bench_all(
            chosen.out,
            chosen.reference,
            only=chosen.only,
            repeats=chosen.repeats,
            quick=chosen.quick,
            fresh=chosen.fresh,
            detail=detail,
        )
    print(page)


if __name__ == "__main__":
    main()
