"""Solve a problem given as a file, and write the map and a report.

PROBLEM.json is an object with the keys cage, holes, handles and targets (world coordinates). The
keys offset, offset_cage, offset_holes, hole_points, angles, scales and weights (of the handles) are
optional. image_size_px and depths are copied into the map. Without --report only the map is
written, without --out only the report. For many problems, both are folders, and a problem that
fails does not stop the others. One of them may be `-`, standard output.

--jobs 4 solves many problems in processes, --scheduler on the workers of dask. Then each result is
one line, and --summary writes a table of all.
"""

import argparse
import itertools
from pathlib import Path

import glid_nb
from glid_nb._errors import InputFileError, about
from glid_nb._json import json_text, picture_size, read_object
from glid_nb.certificate.certify import proof_text
from glid_nb.cli.flags import add_solver_flags, energy_of, options_of
from glid_nb.cli.jobs import add_job_flags, has_job_flags, solve_jobs
from glid_nb.cli.many import destination, for_each, planned
from glid_nb.cli.output import STANDARD_OUTPUT, check_files, finish, map_text, run_solver


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    problem = "the file of a problem, or several"
    add("problem", type=Path, nargs="+", metavar="PROBLEM.json", help=problem)
    add("--out", type=destination, metavar="map.json", help="file for the map")
    proof = "file for the proof, for glid-check map.json proof.json"
    add("--proof", type=destination, metavar="proof.json", help=proof)
    add("--report", type=destination, metavar="report.json", help="file for the report")
    start = "a certified map of the same domain to start from (default: see --align)"
    add("--start", type=Path, metavar="map.json", help=start)
    refine = "solve again with finer bases until that lowers the energy by less than 1 %%"
    add("--refine", action="store_true", help=refine)
    add("--json", action="store_true", help="print the summary as JSON")
    add_job_flags(parser)
    add_solver_flags(parser)


def run(chosen: argparse.Namespace) -> None:
    problems: list[Path] = chosen.problem
    flags = {"--out": chosen.out, "--proof": chosen.proof, "--report": chosen.report}
    standard = [flag for flag, to in flags.items() if to and to.path is STANDARD_OUTPUT]
    if len(standard) > 1 or (standard and chosen.json):
        both = " and ".join([*standard, *(["--json"] if chosen.json else [])])
        raise InputFileError(f"{both} would share standard output; name a file for one of them")
    results = [planned(problems, flag, to, ".json") for flag, to in flags.items()]
    check_files(itertools.chain(*results), [*problems, chosen.start])
    outs, proofs, reports = results
    if has_job_flags(chosen):
        if standard:
            raise InputFileError(f"{standard[0]} -: each result is a line there; name a folder")
        solve_jobs(problems, outs, proofs, reports, chosen)
        return
    for_each(
        problems,
        lambda i: _solve(problems[i], outs[i], proofs[i], reports[i], chosen),
        chosen.debug,
    )


def _solve(
    path: Path, out: Path | None, proof: Path | None, told: Path | None, chosen: argparse.Namespace
) -> None:
    data = read_object(path)
    with about(path):
        problem = glid_nb.io.Problem.from_dict(data)
        if (size := data.get("image_size_px")) is not None:
            size = picture_size(size, "image_size_px")
    energy, options = energy_of(chosen), options_of(chosen)
    start = glid_nb.HarmonicMap.load(chosen.start) if chosen.start else None
    with about(chosen.start or path):
        what = problem.domain, problem.pose, energy, options, start, chosen.refine
        result, report = run_solver(*what)
    assert isinstance(result.map, glid_nb.HarmonicMap)
    files: dict[Path, bytes | str] = {}
    if out:
        files[out] = map_text(result.map, size, problem.pose)
    if proof and result.certificate:
        files[proof] = proof_text(result.certificate)
    if told:
        files[told] = json_text(report)
    finish(result, report, files, chosen.json)
