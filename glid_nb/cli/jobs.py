"""Many problems of `glid-nb solve` on processes or a cluster: a line for each, and a table."""

import argparse
import csv
import io
import json
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Any

import glid_nb
from glid_nb._errors import InputError
from glid_nb._files import write_atomically
from glid_nb._json import json_text, picture_size, read_object
from glid_nb.certificate.certify import proof_text
from glid_nb.certificate.rounding import rounded_down
from glid_nb.cli.flags import energy_of, options_of
from glid_nb.cli.output import (
    BAD_INPUT,
    about_input,
    check_failures,
    check_files,
    map_text,
    one_line,
    tell_error,
    write,
)

CONNECT = 10  # seconds to wait for a scheduler


def add_job_flags(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("many problems")
    add = group.add_argument
    add("--jobs", type=int, metavar="N", help="solve in N processes of this machine")
    scheduler = "solve on the workers of a dask scheduler, such as tcp://10.0.0.1:8786"
    add("--scheduler", metavar="ADDRESS", help=scheduler)
    add("--summary", type=Path, metavar="table.csv", help="file for a table with all results")
    kept = "folder that keeps results; the same command again solves only what is missing"
    add("--kept", type=Path, metavar="FOLDER", help=kept)


def has_job_flags(chosen: argparse.Namespace) -> bool:
    return any(v is not None for v in (chosen.jobs, chosen.scheduler, chosen.summary, chosen.kept))


def solve_jobs(
    paths: Sequence[Path],
    outs: Sequence[Path | None],
    proofs: Sequence[Path | None],
    reports: Sequence[Path | None],
    chosen: argparse.Namespace,
) -> None:
    """Solve the problems in files. One that fails does not stop the others.

    Raises an InputError at the end if any failed.
    """
    for flag, value in (("--start", chosen.start), ("--refine", chosen.refine)):
        if value:
            wanted = "leave --jobs, --scheduler, --summary and --kept out"
            raise InputError(f"{flag} is for problems one by one; {wanted}")
    if chosen.jobs is not None and chosen.jobs < 1:
        raise InputError(f"--jobs must be at least 1 process, not {chosen.jobs}")
    check_files([chosen.summary], paths)
    energy, options = energy_of(chosen), options_of(chosen)
    rows = dict[str, dict[str, Any]]()
    problems, sizes = dict[str, glid_nb.io.Problem](), dict[str, Any]()
    for path in paths:
        try:
            problems[str(path)] = glid_nb.io.Problem.load(path)
            size = read_object(path).get("image_size_px")
            sizes[str(path)] = None if size is None else picture_size(size, "image_size_px")
        except BAD_INPUT as error:
            if chosen.debug:
                raise
            problems.pop(str(path), None)
            text = about_input(path, error)
            tell_error(text)
            rows[str(path)] = {"name": str(path), "status": "failed", "error": text}
    files = {str(path): named for path, *named in zip(paths, outs, proofs, reports, strict=True)}
    try:
        with _executor_of(chosen) as executor:
            many = glid_nb.solve_many(
                problems, energy, options, executor=executor, folder=chosen.kept
            )
            with closing(many):
                for one in many:
                    if one.error is not None and chosen.debug:
                        raise one.error
                    row = rows[one.name] = one.to_row()
                    if one.result is None:
                        tell_error(row["error"])
                        continue
                    size = sizes[one.name]
                    written = _write(one.result, problems[one.name], size, files[one.name])
                    print(json.dumps(row) if chosen.json else _line(row, written), flush=True)
    finally:  # also after Ctrl-C
        if chosen.summary is not None:
            write_atomically(chosen.summary, _table([rows[n] for n in files if n in rows]))
    check_failures(sum(row["status"] == "failed" for row in rows.values()), len(paths))


@contextmanager
def _executor_of(chosen: argparse.Namespace) -> Iterator[Any]:
    """The executor that the flags ask for: a number of processes, a cluster's, or none."""
    if chosen.scheduler is None:
        yield chosen.jobs
        return
    if chosen.jobs is not None:
        raise InputError("--jobs and --scheduler exclude each other; the cluster has its workers")
    try:
        from distributed import Client  # noqa: PLC0415 - an optional package
    except ImportError:
        how = "pip install 'glid-nb[cluster]'"
        raise InputError(f"--scheduler needs dask; install it with: {how}") from None
    try:
        client = Client(chosen.scheduler, timeout=CONNECT, set_as_default=False)
    except (OSError, ValueError) as error:
        what = f"--scheduler {chosen.scheduler}: no scheduler answers"
        raise InputError(f"{what} ({one_line(error)})") from None
    with client:
        yield client.get_executor()


def _write(
    result: glid_nb.Result,
    problem: glid_nb.io.Problem,
    size: Any,
    files: Sequence[Path | None],
) -> list[Path]:
    """Write the map, the proof and the report of a result. Returns the files."""
    out, proof, report = files
    assert isinstance(result.map, glid_nb.HarmonicMap)
    texts = dict[Path, str]()
    if out:
        texts[out] = map_text(result.map, size, problem.pose)
    if proof and result.certificate:
        texts[proof] = proof_text(result.certificate)
    if report:
        texts[report] = json_text(glid_nb.io.build_report(result))
    for path, text in texts.items():
        write(path, text)
    return list(texts)


def _line(row: dict[str, Any], written: Sequence[Path]) -> str:
    """One line about a result."""
    bound = rounded_down(row["sigma2_lower"], 4)
    parts = [row["status"], f"energy {row['energy']:.6g}", f"sigma_2 >= {bound}"]
    parts += ["kept before"] if row["kept"] else [f"{row['solve_time']:.3f} s"]
    to = f" -> {', '.join(map(str, written))}" if written else ""
    return f"{row['name']}: {', '.join(parts)}{to}"


def _table(rows: Sequence[dict[str, Any]]) -> str:
    """The rows as CSV, in the order of the inputs."""
    columns = list(dict.fromkeys(name for row in rows for name in row if name != "index"))
    buffer = io.StringIO()
    writer = csv.DictWriter(buffer, columns, extrasaction="ignore", lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return buffer.getvalue()
