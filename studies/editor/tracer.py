"""How fast the outline follows the tracer's controls, on a picture of 2,000 pixels.

    python -m studies.editor.tracer [--side 2000] [--repeats 7]

The picture, a bundled one on a plain ground, is scaled so that its longer side has SIDE pixels.
Each control is moved REPEATS times through the tracer's model, as the widget does, with what the
page is told included. Prints the median and the slowest in milliseconds, and the median of the
processor's time, which other programs on the machine do not lengthen.
"""

import argparse
import time
from collections.abc import Callable

import numpy as np
from PIL import Image

import glid_nb
from glid_nb.widgets.tracer import described
from glid_nb.widgets.tracer_gestures import TraceGestures


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--side", type=int, default=2000, help="pixels of the longer side")
    parser.add_argument("--repeats", type=int, default=7)
    chosen = parser.parse_args()
    model = glid_nb.TracingModel(picture(chosen.side))
    print("control           median    most   processor, ms")
    for name, move in controls(model).items():
        wall, cpu = measured(model, move, chosen.repeats).T
        print(f"{name:16} {np.median(wall):7.1f} {wall.max():7.1f} {np.median(cpu):7.1f}")


def picture(side: int) -> np.ndarray:
    """The bundled teapot on a plain ground."""
    shape = Image.fromarray(glid_nb.samples.image("teapot"))
    ground = Image.new("RGBA", shape.size, (244, 236, 220, 255))
    image = Image.alpha_composite(ground, shape)
    scale = side / max(image.size)
    size = (round(image.width * scale), round(image.height * scale))
    return np.asarray(image.resize(size, Image.Resampling.LANCZOS))


def controls(model: glid_nb.TracingModel) -> dict[str, Callable[[int], object]]:
    """One movement of each control; the number makes it another one each time."""

    def scribble(i: int) -> None:
        assert model.frame is not None
        x, y = model.frame.width / 2, model.frame.height / 2
        model.paint("foreground", [[x - 40, y + 9 * i], [x + 40, y + 9 * i]])

    def vertex(i: int) -> None:
        x, y = model.loops[0][0]
        model.move_vertex(0, 0, (float(x) + 0.1 + 0.01 * i, float(y)), gesture="drag")

    return {
        "threshold": lambda i: model.set_options(threshold=0.1 + 0.01 * i),
        "smoothing": lambda i: model.set_options(smoothing=1.0 + 0.2 * i),
        "offset": lambda i: model.set_options(offset=4.0 + i),
        "simplify": lambda i: model.set_options(simplify=3.0 + 0.3 * i),
        "least hole area": lambda i: model.set_options(min_hole_area=100.0 * (1 + i)),
        "hole": lambda _: model.toggle_hole(0),
        "vertex": vertex,
        "undo and redo": lambda _: (model.undo(), model.redo()),
        "scribble": scribble,
    }


def measured(
    model: glid_nb.TracingModel, move: Callable[[int], object], repeats: int
) -> np.ndarray:
    """(repeats, 2) milliseconds of each movement, by the clock and by the processor."""
    hand = TraceGestures(model)
    described(hand)
    rows = []
    for i in range(repeats):
        began = np.array([time.perf_counter(), time.process_time()])
        move(i)
        described(hand)
        rows.append(1e3 * (np.array([time.perf_counter(), time.process_time()]) - began))
        if model.problems:
            raise RuntimeError(model.problems[0].message)
    return np.array(rows)


if __name__ == "__main__":
    main()
