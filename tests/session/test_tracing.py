"""The tracer's model, driven like the page drives it."""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import skimage.data
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, rule
from numpy.typing import NDArray

from glid_nb import samples
from glid_nb.geometry import Cage, GeometryError
from glid_nb.imaging import Scribbles, TraceError, TraceOptions
from glid_nb.session.document import Document
from glid_nb.session.document_file import load_document, save_document
from glid_nb.session.tracing import TracingModel, TracingOutcome

from ..support.drawing import DRAWING, IN_SMALL_DISC, far_vertex


@pytest.fixture
def model() -> TracingModel:
    return TracingModel(DRAWING)


def cage_of(model: TracingModel) -> Cage:
    assert model.cage is not None
    return model.cage


def assert_same_loops(a: TracingModel | TracingOutcome, loops: tuple[NDArray, ...]) -> None:
    assert len(a.loops) == len(loops)
    for one, other in zip(a.loops, loops, strict=True):
        np.testing.assert_array_equal(one, other)


def test_a_picture_is_traced_at_once(model: TracingModel) -> None:
    assert model.problems == ()
    assert model.cage is not None
    assert model.domain is not None
    assert model.domain.cage is model.cage
    assert model.cage.n_holes == 2
    assert [hole.kept for hole in model.holes] == [True, True]
    assert not model.can_undo
    assert not model.can_redo
    assert not model.edited


def test_a_guess_is_no_outline_until_somebody_accepts_it() -> None:
    model = TracingModel(skimage.data.cat())
    assert model.doubt
    assert (model.loops, model.holes) == ((), ())
    guess = cage_of(model)  # what code deforms
    with pytest.raises(GeometryError, match="no outline yet"):
        model.cut([(-10, 100), (500, 100)])

    model.accept_guess()
    assert model.doubt == ""
    assert len(model.loops) == 1 + guess.n_holes
    assert len(model.holes) >= guess.n_holes
    assert cage_of(model).equals(guess)
    model.accept_guess()  # accepted already: no other step
    model.undo()
    assert model.loops == ()
    assert not model.can_undo

    # Whoever chooses options wants to see what they do.
    model.set_options(smoothing=3.0)
    assert model.doubt == ""
    assert model.loops
    model.open(skimage.data.coffee())
    assert model.doubt
    assert model.loops == ()


def test_the_outline_of_a_session_is_no_guess(tmp_path: Path) -> None:
    guessed = TracingModel(skimage.data.cat())
    cage, domain, image = cage_of(guessed), guessed.domain, guessed.image
    assert domain is not None
    assert image is not None
    document = Document(image, cage, domain, guessed.options, None, (), 0)
    save_document(document, tmp_path / "cat.glid")
    opened = TracingModel.from_document(load_document(tmp_path / "cat.glid"))
    assert (opened.doubt, opened.edited) == ("", False)
    assert len(opened.loops) == 1 + cage.n_holes


def test_without_a_picture_there_is_nothing_and_no_error() -> None:
    model = TracingModel()
    assert (model.cage, model.domain, model.loops, model.holes) == (None, None, (), ())
    with pytest.raises(TraceError, match="no picture"):
        model.move_vertex(0, 0, (1, 1))
    model.set_options(method="color")
    model.open(DRAWING)
    assert cage_of(model).n_holes == 2
    assert model.undo()
    assert model.cage is None


def test_an_unreadable_picture_changes_nothing(model: TracingModel, tmp_path: Path) -> None:
    before = model.state
    for source in (b"no picture", tmp_path / "nowhere.png", np.zeros((0, 3))):
        with pytest.raises(TraceError):
            model.open(source)
    assert model.state is before


def test_options_with_which_tracing_fails_change_nothing(
    model: TracingModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    before, cage = model.state, cage_of(model)

    def fail(*_: object) -> None:
        raise MemoryError

    with monkeypatch.context() as broken:
        broken.setattr("glid_nb.session.tracing.Tracer.trace", fail)
        with pytest.raises(MemoryError):
            model.set_options(smoothing=2.0)
    assert model.state is before
    assert cage_of(model).equals(cage)


def test_a_blur_wider_than_the_picture_is_a_problem_and_undone(model: TracingModel) -> None:
    cage = cage_of(model)
    model.set_options(smoothing=1e9)
    [problem] = model.outcome.problems
    assert "smoothing is 1e+09 pixels" in str(problem)
    model.undo()
    assert cage_of(model).equals(cage)


def test_the_picture_is_the_models_own() -> None:
    pixels = DRAWING.copy()
    model = TracingModel(pixels)
    pixels[:] = 0
    assert model.image is not None
    assert (model.image == DRAWING).all()


class TestOptions:
    def test_the_outline_follows(self, model: TracingModel) -> None:
        area = cage_of(model).area
        model.set_options(offset=8)
        assert cage_of(model).area > area
        model.set_options(component=1)
        assert cage_of(model).n_holes == 0
        model.undo()
        model.undo()
        assert cage_of(model).area == area

    def test_a_slider_is_one_step(self, model: TracingModel) -> None:
        before = model.state
        for offset in (1, 2, 3, 4):
            model.set_options(offset=offset, gesture="slider 1")
        assert model.options.offset == 4
        model.undo()
        assert model.state is before
        model.redo()
        assert model.options.offset == 4

    def test_two_gestures_are_two_steps(self, model: TracingModel) -> None:
        model.set_options(offset=1, gesture="slider 1")
        model.set_options(offset=2, gesture="slider 2")
        model.undo()
        assert model.options.offset == 1

    def test_a_gesture_does_not_go_on_after_an_undo(self, model: TracingModel) -> None:
        model.set_options(offset=1)
        model.set_options(offset=2, gesture=1)
        model.undo()
        model.set_options(offset=3, gesture=1)
        model.undo()
        assert model.options.offset == 1

    def test_no_change_is_no_step(self, model: TracingModel) -> None:
        model.set_options(offset=model.options.offset)
        assert not model.can_undo

    @pytest.mark.parametrize(
        ("changes", "culprit"),
        [
            ({"offset": -1}, "offset"),
            ({"ofset": 1}, "did you mean 'offset'"),
            ({"threshold": float("nan")}, "threshold"),
            ({"method": "magic"}, "method"),
            ({"scribbles": Scribbles([[[1, 1]]])}, "paint"),
        ],
    )
    def test_a_wrong_value_changes_nothing(
        self, model: TracingModel, changes: dict, culprit: str
    ) -> None:
        before = model.state
        with pytest.raises(TraceError, match=culprit):
            model.set_options(**changes)
        assert model.state is before

    def test_a_tracing_that_fails_keeps_the_last_cage(self, model: TracingModel) -> None:
        cage, loops = model.cage, model.outcome.loops
        model.set_options(method="color", threshold=0.999)
        assert "no foreground" in model.problems[0].message
        assert model.problems[0].point is None
        assert model.cage is cage
        assert_same_loops(model.outcome, loops)
        model.set_options(component=7)  # one failure after the other
        assert model.cage is cage
        model.set_options(component=0, threshold=None)
        assert model.problems == ()

    def test_a_picture_without_a_shape_is_a_problem(self) -> None:
        model = TracingModel(np.full((20, 20), 128, np.uint8))
        assert "one colour only" in model.problems[0].message
        assert model.cage is None
        assert model.loops == ()

    def test_picking(self, model: TracingModel) -> None:
        model.pick_component(IN_SMALL_DISC)
        assert cage_of(model).n_holes == 0
        assert model.outcome.tracing is not None
        assert model.outcome.tracing.component.rank == 1
        model.pick_background((2.0, 2.0))
        assert model.options.method == "color"
        assert model.options.background_at == (2.0, 2.0)
        with pytest.raises(TraceError, match="outside the image"):
            model.pick_background((-2.0, 2.0))


class TestScribbles:
    def test_painting_traces_by_the_strokes(self, model: TracingModel) -> None:
        model.paint("foreground", [(60, 20), (60, 100)])
        assert model.options.method == "scribbles"
        assert model.problems == ()
        model.paint("background", [(5, 5), (5, 115), (155, 115), (155, 5)])
        assert model.state.scribbles is not None
        assert len(model.state.scribbles.background) == 1
        first, second = cage_of(model), model.state.scribbles
        model.undo()
        assert model.state.scribbles is not second
        model.redo()
        assert model.state.scribbles is second
        assert_same_loops(model.outcome, first.loops)

    def test_choosing_the_method_first_asks_for_strokes(self, model: TracingModel) -> None:
        cage = model.cage
        model.set_options(method="scribbles")
        assert "draw some over the shape" in model.problems[0].message
        assert model.cage is cage
        model.paint("foreground", [(60, 20), (60, 100)])
        assert model.problems == ()

    def test_strokes_survive_another_method(self, model: TracingModel) -> None:
        model.paint("foreground", [(60, 20), (60, 100)])
        painted = model.state.scribbles
        model.set_options(method="color")
        assert model.options.scribbles is None
        assert model.state.scribbles is painted
        model.set_options(method="scribbles")
        assert model.options.scribbles is painted
        model.clear_scribbles()
        assert model.state.scribbles is None

    @pytest.mark.parametrize("stroke", [[], [1, 2], [[1, 2, 3]], [[float("nan"), 1]], "line", None])
    def test_a_wrong_stroke_changes_nothing(self, model: TracingModel, stroke: object) -> None:
        before = model.state
        with pytest.raises(TraceError):
            model.paint("foreground", stroke)  # type: ignore[arg-type]
        assert model.state is before

    def test_masks_are_not_painted_over(self) -> None:
        mask = np.zeros((120, 160), bool)
        mask[60, 20:40] = True
        model = TracingModel(DRAWING, TraceOptions(scribbles=Scribbles(mask), method="scribbles"))
        assert model.problems == ()
        with pytest.raises(TraceError, match="mask"):
            model.paint("foreground", [[1, 1]])
        model.paint("background", [[2, 2]])


class TestHoles:
    def test_dropping_and_keeping(self, model: TracingModel) -> None:
        before = model.outcome.loops
        model.toggle_hole(0)
        assert [hole.kept for hole in model.holes] == [False, True]
        assert cage_of(model).n_holes == 1
        model.toggle_hole(0)
        assert [hole.kept for hole in model.holes] == [True, True]
        assert_same_loops(model.outcome, before)
        model.set_options(min_hole_area=1000)
        assert [hole.kept for hole in model.holes] == [True, False]  # the first was kept by hand
        model.toggle_hole(1)
        assert [hole.kept for hole in model.holes] == [True, True]

    def test_other_loops_keep_their_edits(self, model: TracingModel) -> None:
        i = far_vertex(model)
        x, y = model.loops[0][i]
        model.move_vertex(0, i, (x - 3, y))
        moved = model.outcome.loops[0]
        model.toggle_hole(1)
        assert cage_of(model).n_holes == 1
        np.testing.assert_array_equal(model.outcome.loops[0], moved)
        model.toggle_hole(1)
        assert cage_of(model).n_holes == 2
        np.testing.assert_array_equal(model.outcome.loops[0], moved)
        assert model.edited
        assert model.problems == ()

    def test_there_must_be_such_a_hole(self, model: TracingModel) -> None:
        with pytest.raises(TraceError, match="there are 2"):
            model.toggle_hole(2)


class TestVertices:
    def test_moving_adding_deleting(self, model: TracingModel) -> None:
        before = model.state
        n = cage_of(model).n_vertices
        i = far_vertex(model)
        x, y = model.loops[0][i]
        model.move_vertex(0, i, (x - 2, y + 1))
        np.testing.assert_allclose(model.loops[0][i], (x - 2, y + 1), atol=1e-12)
        a, b = model.loops[0][i], model.loops[0][(i + 1) % len(model.loops[0])]
        loop, index = model.insert_vertex(tuple((a + b) / 2))
        assert (loop, index) == (0, i + 1)
        np.testing.assert_allclose(model.loops[0][index], (a + b) / 2, atol=1e-9)
        assert cage_of(model).n_vertices == n + 1
        model.delete_vertices([(0, i), (0, i + 1)])
        assert cage_of(model).n_vertices == n - 1
        for _ in range(3):
            model.undo()
        assert model.state is before
        assert cage_of(model).n_vertices == n

    def test_the_other_vertices_stay_bit_for_bit(self, model: TracingModel) -> None:
        before = model.outcome.loops
        i = far_vertex(model)
        model.move_vertex(0, i, (5.0, 50.0))
        after = model.outcome.loops
        np.testing.assert_array_equal(
            np.delete(before[0], i, axis=0), np.delete(after[0], i, axis=0)
        )
        assert_same_loops(model.outcome, (after[0], *before[1:]))

    def test_a_crossing_is_shown_and_the_last_cage_is_kept(self, model: TracingModel) -> None:
        cage = model.cage
        i = far_vertex(model)
        model.move_vertex(0, i, (150.0, 60.0))
        (problem,) = model.problems
        assert "cross" in problem.message
        assert problem.point is not None
        x, y = problem.point
        assert 0 < x < 160
        assert 0 < y < 120
        # The place is on the dragged vertex's edges.
        loop = model.loops[0]
        ends = np.array([loop[i - 1], loop[(i + 1) % len(loop)]])
        along = np.array([150.0, 60.0]) - ends
        gap = np.abs(along[:, 0] * (y - ends[:, 1]) - along[:, 1] * (x - ends[:, 0]))
        assert (gap / np.hypot(*along.T)).min() < 1e-6
        assert model.cage is cage
        np.testing.assert_allclose(model.loops[0][i], (150.0, 60.0), atol=1e-12)
        model.move_vertex(0, i, (8.0, 60.0))
        assert model.problems == ()
        assert model.cage is not cage

    def test_a_hole_dragged_out_names_the_hole(self, model: TracingModel) -> None:
        for i in range(len(model.loops[2])):
            x, y = model.loops[2][i]
            model.move_vertex(2, i, (x, y - 58), gesture=1)
        assert "hole 2" in model.problems[0].message
        model.undo()
        assert model.problems == ()

    def test_a_drag_is_one_step(self, model: TracingModel) -> None:
        before = model.state
        i = far_vertex(model)
        for x in range(12, 4, -1):
            model.move_vertex(0, i, (x, 60.0), gesture=("drag", 7))
        model.undo()
        assert model.state is before
        model.redo()
        np.testing.assert_allclose(model.loops[0][i], (5.0, 60.0), atol=1e-12)

    def test_deleting_a_whole_hole(self, model: TracingModel) -> None:
        model.delete_vertices([(1, i) for i in range(len(model.loops[1]) - 2)])
        assert cage_of(model).n_holes == 1
        assert model.problems == ()

    def test_the_exterior_keeps_three(self, model: TracingModel) -> None:
        before = model.state
        with pytest.raises(GeometryError, match="at least 3"):
            model.delete_vertices([(0, i) for i in range(len(model.loops[0]) - 2)])
        assert model.state is before

    @pytest.mark.parametrize(
        ("loop", "index", "to", "culprit"),
        [
            (3, 0, (1, 1), "no loop 3"),
            (0, 999, (1, 1), "no vertex 999"),
            (0, -1, (1, 1), "no vertex -1"),
            (0, 0, (float("nan"), 1), "finite"),
            (0, 0, (1, 2, 3), "pair"),
            (0, 0, None, "pair"),
        ],
    )
    def test_a_wrong_edit_changes_nothing(
        self, model: TracingModel, loop: int, index: int, to: tuple, culprit: str
    ) -> None:
        before = model.state
        with pytest.raises(GeometryError, match=culprit):
            model.move_vertex(loop, index, to)
        assert model.state is before

    def test_an_option_discards_edits_and_undo_brings_them_back(self, model: TracingModel) -> None:
        i = far_vertex(model)
        model.move_vertex(0, i, (5.0, 60.0))
        edited = model.outcome.loops
        model.set_options(offset=4)
        assert not model.edited
        assert model.has_discarded_edits
        model.undo()
        assert not model.has_discarded_edits
        assert_same_loops(model.outcome, edited)
        model.discard_edits()
        assert not model.edited
        model.undo()
        assert model.edited


def test_changes_are_announced(model: TracingModel) -> None:
    seen: list[str] = []
    stop = model.observe(lambda _: seen.append("change"))
    model.set_options(offset=3)
    model.toggle_hole(0)
    model.undo()
    model.redo()
    assert len(seen) == 4
    stop()
    stop()
    model.undo()
    assert len(seen) == 4


@pytest.mark.parametrize("edited", [False, True])
def test_a_document_brings_the_model_back(tmp_path: Path, edited: bool) -> None:
    model = TracingModel(DRAWING, TraceOptions(offset=4))
    model.paint("foreground", [(60, 20), (60, 100)])
    model.set_options(method="color")
    model.toggle_hole(1)
    if edited:
        model.move_vertex(0, far_vertex(model), (5.0, 61.0))
    assert model.image is not None
    assert model.domain is not None
    document = Document(
        model.image, model.domain.cage, model.domain, model.options, model.state.scribbles, (), 0
    )
    save_document(document, tmp_path / "a.glid")
    loaded = load_document(tmp_path / "a.glid")
    again = TracingModel.from_document(loaded)
    assert again.domain is loaded.domain
    assert again.edited == edited
    assert_same_loops(again.outcome, model.outcome.loops)
    assert again.holes[1].kept is False
    assert again.state.scribbles is loaded.scribbles
    assert replace(again.options, scribbles=None) == replace(model.options, scribbles=None)


@pytest.mark.slow
def test_a_large_picture_follows_the_controls() -> None:
    """Well within a second even on a busy machine. Alone it takes under 0.2 s (see benchmarks)."""
    from PIL import Image

    small = Image.fromarray(samples.image("teapot"))
    model = TracingModel(np.asarray(small.resize((2000, 1750))))
    _ = model.outcome
    times = []
    for changes in ({"threshold": 0.4}, {"offset": 4}, {"simplify": 3}, {"min_hole_area": 50}):
        began = time.perf_counter()
        model.set_options(**changes)
        assert model.problems == ()
        times.append(time.perf_counter() - began)
    began = time.perf_counter()
    model.move_vertex(0, 0, tuple(model.loops[0][0] + 0.5))
    assert model.problems == ()
    times.append(time.perf_counter() - began)
    assert sorted(times)[len(times) // 2] < 1.0


POINTS = st.tuples(st.floats(-20, 180), st.floats(-20, 140))


class Fuzz(RuleBasedStateMachine):
    """Any actions in any order: the cage is always valid, and undo is exact."""

    @initialize()
    def start(self) -> None:
        self.model = TracingModel(DRAWING)

    def act(self, name: str, *args: object, **kwargs: object) -> None:
        model = self.model
        before, loops = model.state, model.outcome.loops
        try:
            getattr(model, name)(*args, **kwargs)
        except (TraceError, GeometryError) as error:
            assert str(error)  # noqa: PT017 - a refusal is fine, and changes nothing
            assert model.state is before
            return
        after = model.state
        if after is before:
            return
        shown, problems = model.outcome.loops, model.problems
        assert model.undo()
        assert model.state is before
        assert_same_loops(model.outcome, loops)
        assert model.redo()
        assert model.state is after
        assert_same_loops(model.outcome, shown)
        assert model.problems == problems

    @rule(loop=st.integers(0, 3), index=st.integers(0, 40), to=POINTS)
    def move(self, loop: int, index: int, to: tuple[float, float]) -> None:
        self.act("move_vertex", loop, index, to)

    @rule(at=POINTS)
    def insert(self, at: tuple[float, float]) -> None:
        self.act("insert_vertex", at)

    @rule(chosen=st.lists(st.tuples(st.integers(0, 2), st.integers(0, 30)), max_size=12))
    def delete(self, chosen: list[tuple[int, int]]) -> None:
        self.act("delete_vertices", chosen)

    @rule(number=st.integers(0, 3))
    def toggle(self, number: int) -> None:
        self.act("toggle_hole", number)

    @rule(
        changes=st.sampled_from(
            [
                {"offset": 0},
                {"offset": 6},
                {"offset": 40},
                {"simplify": 0.5},
                {"simplify": 60},
                {"method": "threshold"},
                {"method": "alpha"},
                {"method": "scribbles"},
                {"threshold": 0.9},
                {"threshold": None},
                {"invert": True},
                {"component": 1},
                {"component": 0, "component_at": None},
                {"max_vertices": 9},
                {"min_hole_area": 300},
            ]
        )
    )
    def choose(self, changes: dict[str, object]) -> None:
        self.act("set_options", **changes)

    @rule(brush=st.sampled_from(["foreground", "background"]), a=POINTS, b=POINTS)
    def paint(self, brush: str, a: tuple[float, float], b: tuple[float, float]) -> None:
        self.act("paint", brush, [a, b])

    @rule(name=st.sampled_from(["clear_scribbles", "discard_edits"]))
    def simple(self, name: str) -> None:
        self.act(name)

    @rule(name=st.sampled_from(["pick_background", "pick_component"]), at=POINTS)
    def pick(self, name: str, at: tuple[float, float]) -> None:
        self.act(name, at)

    @rule()
    def go_back(self) -> None:
        self.model.undo()

    @rule()
    def go_forth(self) -> None:
        self.model.redo()

    @invariant()
    def the_cage_is_valid_and_shown_unless_there_is_a_problem(self) -> None:
        if not hasattr(self, "model"):
            return
        domain, outcome = self.model.domain, self.model.outcome
        assert domain is not None
        Cage(domain.cage.exterior, domain.cage.holes)
        if not outcome.problems:
            shown = Cage(outcome.loops[0], outcome.loops[1:])
            assert_same_loops(outcome, outcome.loops)
            for loop, kept in zip(shown.loops, domain.cage.loops, strict=True):
                np.testing.assert_array_equal(loop, kept)
        for problem in outcome.problems:
            assert problem.message


Fuzz.TestCase.settings = settings(max_examples=12, stateful_step_count=25)
TestFuzz = Fuzz.TestCase
TestFuzz.pytestmark = [pytest.mark.slow]  # type: ignore[attr-defined]


class TestDrawnOutlines:
    def test_the_whole_picture(self, model: TracingModel) -> None:
        model.draw()
        cage = cage_of(model)
        assert (cage.n_holes, model.holes, model.problems) == (0, (), ())
        assert np.isclose(cage.area, 20 * 15)
        edges = np.roll(cage.exterior, -1, axis=0) - cage.exterior
        assert np.hypot(*edges.T).max() <= 0.04 * 70 + 1e-9  # all of it can bend
        model.undo()
        assert cage_of(model).n_holes == 2

    def test_a_line_that_crosses_itself_keeps_its_largest_part_in_the_picture(
        self, model: TracingModel
    ) -> None:
        model.draw([(-50, 10), (100, 10), (100, 110), (90, 5), (-50, 110)])
        loop = model.loops[0]
        assert model.problems == ()
        assert loop.min() >= -1e-9
        assert np.all(loop <= [160, 120])

    @pytest.mark.parametrize(
        "line", [[], [(5, 5)], [(5, 5), (50, 50)], [(-9, 0), (-9, 9), (-1, 5)]]
    )
    def test_nothing_enclosed_is_refused(self, model: TracingModel, line: list) -> None:
        before = model.state
        with pytest.raises(GeometryError, match="encloses nothing"):
            model.draw(line)
        assert model.state is before

    def test_what_cannot_be_traced_can_be_drawn_and_saved(self, tmp_path: Path) -> None:
        model = TracingModel(np.full((60, 80, 3), 7, np.uint8))
        assert model.problems
        model.draw([(10, 10), (70, 10), (70, 50), (10, 50)])
        assert model.problems == ()
        assert model.edited
        domain = model.domain
        assert domain is not None
        document = Document(model.image, domain.cage, domain, model.options, None, (), 0)
        save_document(document, tmp_path / "drawn.glid")
        again = TracingModel.from_document(load_document(tmp_path / "drawn.glid"))
        assert again.problems == ()
        assert cage_of(again).equals(domain.cage)


class TestCuts:
    """The disc of the drawing: radius 50 around (60, 60), with holes around (45, 60), (80, 60)."""

    def test_a_slit_is_an_edit_by_hand_that_undo_takes_back(self, model: TracingModel) -> None:
        before = model.state
        assert len(model.cut([(60, 5), (60, 40), (60, 100)])) == 1
        assert model.problems == ()
        assert model.edited
        assert cage_of(model).n_holes == 2
        assert model.frame is not None
        on_the_line, beside = cage_of(model).contains(model.frame.to_world([(60, 50), (58, 50)]))
        assert beside
        assert not on_the_line
        assert model.outcome.tracing is not None  # whose matte and holes are still used
        model.undo()
        assert model.state is before
        model.redo()
        assert model.edited

    def test_a_line_across_keeps_the_largest_piece_and_another_one_can_be_chosen(
        self, model: TracingModel
    ) -> None:
        before, gesture = model.state, object()
        pieces = model.cut([(95, -5), (95, 125)], gesture=gesture)
        assert len(pieces) == 2
        assert cage_of(model).equals(pieces[0])
        model.set_loops(pieces[1].loops, gesture)
        assert cage_of(model).equals(pieces[1])
        assert cage_of(model).area < pieces[0].area
        model.undo()
        assert model.state is before

    def test_a_trembling_line_gets_few_vertices(self, model: TracingModel) -> None:
        count = cage_of(model).n_vertices
        y = np.linspace(5, 90, 200)
        x = 62 + 0.1 * np.sin(40 * y)
        model.cut(np.stack([x, y], axis=1))
        straight = TracingModel(DRAWING)
        straight.cut([(62, 5), (62, 90)])
        assert cage_of(model).n_vertices == cage_of(straight).n_vertices > count

    def test_the_width_is_in_pixels(self, model: TracingModel) -> None:
        area = cage_of(model).area
        model.cut([(55, 100), (65, 90)], width=2)
        lost = area - cage_of(model).area
        assert lost == pytest.approx(2 * np.hypot(10, 10) * (20 / 160) ** 2)

    @pytest.mark.parametrize(
        ("line", "culprit"),
        [
            ([(150, 5), (155, 5)], "misses the shape"),
            ([(60, 100)], "two different points"),
            ([(10, 60), (60, 90), (60, 20), (30, 95)], "crosses itself"),
            ([(10, np.nan), (60, 90)], "finite"),
        ],
    )
    def test_a_wrong_cut_changes_nothing(
        self, model: TracingModel, line: list, culprit: str
    ) -> None:
        before = model.state
        with pytest.raises(GeometryError, match=culprit):
            model.cut(line)
        assert model.state is before

    def test_an_outline_that_is_no_cage_is_not_cut(self, model: TracingModel) -> None:
        model.move_vertex(0, far_vertex(model), (150.0, 60.0))
        before = model.state
        with pytest.raises(GeometryError, match="cross"):
            model.cut([(60, 5), (60, 100)])
        assert model.state is before
        with pytest.raises(GeometryError, match="no outline yet"):
            TracingModel(np.full((60, 80, 3), 7, np.uint8)).cut([(60, 5), (60, 100)])

    def test_other_options_discard_it_and_a_hole_that_is_toggled_does_not(
        self, model: TracingModel
    ) -> None:
        model.cut([(60, 5), (60, 100)])
        count = cage_of(model).n_vertices
        model.toggle_hole(1)
        assert cage_of(model).n_holes == 1
        model.toggle_hole(1)
        assert cage_of(model).n_vertices == count
        model.set_options(offset=4)
        assert model.has_discarded_edits
        model.undo()
        assert cage_of(model).n_vertices == count

    def test_it_is_saved_and_opened(self, model: TracingModel, tmp_path: Path) -> None:
        model.cut([(60, 5), (60, 100)])
        domain = model.domain
        assert domain is not None
        document = Document(model.image, domain.cage, domain, model.options, None, (), 0)
        save_document(document, tmp_path / "cut.glid")
        again = TracingModel.from_document(load_document(tmp_path / "cut.glid"))
        assert again.edited
        assert cage_of(again).equals(domain.cage)
