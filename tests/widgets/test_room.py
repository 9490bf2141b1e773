"""The canvas fills the room that its editor has on the page."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from glid_nb.session.deformation import Deformation
from glid_nb.widgets import DeformCanvas

from ..support.domains import domain

PICTURE = np.full((40, 40, 4), 255, np.uint8)


@pytest.fixture
def canvas(request: pytest.FixtureRequest) -> Iterator[DeformCanvas]:
    size = getattr(request, "param", {})
    canvas = DeformCanvas(PICTURE, Deformation(domain("ell"), begin=False), n_vertices=50, **size)
    yield canvas
    canvas.close()
    canvas.deformation.close()


def size(canvas: DeformCanvas) -> tuple[int, int]:
    stage = canvas.pane.stage
    assert canvas.layout.height == f"{stage.height}px"
    assert canvas.pane.stage.renderer.width == stage.width
    return stage.width, stage.height


def seen(canvas: DeformCanvas) -> list[float]:
    x, y, unit = canvas.pane.stage.view
    return [x, y, canvas.pane.stage.width * unit, canvas.pane.stage.height * unit]


def test_the_room_is_filled_and_what_was_seen_stays_in_view(canvas: DeformCanvas) -> None:
    assert size(canvas) == (600, 500)
    before = seen(canvas)
    cage = canvas.deformation.state.domain.cage
    for room in ([1200, 640, 0], [900, 700, 0], [500, 1000, 1]):
        canvas.pane.stage.room = room
        assert size(canvas) == tuple(room[:2])
        x, y, across, up = seen(canvas)
        assert [x, y] == before[:2]
        assert min([across, up] / np.ptp(cage.exterior, axis=0)) == pytest.approx(1.12)
    canvas.pane.stage.room = [584, 640, 0]
    assert size(canvas) == (584, 486)  # no taller than usual
    canvas.pane.stage.room = [1800, 1000, 1]
    assert size(canvas) == (1800, 1000)
    canvas.pane.stage.room = [600, 500, 0]
    assert seen(canvas) == pytest.approx(before)
    # If a hand has zoomed meanwhile, the zoomed view stays.
    canvas.pane.stage.view = [0.0, 0.0, 0.01]
    canvas.pane.stage.room = [1200, 1000, 0]
    assert canvas.pane.stage.view[2] == pytest.approx(0.005)


@pytest.mark.parametrize("canvas", [{"width": 500, "height": 300}], indirect=True)
def test_a_size_that_was_asked_for_is_narrower_only_where_there_is_less(
    canvas: DeformCanvas,
) -> None:
    stage = canvas.pane.stage
    for room, expected in (([1200, 640, 0], (500, 300)), ([420, 640, 0], (420, 300))):
        stage.room = room
        assert size(canvas) == expected
    # Dragging the corner sets another size.
    with stage.hold_trait_notifications():
        stage.width, stage.height = 700, 350
    stage.room = [900, 640, 0]
    assert size(canvas) == (700, 350)
    stage.room = [900, 640, 1]
    assert size(canvas) == (900, 640)
    stage.room = [640, 640, 0]
    assert size(canvas) == (640, 350)


@pytest.mark.parametrize(
    ("canvas", "width"), [({}, None), ({"width": 500}, 500)], indirect=["canvas"]
)
def test_a_hand_that_drags_one_side_asks_for_that_side_alone(
    canvas: DeformCanvas, width: int | None
) -> None:
    stage = canvas.pane.stage
    stage.room = [420, 640, 0]
    stage.height = 320
    stage.room = [900, 640, 0]
    assert size(canvas) == (width or 900, 320)
    stage.room = [1200, 700, 0]
    assert size(canvas) == (width or 1200, 320)


def test_a_width_dragged_beside_the_source_is_asked_for_whatever_it_is(
    canvas: DeformCanvas,
) -> None:
    stage = canvas.pane.stage
    stage.room = [1000, 600, 0]
    canvas.show_source = True
    stage.width = 560
    stage.width = 960  # as wide as the two were
    stage.room = [2000, 600, 0]
    assert canvas.source is not None
    assert stage.width + canvas.source.stage.width == 960 + 400


def test_result_and_source_share_the_room(canvas: DeformCanvas) -> None:
    canvas.pane.stage.room = [1000, 600, 0]
    canvas.show_source = True
    assert size(canvas) == (600, 600)
    assert canvas.source is not None
    assert canvas.source.stage.width == 400
    canvas.pane.stage.room = [500, 600, 0]
    assert canvas.pane.stage.width + canvas.source.stage.width == 500
    canvas.show_source = False
    assert size(canvas)[0] == 500
    canvas.pane.stage.room = [1000, 600, 0]
    assert size(canvas) == (1000, 600)
