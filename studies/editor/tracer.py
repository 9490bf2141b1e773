"""How fast the outline follows the tracer's controls, on a picture of 2,000 pixels.

Usage: python -m studies.editor.tracer [--picture PATH] [--side 2000] [--repeats 7] [--json]

The picture, by default a bundled one on a plain ground, is scaled so that its longer side has SIDE
pixels. Each control is moved REPEATS times through the tracer's model, as the widget does, with
what the page is told included; the median and the slowest are printed in milliseconds, and the
median of the processor's time, which other programs on the machine do not lengthen.
"""

from __future__ import annotations

import argparse
import json
import statistics
import time
from collections.abc import Callable

import numpy as np
from PIL import Image

import glid_nb
from glid_nb.widgets.tracer_view import described


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--picture", help="a picture file (default: the bundled teapot)")
    parser.add_argument("--side", type=int, default=2000, help="pixels of the longer side")
    parser.add_argument("--repeats", type=int, default=7)
    parser.add_argument("--json", action="store_true")
    chosen = parser.parse_args()
    model = glid_nb.TracingModel(picture(chosen.picture, chosen.side))
    results = {
        name: measured(model, move, chosen.repeats) for name, move in controls(model).items()
    }
    if chosen.json:
        print(json.dumps(results))
        return
    width = max(map(len, results))
    for name, times in results.items():
        median, most, cpu = times["median_ms"], times["most_ms"], times["cpu_ms"]
        print(f"{name:<{width}}  median {median:6.1f}  most {most:6.1f}  processor {cpu:6.1f} ms")


def picture(path: str | None, side: int) -> np.ndarray:
    if path is None:
        shape = Image.fromarray(glid_nb.samples.image("teapot"))
        ground = Image.new("RGBA", shape.size, (244, 236, 220, 255))
        image = Image.alpha_composite(ground, shape)
    else:
        image = Image.fromarray(glid_nb.read_image(path))
    scale = side / max(image.size)
    size = (round(image.width * scale), round(image.height * scale))
    return np.asarray(image.resize(size, Image.Resampling.LANCZOS))


def controls(model: glid_nb.TracingModel) -> dict[str, Callable[[int], None]]:
    """One movement of each control; the number makes it another one each time."""

    def scribble(i: int) -> None:
        frame = model.frame
        assert frame is not None
        x, y = frame.width / 2, frame.height / 2
        model.paint("foreground", [[x - 40, y + 9 * i], [x + 40, y + 9 * i]])

    def vertex(i: int) -> None:
        x, y = model.loops[0][0]
        model.move_vertex(0, 0, (float(x) + 0.1 + 0.01 * i, float(y)), gesture="drag")

    def back_and_forth(_: int) -> None:
        model.undo()
        model.redo()

    return {
        "threshold": lambda i: model.set_options(threshold=0.1 + 0.01 * i),
        "smoothing": lambda i: model.set_options(smoothing=1.0 + 0.2 * i),
        "offset": lambda i: model.set_options(offset=4.0 + i),
        "simplify": lambda i: model.set_options(simplify=3.0 + 0.3 * i),
        "least hole area": lambda i: model.set_options(min_hole_area=100.0 * (1 + i)),
        "hole": lambda i: model.toggle_hole(0),  # noqa: ARG005
        "vertex": vertex,
        "undo and redo": back_and_forth,
        "scribble": scribble,
    }


def measured(
    model: glid_nb.TracingModel, move: Callable[[int], None], repeats: int
) -> dict[str, float]:
    described(model)
    times, cpu_times = [], []
    for i in range(repeats):
        began, cpu_began = time.perf_counter(), time.process_time()
        move(i)
        described(model)
        times.append(1000 * (time.perf_counter() - began))
        cpu_times.append(1000 * (time.process_time() - cpu_began))
        if model.problems:
            raise RuntimeError(model.problems[0].message)
    return {
        "median_ms": statistics.median(times),
        "most_ms": max(times),
        "cpu_ms": statistics.median(cpu_times),
    }


if __name__ == "__main__":
    main()
