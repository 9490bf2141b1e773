"""The time in which the outline follows the tracer's controls, on a picture of 2,000 pixels.

    python -m studies.editor.tracer

The picture is a bundled one on a plain ground. Each control is moved seven times through the
tracer's model, as by the widget. The times include making the message to the page.
"""

import itertools
from collections.abc import Callable

import numpy as np
from PIL import Image

import glid_nb
from glid_nb.widgets.tracer import described
from glid_nb.widgets.tracer_gestures import TraceGestures
from studies.timing import timed


def main() -> None:
    """Measure and print."""
    model = glid_nb.session.TracingModel(picture(2000))
    hand = TraceGestures(model)
    print("control           median   least, ms")
    for name, move in controls(model).items():
        moves = map(move, itertools.count())
        seconds = timed(lambda moves=moves: (next(moves), described(hand)), 7)
        print(f"{name:16} {1e3 * seconds['median']:7.1f} {1e3 * seconds['least']:7.1f}")
        if model.problems:
            raise RuntimeError(model.problems[0].message)


def picture(side: int) -> np.ndarray:
    """The bundled teapot on a plain ground."""
    shape = Image.fromarray(glid_nb.samples.image("teapot"))
    ground = Image.new("RGBA", shape.size, (244, 236, 220, 255))
    image = Image.alpha_composite(ground, shape)
    size = [round(side / max(image.size) * length) for length in image.size]
    return np.asarray(image.resize(size, Image.Resampling.LANCZOS))


def controls(model: glid_nb.session.TracingModel) -> dict[str, Callable[[int], object]]:
    """One movement of each control, different for each number."""

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
        "scribble": scribble,
    }


if __name__ == "__main__":
    main()
