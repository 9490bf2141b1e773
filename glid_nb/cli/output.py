"""Output of a command: writing results, progress, a solve that Ctrl-C stops, the summary."""

import json
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from itertools import groupby
from pathlib import Path
from typing import Any

import glid_nb
from glid_nb._errors import InputError, InputFileError
from glid_nb._files import same_file, write_atomically
from glid_nb._json import json_text
from glid_nb.certificate.rounding import rounded_down, rounded_up

PATIENCE = 1.0  # seconds before a step is reported
_REFRESH = 0.2  # seconds between updates of the line in a terminal
_REPEAT = 15.0  # seconds between lines in a log file
_TIMES = {"compile": 2, "solve": 3, "certify": 3}
_LONG = ("history", "attempts", "refinements", "options", "versions", "machine")
_BASIS = "{unknowns} unknowns: {energy:.6g}, {solve_time:.3f} s"
_INJECTIVE = {"yes": "locally and globally", "no": "locally only"}
_INJECTIVE["undecided"] = "locally; globally undecided"


BAD_INPUT = (OSError, InputError)
"""Errors reported in one line. Any other error, also a plain ValueError, is a bug and keeps its
traceback."""


def one_line(error: BaseException) -> str:
    """The exception's message on one line, with the file first."""
    if isinstance(error, OSError) and error.filename is not None and error.strerror:
        return f"{error.filename}: {error.strerror}"
    return " ".join(str(error).split())


def tell_error(text: str) -> None:
    print(f"glid-nb: error: {text}", file=sys.stderr)


def about_input(given: Path, error: BaseException) -> str:
    """`one_line` of an error, with the input that it is about in front if it does not name it."""
    text = one_line(error)
    return text if str(given) in text else f"{given}: {text}"


def check_failures(failed: int, count: int) -> None:
    """Raise an InputError if any of ``count`` inputs failed. Each was told already."""
    if failed:
        raise InputError(f"{failed} of {count} inputs failed, for the reasons above")


STANDARD_OUTPUT = Path("standard output")
"""Stands for ``-``. It is compared by identity, so that a file may have any name."""


def write(path: Path, data: bytes | str) -> None:
    """Write a result to its file, or to standard output."""
    if path is not STANDARD_OUTPUT:
        write_atomically(path, data)
        return
    if isinstance(data, bytes):
        sys.stdout.flush()
        sys.stdout.buffer.write(data)
        sys.stdout.buffer.flush()
    else:
        sys.stdout.write(data)
        sys.stdout.flush()


def tell(text: str, *results: Path | None) -> None:
    """Print what was done; on stderr if standard output holds a result."""
    occupied = any(path is STANDARD_OUTPUT for path in results)
    print(text, file=sys.stderr if occupied else sys.stdout)


def check_files(outputs: Iterable[Path | None], inputs: Iterable[str | Path | None]) -> None:
    """Raise an error if an output file cannot be made, or is also an input or another output. None
    is skipped."""
    taken = [(Path(path), "it is also an input") for path in inputs if path is not None]
    for path in outputs:
        if path is None or path is STANDARD_OUTPUT:
            continue
        if path.is_dir():
            raise IsADirectoryError(21, "is a folder; name a file", str(path))
        if not path.parent.is_dir():
            raise FileNotFoundError(2, "there is no such folder to write to", str(path.parent))
        for other, why in taken:
            if same_file(path, other):
                raise InputFileError(f"{path} would be overwritten, but {why}; name another file")
        taken.append((path, "another result is written there"))


def check_folder(path: Path) -> None:
    """Raise an OSError if no folder can be made at ``path``."""
    first = next(part for part in (path, *path.parents) if part.exists())
    if not first.is_dir():
        raise NotADirectoryError(20, "is a file; name a folder", str(first))


@contextmanager
def step(doing: str) -> Iterator[Callable[[str], None]]:
    """Run a step, and report it on stderr if it takes long. Yields a function that sets the
    reported detail."""
    out, details = sys.stderr, list[str]()
    done, start, live = threading.Event(), time.perf_counter(), out.isatty()
    width = 0  # of the line in the terminal

    def write(text: str) -> None:
        nonlocal width
        # Erase with spaces: older consoles of Windows print escape sequences as text.
        out.write(f"\r{' ' * width}\r{text}" if live else f"glid-nb: {text}\n")
        out.flush()
        width = len(text)

    def line() -> str:
        return ", ".join([f"{doing}: {time.perf_counter() - start:.1f} s", *details[-1:]])

    def report() -> None:
        if done.wait(PATIENCE):
            return
        write(line() if live else f"{doing} ...")
        while not done.wait(_REFRESH if live else _REPEAT):
            write(line() if live else f"{line()} ...")
        write("" if live else line())

    # Another thread reports, because the step may be one long call into compiled code.
    reporter = threading.Thread(target=report, daemon=True)
    reporter.start()
    try:
        yield details.append
    finally:
        done.set()
        reporter.join()


def run_solver(
    domain: glid_nb.Domain,
    pose: glid_nb.Pose,
    energy: glid_nb.energies.Energy,
    options: glid_nb.Options,
    start: glid_nb.HarmonicMap | None = None,
    refine: bool = False,
) -> tuple[glid_nb.Result, dict[str, Any]]:
    """Solve. Returns the result and its report. ``refine`` also solves with finer bases.

    Ctrl-C ends the solve with the last certified map. A second Ctrl-C raises KeyboardInterrupt.
    """
    glid_nb.enable_compilation_cache()
    doing = "solving (new shapes are compiled first; Ctrl-C stops)"
    with step(doing) as detail, _interruptible() as interrupted:

        def show(state: glid_nb.Progress) -> bool:
            if state.history:
                last = state.history[-1]
                detail(f"iteration {last.iteration}, energy {last.energy:.6g}")
            else:  # the first step was refused, so panels are being split
                detail("before the first iteration, splitting panels")
            return interrupted()

        result = glid_nb.solve(domain, pose, energy, options, start=start, callback=show)
        if refine:
            result = glid_nb.refine(result, callback=show)
    with step("proving the result"):
        return result, glid_nb.io.build_report(result)


@contextmanager
def _interruptible() -> Iterator[Callable[[], bool]]:
    """Turn the first Ctrl-C into a request. Yields a function that returns whether it was made."""
    asked = threading.Event()

    def ask(signal_number: int, frame: Any) -> None:
        if asked.is_set():
            signal.default_int_handler(signal_number, frame)
        asked.set()

    previous = signal.signal(signal.SIGINT, ask)
    try:
        yield asked.is_set
    finally:
        signal.signal(signal.SIGINT, previous)


def map_text(map: glid_nb.HarmonicMap, image_size: Sequence[int] | None, pose: glid_nb.Pose) -> str:
    """The content of map.json, with the picture's size if known and the depths of handles."""
    size = {} if image_size is None else {"image_size_px": image_size}
    return json_text({**map.to_dict(), **size, **(pose.to_dict() if pose.depths.any() else {})})


def finish(
    result: glid_nb.Result,
    report: dict[str, Any],
    files: dict[Path, bytes | str],
    as_json: bool,
    rows: Iterable[tuple[str, str]] = (),
    **extra: Any,
) -> None:
    """Write the files and print the summary, as JSON with ``extra`` or as text with ``rows``.

    Raises KeyboardInterrupt after a solve that Ctrl-C stopped, InputError if nothing is proved.
    """
    for path, data in files.items():
        write(path, data)
    if as_json:
        short = {key: value for key, value in report.items() if key not in _LONG}
        print(json.dumps({**extra, **short, "files": {path.name: str(path) for path in files}}))
    else:
        tell(summary_text(report, files, rows), *files)
    if result.status is glid_nb.Status.STOPPED:
        raise KeyboardInterrupt
    if result.status is glid_nb.Status.UNPROVED or not report["certified"]:
        raise InputError(f"{result.message} ({report['proof']})")


def summary_text(report: Any, files: Iterable[Path], rows: Iterable[tuple[str, str]] = ()) -> str:
    """The report as text for one screen, with ``rows`` of (name, text) and ``files``."""
    named = [path for path in files if path is not STANDARD_OUTPUT]
    folders = groupby(named, key=lambda path: path.parent)
    written = [f"{folder}: {', '.join(path.name for path in f)}" for folder, f in folders]
    written += ["standard output"] if len(named) < len(list(files)) else []
    written = written or ["nothing; name files with --out and --report"]
    table = [*rows, *_rows(report), *(("written", text) for text in written)]
    width = max(len(name) for name, _ in table)
    lines, before = [], ""
    for name, text in table:
        lines.append(f"{'' if name == before else name:<{width}}  {text}".rstrip())
        before = name
    return "\n".join(lines)


def _rows(report: Mapping[str, Any]) -> list[tuple[str, str]]:
    energy = report["energy"] + ("" if report["s"] is None else f", s = {report['s']:g}")
    winding = f"{report['winding']}"
    if any(report["windings"]):
        winding += f"  (loops: {', '.join(f'{w:+d}' if w else '0' for w in report['windings'])})"
    injective = _INJECTIVE[report["globally_injective"]]
    if report["crossing"] is not None:
        x, y = report["crossing"]
        injective += f"; the boundary's image crosses itself at ({x:.3g}, {y:.3g})"
    panels = f"{report['panels']}"
    if report["panels_split"]:
        panels += f", {report['panels_split']} split"
    if report["proof_panels"] != report["panels"]:
        panels += f"; {report['proof_panels']} in the final proof"
    e, e_iso, e_p2p = (_bounded(report[key], "{:.6g}".format) for key in ("E", "E_iso", "E_p2p"))
    seconds = (f"{part} {report[f'{part}_time']:.{n}f} s" for part, n in _TIMES.items())
    return [
        ("status", report["message"]),
        ("unknowns", f"{report['n_unknowns']}"),
        ("panels", panels),
        ("iterations", f"{report['iterations']}"),
        ("energy", f"{e}  ({energy}: {e_iso}, targets: {e_p2p})"),
        *(("ways", _attempt(one)) for one in report["attempts"]),
        *(("bases", _BASIS.format(**one)) for one in report["refinements"]),
        ("certified", "yes" if report["certified"] else "no"),
        ("sigma_2", f">= {_bounded(report['sigma2_lower'], rounded_down, 6)}"),
        ("sigma_1", f"<= {_bounded(report['sigma1_upper'], rounded_up, 6)}"),
        ("k", f"<= {_bounded(report['k_upper'], rounded_up, 6)}"),
        ("winding number", winding),
        ("injective", injective if report["certified"] else "not proved"),
        ("times", ", ".join(seconds)),
    ]


def _attempt(one: Mapping[str, Any]) -> str:
    energy = _bounded(one["energy"], "{:.6g}".format)
    return f"{one['name']}: " + ("given up" if one["given_up"] else f"{energy}, {one['status']}")


def _bounded(value: float | None, written: Any, *digits: int) -> str:
    return "unbounded" if value is None else written(value, *digits)
