"""Figures with sliders: what is drawn, what the output contains."""

from __future__ import annotations

import base64
import io
import json
import re
import zlib
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

from glid_nb import figures
from glid_nb._errors import InputError
from glid_nb.figures import LiveFigure
from glid_nb.figures.drawing import NotebookFigure
from glid_nb.harmonic import HarmonicMap

from ..support.domains import domain

RING = HarmonicMap.identity(domain("ring"))


def line(a: float, b: bool = False) -> NotebookFigure:
    return figures.function([0, 1 + b], {"line": [0, a]}, title=f"a is {a}")


def html_of(figure: LiveFigure) -> str:
    return figure._repr_mimebundle_()[0]["text/html"]


def data_of(figure: LiveFigure) -> dict[str, Any]:
    (packed,) = re.findall(r'data-frames="([^"]+)"', html_of(figure))
    return json.loads(zlib.decompress(base64.b64decode(packed)))


def frames_of(figure: LiveFigure) -> list[str]:
    data = data_of(figure)
    return ["\n".join(data["lines"][i] for i in frame) for frame in data["frames"]]


def test_every_combination_is_drawn_once_and_the_last_slider_changes_first() -> None:
    drawn: list[tuple[float, bool]] = []

    def draw(a: float, b: bool) -> NotebookFigure:
        drawn.append((a, b))
        return line(a, b)

    data = data_of(figures.live(draw, 0.3, a=np.linspace(0.1, 0.3, 3), b=[False, True]))
    assert drawn == [(a, b) for a in (0.1, 0.2, 0.3) for b in (False, True)]
    assert data["titles"] == [f"a is {a}" for a, _ in drawn]
    assert data["controls"] == [
        {"name": "a", "values": ["0.1", "0.2", "0.3"], "start": 2, "check": False},
        {"name": "b", "values": ["False", "True"], "start": 0, "check": True},
    ]


def test_each_frame_is_an_svg_file_of_its_own_with_no_address() -> None:
    frames = frames_of(figures.live(line, a=[1, 2, 3]))
    assert len(set(frames)) == 3
    for frame in frames:
        root = ElementTree.fromstring(frame)
        assert root.tag == "{http://www.w3.org/2000/svg}svg"
        assert not re.search(r'(?:href|src)="(?!#|data:)', frame)


def test_what_frames_have_in_common_is_stored_once() -> None:
    one, ten = (len(html_of(figures.live(line, a=range(1, n + 1)))) for n in (1, 10))
    assert ten < 1.5 * one


def test_without_script_the_first_picture_is_there_with_its_words() -> None:
    figure = figures.live(line, 2, a=[1, 2])
    ((kind, picture, width, height, words),) = re.findall(
        r'<img src="data:image/(\w+);base64,([^"]+)" width="(\d+)" height="(\d+)" alt="([^"]+)">',
        html_of(figure),
    )
    assert words == "a = 2: a is 2"
    with Image.open(io.BytesIO(base64.b64decode(picture))) as drawn:
        assert drawn.format == kind.upper()
        assert abs(drawn.width / drawn.height - int(width) / int(height)) < 0.01
    data, size = figure._repr_mimebundle_()
    assert (data["image/png"], size["image/png"]) == line(2)._repr_png_()
    assert data["text/plain"] == "<LiveFigure>"


def test_the_same_figure_has_the_same_bytes() -> None:
    def shape(n: int) -> NotebookFigure:
        return figures.picture(None, [RING] * n)

    assert html_of(figures.live(shape, n=[1, 2])) == html_of(figures.live(shape, n=[1, 2]))


def test_a_frame_keeps_size_and_limits_while_the_colour_bar_keeps_its_own() -> None:
    ell = domain("ell")
    vertices = ell.offset_cage.loops_complex[0]
    drawn: list[NotebookFigure] = []

    def sheared(k: float) -> NotebookFigure:
        """The map z + k conj(z), which is wider and less tall with a larger k."""
        drawn.append(figures.distortion(HarmonicMap(ell, vertices, k * vertices), "k"))
        return drawn[-1]

    alone = sheared(0.3), sheared(0.7)
    (x, _), (wide_x, wide_bar) = ([axes.get_xlim() for axes in one.axes] for one in alone)
    (tall_y, _), (y, _) = ([axes.get_ylim() for axes in one.axes] for one in alone)
    assert x[1] < wide_x[1]
    assert y[1] < tall_y[1]
    figures.live(sheared, k=[0.3, 0.7])
    for one in drawn[2:]:
        assert one.axes[0].get_xlim() == wide_x
        assert one.axes[0].get_ylim() == tall_y
        assert one.get_size_inches().tolist() == alone[0].get_size_inches().tolist()
    bars = [one.axes[1].get_xlim() for one in drawn[2:]]
    assert bars[0] != bars[1] == wide_bar


def test_a_field_of_many_triangles_is_a_small_picture_in_its_frame() -> None:
    (frame,) = frames_of(figures.live(lambda q: figures.distortion(RING, q), q=["sigma1"]))
    assert "data:image/png" not in frame
    pictures = re.findall(r'data:image/webp;base64,([^"]+)"', frame)
    assert pictures
    with Image.open(io.BytesIO(base64.b64decode(pictures[0]))) as field:
        alpha = np.asarray(field.convert("RGBA"))[..., 3]
    assert {*alpha.ravel().tolist()} == {0, 255}
    assert len(frame) < 100_000


@pytest.mark.parametrize(
    ("start", "values", "words"),
    [
        ((), {}, "there is no slider"),
        ((), {"a": 0.5}, "the slider a needs several values"),
        ((), {"a": []}, "the slider a has no position"),
        ((3,), {"a": [1, 2]}, "a cannot begin with 3, which is not one of 1, 2"),
        ((1, 1), {"a": [1, 2]}, "there are 2 values to begin with for 1 sliders"),
        ((), {"a": range(201)}, "there are 201 frames"),
    ],
)
def test_wrong_sliders_are_refused(start: Any, values: Any, words: str) -> None:
    with pytest.raises(InputError, match=words):
        figures.live(line, *start, **values)


def test_a_figure_of_matplotlib_has_sliders_too() -> None:
    def drawn(a: float) -> Figure:
        figure = Figure()
        figure.subplots().plot([0, a])
        return figure

    data, size = figures.live(drawn, a=[1, 2])._repr_mimebundle_()
    assert data["image/png"].startswith(b"\x89PNG")
    assert size["image/png"]["width"] > 0
    assert "glid-frames" in data["text/html"]


def test_a_function_that_draws_nothing_is_refused() -> None:
    with pytest.raises(InputError, match="the function returns NoneType, not a figure"):
        figures.live(print, sep=[" "])  # type: ignore[arg-type]


def test_the_point_of_a_frame_lies_where_its_axes_put_it() -> None:
    drawn: list[NotebookFigure] = []

    def square(x: float, y: float) -> NotebookFigure:
        drawn.append(figures.function([0, 4], {"line": [x, y]}))
        drawn[-1].axes[0].set(xlim=(0, 4), ylim=(0, 2))
        return drawn[-1]

    places = {"x": [0, 2, 4], "y": [0, 2]}
    points = np.array(data_of(figures.live(square, point=lambda x, y: (x, y), **places))["points"])
    box = drawn[-1].axes[0].get_position()
    corners = [
        [x, 1 - y] for x in (box.x0, (box.x0 + box.x1) / 2, box.x1) for y in (box.y0, box.y1)
    ]
    np.testing.assert_allclose(points, corners, atol=1e-4)
    complex_ones = figures.live(square, point=lambda x, y: x + 1j * y, **places)
    assert data_of(complex_ones)["points"] == points.tolist()


@pytest.mark.parametrize(
    ("point", "words"),
    [
        (lambda a: (50, a), "the point of a = 1 lies outside the figure; enlarge"),
        (lambda a: [a, a, a], "the point of a = 1 is no (x, y) and no complex number"),
        (lambda a: a * float("nan"), "the point of a = 1 lies outside the figure"),
    ],
)
def test_a_point_that_cannot_be_shown_is_refused(point: Any, words: str) -> None:
    with pytest.raises(InputError, match=re.escape(words)):
        figures.live(line, point=point, a=[1, 2])
