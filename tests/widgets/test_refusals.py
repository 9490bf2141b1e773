"""Why an action was refused stays on the canvas until it can be read."""

from __future__ import annotations

from typing import Any

from glid_nb.session.deformation import Deformation
from glid_nb.widgets import DeformCanvas

from ..support import shapes
from ..support.domains import domain


def test_a_refusal_in_a_drag_stays_until_the_next_gesture() -> None:
    with Deformation(domain("ring"), begin=False) as model:
        model.paused = True  # nothing here needs a solve
        canvas = DeformCanvas(shapes.picture(), model, n_vertices=200)

        def send(*kinds: str, x: float = 2.0, y: float = 0.0, **more: Any) -> str | None:
            event = {"x": x, "y": y, "button": 0, "shift": False, "reach": 0.3, "unit": 0.02}
            return canvas.handle([{**event, "type": kind, **more} for kind in kinds])

        def shown() -> str:
            return canvas.pane.stage.notice

        model.add_handle((2, 0))
        model.select([0])
        model.set_method("mls")
        send("down", x=3, part="turn")
        refused = send("move", y=1, part="turn")
        assert refused is not None
        assert "cannot hold the angle" in refused
        for _ in range(3):
            assert send("move", y=2, part="turn") is None
            assert shown() == refused
        send("up", y=2)
        assert shown() == refused
        send("down", x=2)
        assert shown() == ""

        # A batch that begins another gesture shows what that one does.
        send("cancel")
        send("down", x=3, part="turn")
        assert send("move", y=1, part="turn") == shown() == refused
        assert send("up", "down", "move", x=2) is None
        assert shown() == ""
        canvas.close()
