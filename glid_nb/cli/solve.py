"""Solve a problem given as a file, and write the map and a report.

PROBLEM.json is an object with the keys cage, holes, handles and targets (world coordinates);
offset, offset_cage, offset_holes, hole_points, angles, scales and weights (of the handles) are used
when given, and image_size_px and depths go into the map. Without --report only the map is written,
without --out only the report.
"""

import argparse
from pathlib import Path

import glid_nb
from glid_nb._errors import about
from glid_nb._json import json_text, picture_size, read_object
from glid_nb.certificate.certify import proof_text
from glid_nb.cli.flags import add_solver_flags, energy_of, options_of
from glid_nb.cli.output import check_files, finish, map_text, run_solver


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("problem", type=Path, metavar="PROBLEM.json", help="what is solved")
    add("--out", type=Path, metavar="map.json", help="where the map goes")
    proof = "where the proof goes, for glid-check map.json proof.json"
    add("--proof", type=Path, metavar="proof.json", help=proof)
    add("--report", type=Path, metavar="report.json", help="where the report goes")
    start = "a certified map of the same domain to start from (default: see --align)"
    add("--start", type=Path, metavar="map.json", help=start)
    refine = "solve again with finer bases until that lowers the energy by less than 1 %%"
    add("--refine", action="store_true", help=refine)
    add("--json", action="store_true", help="print the summary as JSON")
    add_solver_flags(parser)


def run(chosen: argparse.Namespace) -> None:
    check_files([chosen.out, chosen.proof, chosen.report], [chosen.problem, chosen.start])
    data = read_object(chosen.problem)
    with about(chosen.problem):
        problem = glid_nb.Problem.from_dict(data)
        if (size := data.get("image_size_px")) is not None:
            size = picture_size(size, "image_size_px")
    energy, options = energy_of(chosen), options_of(chosen)
    start = glid_nb.HarmonicMap.load(chosen.start) if chosen.start else None
    with about(chosen.start or chosen.problem):
        what = problem.domain, problem.pose, energy, options, start, chosen.refine
        result, report = run_solver(*what)
    assert isinstance(result.map, glid_nb.HarmonicMap)
    files: dict[Path, bytes | str] = {}
    if chosen.out:
        files[chosen.out] = map_text(result.map, size, problem.pose)
    if chosen.proof and result.certificate:
        files[chosen.proof] = proof_text(result.certificate)
    if chosen.report:
        files[chosen.report] = json_text(report)
    finish(result, report, files, chosen.json)
