"""A list of things with names: the pins of a pose, the parts of a session."""

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field
from typing import Any, Literal

import traitlets

from glid_nb.page import bundle, stylesheet
from glid_nb.widgets.closing import ClosingWidget
from glid_nb.widgets.pad import answer_during_cells
from glid_nb.widgets.page_widget import PageWidget

Switch = Literal["hidden", "locked"]


@dataclass(frozen=True)
class Row:
    """What a list says of one thing."""

    key: int
    """What tells it from the others."""
    name: str
    number: str = ""
    """Stands before the name."""
    unnamed: str = ""
    """Stands there without a name."""
    detail: str = ""
    """Stands behind the name, such as the place."""
    said: str = ""
    """What a screen reader says of the detail."""
    group: int = 0
    """Things with the same number above 0 belong together."""
    picture: str = ""
    """A small picture as a data URI."""
    switches: Mapping[Switch, bool] = field(default_factory=dict)
    """What can be switched for it, and whether it is on."""


class RowList(ClosingWidget, PageWidget):
    """A list whose rows are selected, renamed, hidden and locked.

    A click selects; with ``several``, Shift selects all between and Ctrl one more. A double click
    or F2 renames. Arrow keys go from row to row, and to the buttons of a row. The list changes
    nothing: it calls ``on_choose(keys)``, ``on_switch(key)`` (one more, or one less),
    ``on_set(key, switch, on)`` and ``on_rename(key, name)``, and shows what `show` is given.
    """

    _script = traitlets.Unicode(bundle("rows")).tag(sync=True)
    _css = stylesheet("rows")

    label = traitlets.Unicode().tag(sync=True)  # what the list holds, for screen readers
    nothing = traitlets.Unicode().tag(sync=True)  # what an empty list says
    rows = traitlets.List(traitlets.Dict()).tag(sync=True)
    """The fields of each `Row`."""
    chosen = traitlets.List(traitlets.Int()).tag(sync=True)
    """The keys of the selected rows; the last one counts most."""
    several = traitlets.Bool(False).tag(sync=True)  # whether several can be selected

    def __init__(
        self,
        label: str,
        nothing: str = "",
        *,
        several: bool = False,
        on_choose: Callable[[list[int]], None],
        on_set: Callable[[int, Switch, bool], None],
        on_rename: Callable[[int, str], None],
        on_switch: Callable[[int], None] = lambda _: None,
        **kwargs: Any,
    ) -> None:
        self._acts: dict[str, Callable[[dict[str, Any]], None]] = {
            "choose": lambda said: on_choose(said["keys"]),
            "switch": lambda said: on_switch(said["key"]),
            "set": lambda said: on_set(said["key"], said["name"], said["on"]),
            "rename": lambda said: on_rename(said["key"], said["name"]),
        }
        super().__init__(label=label, nothing=nothing, several=several, **kwargs)
        answer_during_cells(self)
        self.on_msg(lambda _, said, __: self.act(said))

    def act(self, said: dict[str, Any]) -> None:
        """Do what the page says: a ``type`` and what belongs to it."""
        self._acts[said["type"]](said)

    def show(self, rows: list[Row], chosen: list[int]) -> None:
        """Show these rows, and which are selected, in one message."""
        with self.hold_sync():
            self.rows = [asdict(row) for row in rows]
            self.chosen = chosen
