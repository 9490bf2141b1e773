"""The lists of pins and of parts, without a browser."""

from __future__ import annotations

from glid_nb.session.deformation import Deformation
from glid_nb.session.editor_model import EditorModel
from glid_nb.widgets.parts_panel import PartsPanel
from glid_nb.widgets.pins import PinBar

from ..session.test_parts import BLUE, RED
from ..support.domains import domain


def test_the_list_of_pins_selects_renames_locks_and_hides() -> None:
    with Deformation(domain("ring"), begin=False) as model:
        model.paused = True  # nothing here needs a solve
        bar = PinBar(model)
        model.add_handles([(2, 0), (-2, 0.25), (0, 2), (0, -2)])
        act = bar.list.act
        act({"type": "choose", "keys": [3, 1]})
        assert model.selection == (3, 1)
        act({"type": "switch", "key": 0})
        assert model.selection == tuple(bar.list.chosen) == (3, 1, 0)
        act({"type": "switch", "key": 1})
        assert model.selection == (3, 0)
        bar.group.click()
        assert [row["group"] for row in bar.list.rows] == [1, 0, 0, 1]
        act({"type": "switch", "key": 2})
        act({"type": "switch", "key": 3})  # with its group
        assert model.selection == (2,)
        act({"type": "set", "key": 1, "name": "locked", "on": True})
        act({"type": "set", "key": 1, "name": "hidden", "on": True})
        assert [row["switches"] for row in bar.list.rows][1] == {"hidden": True, "locked": True}
        assert model.selection == (2,)  # its own row is enough
        act({"type": "rename", "key": 1, "name": "tail"})
        assert model.pose.names.tolist() == ["", "tail", "", ""]
        act({"type": "set", "key": 9, "name": "locked", "on": True})  # it was just removed
        assert bar.refusal.value
        model.remove_handles(0, 3)
        assert [row["key"] for row in bar.list.rows] == [0, 1]
        bar.close()


def test_the_list_of_parts_is_of_the_same_kind() -> None:
    model = EditorModel(parts={"red": RED, "blue": BLUE})
    panel = PartsPanel(model)
    try:
        front, back = panel.rows.rows
        assert (front["name"], back["name"]) == ("blue", "red")  # the foremost first
        assert front["picture"].startswith("data:image/png")
        state = model.deformation.state
        assert panel.rows.chosen == [state.keys[state.part]]
        panel.rows.act({"type": "choose", "keys": [front["key"]]})
        assert panel.name.value == "blue"
        panel.rows.act({"type": "set", "key": back["key"], "name": "hidden", "on": True})
        assert panel.rows.rows[1]["switches"] == {"hidden": True}
        panel.rows.act({"type": "set", "key": front["key"], "name": "hidden", "on": True})
        assert "only visible part" in panel.refusal.value
        panel.rows.act({"type": "rename", "key": back["key"], "name": "ball"})
        assert panel.rows.rows[1]["name"] == "ball"
        panel.rows.act({"type": "choose", "keys": [99]})  # it was just removed
        assert panel.name.value == "blue"
    finally:
        panel.close()
        model.close()
