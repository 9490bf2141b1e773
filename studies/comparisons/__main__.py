"""Compare the solver with the methods that the paper compares itself with.

Measures them on the same problems, draws the paper's figures and writes a page that says which of
its claims are reproduced: OUT.md, with the figures and the raw measurements in the folder OUT. A
run that was interrupted goes on where it stopped. SLIM and the bounded distortion maps need the
optional packages of `pip install "glid-nb[compare]"`.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

import glid_nb
from glid_nb.cli.output import check_folder
from glid_nb.cli.progress import Progress
from studies.comparisons import compare_all


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command."""
    parser = argparse.ArgumentParser(prog="python -m studies.comparisons", description=__doc__)
    parser.add_argument(
        "--out",
        type=Path,
        default=Path("glid-nb-comparisons"),
        metavar="OUT",
        help="folder of the figures; the page is OUT.md (default: %(default)s)",
    )
    parser.add_argument(
        "--reference",
        type=Path,
        metavar="DIR",
        help="folder of problems with the paper's shapes (default: the bundled samples)",
    )
    parser.add_argument(
        "--only",
        action="append",
        metavar="EXPERIMENT",
        help="one experiment, may be repeated (default: all): progress, iteration-times, bounded, "
        "conformal, exponential, lipschitz, hessian-samples, stages or folding",
    )
    parser.add_argument("--fresh", action="store_true", help="measure again what is there already")
    chosen = parser.parse_args(arguments)

    check_folder(chosen.out)
    glid_nb.enable_compilation_cache()
    with Progress().step("comparing") as detail:
        page = compare_all(
            chosen.out, chosen.reference, only=chosen.only, fresh=chosen.fresh, detail=detail
        )
    print(page)


if __name__ == "__main__":
    main()
