"""Solving with progress that can be stopped, and what is written and printed afterwards."""

import signal
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import glid_nb
from glid_nb._errors import InputError
from glid_nb._json import json_text
from glid_nb.cli.output import summary_json, summary_text, write_all
from glid_nb.cli.progress import step


def run_solver(
    domain: glid_nb.Domain,
    pose: glid_nb.Pose,
    energy: glid_nb.Energy,
    options: glid_nb.Options,
    start: glid_nb.HarmonicMap | None = None,
    refine: bool = False,
) -> tuple[glid_nb.Result, dict[str, Any]]:
    """The result, with ``refine`` that of the finest basis worth it, and its report.

    Ctrl-C ends the solve with the last certified map; a second Ctrl-C raises KeyboardInterrupt.
    """
    glid_nb.enable_compilation_cache()
    doing = "solving (new shapes are compiled first; Ctrl-C stops)"
    with step(doing) as detail, _interruptible() as interrupted:

        def show(state: glid_nb.Progress) -> bool:
            if state.history:
                last = state.history[-1]
                detail(f"iteration {last.iteration}, energy {last.energy:.6g}")
            else:  # the first step was refused, so panels are split first
                detail("before the first iteration, splitting panels")
            return interrupted()

        result = glid_nb.solve(domain, pose, energy, options, start=start, callback=show)
        if refine:
            result = glid_nb.refine(result, callback=show)
    with step("proving the result"):
        return result, glid_nb.build_report(result)


def map_text(map: glid_nb.HarmonicMap, image_size: Sequence[int] | None, pose: glid_nb.Pose) -> str:
    """The content of map.json, with the picture's size if known and depths for `glid-nb render`."""
    size = {} if image_size is None else {"image_size_px": image_size}
    return json_text({**map.to_dict(), **size, **(pose.to_dict() if pose.depths.any() else {})})


def finish(
    result: glid_nb.Result,
    report: dict[str, Any],
    files: dict[Path, bytes | str],
    json: bool,
    rows: list[tuple[str, str]] | None = None,
    **extra: Any,
) -> None:
    """Write the files and print the summary, with ``extra`` as JSON or with ``rows`` as text.

    Raises KeyboardInterrupt after a solve that Ctrl-C stopped, and an InputError where nothing that
    the solver reached could be proved.
    """
    write_all(files)
    print(summary_json(report, files, **extra) if json else summary_text(report, files, rows or []))
    if result.status is glid_nb.Status.STOPPED:
        raise KeyboardInterrupt
    if result.status is glid_nb.Status.UNPROVED or not report["certified"]:
        raise InputError(f"{result.message} ({report['proof']})")


@contextmanager
def _interruptible() -> Iterator[Callable[[], bool]]:
    """Turn the first Ctrl-C into a request; yields a function that tells whether it was made."""
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
