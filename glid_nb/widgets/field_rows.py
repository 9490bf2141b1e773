"""Rows of controls for the fields of a value."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Literal, get_args, get_origin

import ipywidgets

LABEL_WIDTH = "124px"
FULL = {"width": "auto"}


class FieldRows(ipywidgets.GridBox):
    """A row for each of several fields of a value: a label, and a control that shows the field.

    Parameters
    ----------
    on_change : callable
        Called with a field's name and its value when a control changes, by hand or by `show`.
    """

    def __init__(self, on_change: Callable[[str, Any], None]) -> None:
        self._on_change = on_change
        self.controls: dict[str, Any] = {}
        """By the field's name."""
        columns = f"{LABEL_WIDTH} minmax(0, 1fr)"
        super().__init__([], layout={"grid_template_columns": columns, "grid_gap": "2px 8px"})

    def build(self, controls: Mapping[str, tuple[str, Any]]) -> None:
        """Have these rows from now on: by the field's name a label and a control."""
        old = self.children
        self.controls = {name: control for name, (_, control) in controls.items()}
        for name, control in self.controls.items():
            control.observe(lambda change, name=name: self._on_change(name, change["new"]), "value")
        rows = ((ipywidgets.Label(label), control) for label, control in controls.values())
        self.children = [part for row in rows for part in row]
        self.layout.display = None if controls else "none"
        for part in old:
            part.close()

    def show(self, value: Any) -> None:
        """Show the fields of a value."""
        for name, control in self.controls.items():
            control.value = getattr(value, name)


def control_of(kind: Any, default: Any) -> Any:
    """A control for values of an annotated kind; None where there is none."""
    if get_origin(kind) is Literal:
        return ipywidgets.Dropdown(options=get_args(kind), value=default, layout=FULL)
    if kind is bool:
        return ipywidgets.Checkbox(default, indent=False, layout=FULL)
    if kind is int:
        return ipywidgets.IntText(default, continuous_update=False, layout=FULL)
    if kind is float:
        return ipywidgets.FloatText(default, continuous_update=False, layout=FULL)
    return None
