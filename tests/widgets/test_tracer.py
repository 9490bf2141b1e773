"""The tracer without a browser: what the page gets, and what it may ask for."""

from __future__ import annotations

import io
import json
import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from PIL import Image

from glid_nb import samples
from glid_nb.geometry import Cage
from glid_nb.imaging import TraceError, TraceOptions
from glid_nb.imaging.read import MAX_SIDE
from glid_nb.session.tracing import TracingModel
from glid_nb.widgets import CageTracer

from ..support import from_page
from ..support.drawing import DRAWING, IN_SMALL_DISC


class Page:
    """The page's side."""

    def __init__(self, tracer: CageTracer, name: str = "page 1") -> None:
        self.tracer, self.name, self.sent = tracer, name, 0
        self.answers: list[dict[str, Any]] = []
        tracer.send = lambda content, buffers=None: self.answers.append(content)  # noqa: ARG005

    def ask(self, kind: str, buffers: tuple[bytes, ...] = (), **content: Any) -> str | None:
        """Send an event, through JSON; the refusal."""
        self.sent += 1
        event = {"type": kind, "seq": self.sent, **content, "buffered": bool(buffers)}
        from_page.send(
            self.tracer,
            json.loads(json.dumps({"view": self.name, "events": [event]})),
            [memoryview(b) for b in buffers],
        )
        answer = self.answers[-1]
        assert (answer["view"], answer["ack"]) == (self.name, self.sent)
        return answer["refusal"]

    def point(self, kind: str, x: float, y: float, **more: Any) -> str | None:
        """An event of the pointer at a pixel of the picture. The stage shows them one to one."""
        event = {"x": float(x), "y": float(y), "reach": 9, "unit": 1, "button": 0}
        return self.ask(kind, **{**event, "shift": False, "time": 1e6 * self.sent, **more})

    def click(self, x: float, y: float, **more: Any) -> str | None:
        return self.point("down", x, y, **more) or self.point("up", x, y, **more)

    def drag(self, *points: tuple[float, float]) -> str | None:
        self.point("down", *points[0])
        refusals = [self.point("move", *point) for point in points[1:]]
        self.point("up", *points[-1])
        return next(filter(None, refusals), None)

    def use(self, tool: str, x: float, y: float, **more: Any) -> str | None:
        """Click with a tool."""
        self.ask("tool", name=tool)
        return self.click(x, y, **more)


def cage_of(tracer: CageTracer) -> Cage:
    assert tracer.cage is not None
    return tracer.cage


@pytest.fixture
def tracer() -> CageTracer:
    return CageTracer(DRAWING)


@pytest.fixture
def page(tracer: CageTracer) -> Page:
    return Page(tracer)


def test_the_page_is_told_everything(tracer: CageTracer) -> None:
    shown = json.loads(json.dumps(tracer.shown, allow_nan=False))
    assert shown["size"] == [160, 120]
    assert [len(loop) for loop in shown["loops"]] == [len(p) for p in cage_of(tracer).loops]
    np.testing.assert_allclose(shown["loops"][0], tracer.tracing_model.loops[0], atol=0.006)
    assert shown["automatic"]["method"] == "color"
    assert shown["n_components"] == 2
    assert [hole["kept"] for hole in shown["holes"]] == [True, True]
    assert shown["problems"] == []
    picture = Image.open(io.BytesIO(tracer.picture))
    assert picture.size == (160, 120)
    assert len(json.dumps(shown)) < 20_000


def test_a_large_transparent_picture_is_shown_smaller_but_traced_whole() -> None:
    image = np.zeros((1200, 2400, 4), np.uint8)
    image[200:900, 300:2000] = (200, 100, 50, 255)
    tracer = CageTracer(image)
    picture = Image.open(io.BytesIO(tracer.picture))
    assert picture.size == (1600, 800)
    assert picture.mode == "RGBA"
    assert tracer.shown["size"] == [2400, 1200]


def test_without_a_picture() -> None:
    tracer = CageTracer()
    assert tracer.picture == b""
    assert tracer.shown["size"] is None
    assert tracer.cage is None
    assert Page(tracer).ask("toggle_hole", number=0) is not None
    assert Page(tracer).drag((1, 1), (2, 2)) is None
    assert not tracer.shown["edited"]


def test_every_action_reaches_the_model(tracer: CageTracer, page: Page) -> None:
    model = tracer.tracing_model
    assert page.ask("set_options", changes={"offset": 6}) is None
    assert tracer.options.offset == 6
    assert page.ask("toggle_hole", number=0) is None
    assert cage_of(tracer).n_holes == 1
    n = cage_of(tracer).n_vertices
    x, y = model.loops[0][3]
    assert page.drag((x, y), (x + 9, y), (x + 5, y)) is None
    np.testing.assert_allclose(model.loops[0][3], [x + 5, y])
    middle = model.loops[0][:2].mean(axis=0)
    assert page.click(*middle, reach=1, time=1e9) is None
    assert page.click(*middle, reach=1, time=1e9 + 200) is None
    assert cage_of(tracer).n_vertices == n + 1
    assert page.point("down", *model.loops[0][1], button=2) is None
    assert cage_of(tracer).n_vertices == n
    assert tracer.shown["edited"]
    assert page.ask("discard_edits") is None
    assert not tracer.shown["edited"]
    assert page.use("component", *IN_SMALL_DISC) is None
    assert tracer.shown["component"] == 1
    assert page.ask("undo") is None
    assert tracer.shown["component"] == 0
    assert page.ask("redo") is None
    assert tracer.shown["component"] == 1
    assert page.use("foreground", 60, 100, path=[[60, 20], [60, 100]]) is None
    assert tracer.shown["strokes"]["foreground"] == [[[60, 20], [60, 100]]]
    assert page.ask("clear_scribbles") is None
    assert tracer.shown["strokes"]["foreground"] == []
    assert page.use("color", 2, 2) is None
    assert tracer.options.background_at == (2, 2)


@pytest.mark.parametrize(
    ("action", "content", "culprit"),
    [
        ("set_options", {"changes": {"offset": -1}}, "offset"),
        ("set_options", {"changes": {"ofset": 1}}, "did you mean"),
        ("toggle_hole", {"number": 99}, "no hole 99"),
        ("tool", {"name": "axe"}, "no tool 'axe'"),
        ("format_disk", {}, "cannot do"),
    ],
)
def test_a_refusal_is_a_sentence_and_changes_nothing(
    tracer: CageTracer, page: Page, action: str, content: dict[str, Any], culprit: str
) -> None:
    state, shown = tracer.tracing_model.state, tracer.shown
    refusal = page.ask(action, **content)
    assert refusal is not None
    assert culprit in refusal
    assert tracer.tracing_model.state is state
    assert tracer.shown == shown


@pytest.mark.parametrize(
    ("tool", "place", "path", "culprit"),
    [
        ("foreground", (60, 20), [[1, 2, 3]], "stroke"),
        ("color", (-5, 0), [], "That place lies outside the picture"),
    ],
)
def test_a_tool_is_refused_in_a_sentence(
    tracer: CageTracer, page: Page, tool: str, place: tuple[float, float], path: Any, culprit: str
) -> None:
    state = tracer.tracing_model.state
    refusal = page.use(tool, *place, path=path)
    assert refusal is not None
    assert culprit in refusal
    assert tracer.tracing_model.state is state


def test_a_bug_is_shown_acknowledged_and_not_swallowed(
    tracer: CageTracer, page: Page, caplog: pytest.LogCaptureFixture
) -> None:
    with caplog.at_level("WARNING"):
        from_page.send(tracer, {"view": "a", "events": [{"type": "toggle_hole", "seq": 1}]})
    assert [record.exc_info[0] for record in caplog.records if record.exc_info] == [KeyError]
    assert page.answers[-1] == {"view": "a", "ack": 1, "refusal": "KeyError: 'number'"}


def test_a_problem_is_shown_with_its_place(tracer: CageTracer, page: Page) -> None:
    cage = tracer.cage
    i = int(np.argmin(tracer.tracing_model.loops[0][:, 0]))
    start = tracer.tracing_model.loops[0][i]
    assert page.drag(start, (150, 60)) is None
    (problem,) = tracer.shown["problems"]
    assert problem["message"].startswith("The outline crosses itself; move")
    assert 0 < problem["point"][0] < 160
    assert tracer.cage is cage
    assert tracer.shown["loops"][0][i] == [150, 60]


def _disc(alpha: bool) -> np.ndarray:
    """A disc on a transparent ground, or noise without transparency."""
    if not alpha:
        noise = np.random.default_rng(3).integers(0, 256, (60, 80, 3))
        return noise.astype(np.uint8)
    y, x = np.mgrid[:60, :80] + 0.5
    picture = np.full((60, 80, 4), (200, 40, 90, 255), np.uint8)
    picture[np.hypot(x - 40, y - 30) > 20, 3] = 0
    return picture


def _cross(model: TracingModel) -> None:
    model.move_vertex(0, int(np.argmin(model.loops[0][:, 0])), (75.0, 31.0))


def _coincide(model: TracingModel) -> None:
    model.move_vertex(0, 1, tuple(model.loops[0][0]))


def _coincide_at_the_end(model: TracingModel) -> None:
    model.move_vertex(0, len(model.loops[0]) - 1, tuple(model.loops[0][0]))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("alpha", "act", "words"),
    [
        (True, lambda m: m.set_options(method="color"), "choose Alpha, or pick"),
        (True, lambda m: m.set_options(method="scribbles"), "press Shape and paint"),
        (True, lambda m: m.set_options(component=3), "choose another"),
        (True, lambda m: m.set_options(component_at=(1.0, 1.0)), "only background at the place"),
        (True, _cross, "The outline crosses itself; move its points"),
        (True, _coincide, "The outline has two points in one place"),
        (True, _coincide_at_the_end, "The outline has two points in one place"),
        (False, lambda m: m.set_options(method="alpha"), "choose Colour or Brightness"),
        (False, lambda m: m.set_options(threshold=1.0), "paint over the shape with Scribbles"),
        (False, lambda m: m.set_options(threshold=0.0, invert=False), "with Scribbles"),
    ],
)
def test_a_problem_is_told_in_plain_words(
    alpha: bool, act: Callable[[TracingModel], object], words: str
) -> None:
    tracer = CageTracer(_disc(alpha))
    act(tracer.tracing_model)
    (problem,) = tracer.shown["problems"]
    assert words in problem["message"]
    # The sentence names no option, no coordinates and no code.
    assert not re.search(r"[=_()]|'\w+'|\d\.\d|edges|exterior loop", problem["message"])


def png(image: np.ndarray) -> bytes:
    buffer = io.BytesIO()
    Image.fromarray(image).save(buffer, format="PNG")
    return buffer.getvalue()


class TestUpload:
    def send(self, page: Page, data: bytes, part: int) -> str | None:
        for start in range(0, len(data), part):
            refusal = page.ask(
                "upload",
                (data[start : start + part],),
                name="a.png",
                size=len(data),
                start=start,
            )
        return refusal

    @pytest.mark.parametrize("part", [100, 1 << 20])
    def test_a_file_arrives_in_parts(self, part: int) -> None:
        tracer = CageTracer()
        assert self.send(Page(tracer), png(DRAWING), part) is None
        assert (tracer.image == DRAWING).all()
        assert cage_of(tracer).n_holes == 2
        assert tracer.picture

    def test_what_is_no_picture_changes_nothing(self, tracer: CageTracer, page: Page) -> None:
        cage = tracer.cage
        refusal = self.send(page, b"no picture at all", 5)
        assert refusal is not None
        assert refusal.startswith("a.png is not in a picture format")
        assert tracer.cage is cage

    def test_a_damaged_file_is_called_by_its_name(self, page: Page) -> None:
        refusal = self.send(page, png(DRAWING)[:300], 1 << 20)
        assert refusal is not None
        assert refusal.startswith("a.png is damaged or cut short")
        refusal = self.send(page, png(np.zeros((1, MAX_SIDE + 1, 3), np.uint8)), 1 << 20)
        assert refusal is not None
        assert refusal.startswith("a.png is too large")

    def test_a_part_that_is_missing_is_noticed(self, page: Page) -> None:
        data = png(DRAWING)
        page.ask("upload", (data[:100],), name="a.png", size=len(data), start=0)
        refusal = page.ask("upload", (data[200:],), name="a.png", size=len(data), start=200)
        assert refusal is not None
        assert "interrupted" in refusal

    def test_too_large_a_file_is_refused_at_its_first_part(self, page: Page) -> None:
        refusal = page.ask("upload", (b"x",), name="a.png", size=1 << 40, start=0)
        assert refusal is not None
        assert "can be uploaded" in refusal


def test_code_and_hand_share_the_model(tracer: CageTracer) -> None:
    seen: list[float | None] = []
    stop = tracer.on_change(lambda: seen.append(tracer.options.offset))
    tracer.tracing_model.set_options(offset=3)
    assert tracer.shown["options"]["offset"] == 3
    Page(tracer).ask("undo")
    assert seen == [3, None]
    stop()
    other = CageTracer(model=tracer.tracing_model)
    Page(other).ask("set_options", changes={"offset": 5})
    assert tracer.shown["options"]["offset"] == 5
    other.close()
    tracer.tracing_model.set_options(offset=7)
    assert tracer.shown["options"]["offset"] == 7


def test_a_slider_drag_is_one_step(tracer: CageTracer, page: Page) -> None:
    for offset in (1, 2, 3):
        page.ask("set_options", changes={"offset": offset}, gesture="page 1/4")
    page.ask("undo")
    assert tracer.options.offset is None


def test_wrong_arguments() -> None:
    with pytest.raises(ValueError, match="not both"):
        CageTracer(DRAWING, model=TracingModel())
    with pytest.raises(TraceError, match="does not exist"):
        CageTracer("nowhere.png")
    assert CageTracer(DRAWING, TraceOptions(offset=2)).options.offset == 2


def test_the_picture_is_sent_only_when_it_changes(tracer: CageTracer) -> None:
    before = tracer.picture
    tracer.tracing_model.set_options(offset=3)
    assert tracer.picture is before
    tracer.tracing_model.open(samples.image("bar"))
    assert tracer.picture is not before
