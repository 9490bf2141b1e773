"""Controls of a method's own settings, made from what the method says of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Literal, get_args, get_origin

import ipywidgets

from glid_nb.methods import MethodChoice

LABEL_WIDTH = "124px"
_FULL = ipywidgets.Layout(width="auto")


class MethodSettings(ipywidgets.GridBox):
    """A row for each setting of the method that is a number, a choice of words or a switch.

    Parameters
    ----------
    on_change : callable
        Called with the settings that are not the method's defaults after one was changed by hand.
    """

    def __init__(self, on_change: Callable[[Mapping[str, Any]], None]) -> None:
        self._on_change = on_change
        self._choice: MethodChoice | None = None
        self._built: str | None = None
        self.controls: dict[str, Any] = {}
        """By the setting's name."""
        layout = ipywidgets.Layout(
            grid_template_columns=f"{LABEL_WIDTH} minmax(0, 1fr)", grid_gap="2px 8px"
        )
        super().__init__([], layout=layout)

    def show(self, choice: MethodChoice) -> None:
        """Bring the rows up to date."""
        if choice == self._choice:
            return
        self._choice = None  # what the controls tell meanwhile comes from here
        if choice.name != self._built:
            self._build(choice)
        for name, control in self.controls.items():
            control.value = choice.settings.get(name, choice.own_settings[name])
        self._choice = choice

    def _build(self, choice: MethodChoice) -> None:
        old = self.children
        kinds, controls = choice.method.kinds, {}
        for name, default in choice.own_settings.items():
            control = _control(kinds[name], default)
            if control is not None:
                control.observe(self._changed, ["value"])
                controls[name] = control
        self.controls, self._built = controls, choice.name
        rows = [(ipywidgets.Label(name.replace("_", " ")), c) for name, c in controls.items()]
        self.children = [part for row in rows for part in row]
        self.layout.display = None if rows else "none"
        for part in old:
            part.close()

    def _changed(self, _: Any) -> None:
        choice = self._choice
        if choice is None:
            return
        values = {name: control.value for name, control in self.controls.items()}
        hidden = {k: v for k, v in choice.settings.items() if k not in values}
        own = {k: v for k, v in values.items() if v != choice.own_settings[k]}
        self._choice = None  # whatever becomes of it is shown
        self._on_change({**hidden, **own})


def _control(kind: Any, default: Any) -> Any:
    """A control for values of an annotated kind; None where there is none."""
    if get_origin(kind) is Literal:
        return ipywidgets.Dropdown(options=get_args(kind), value=default, layout=_FULL)
    if kind is bool:
        return ipywidgets.Checkbox(default, indent=False, layout=_FULL)
    if kind is int:
        return ipywidgets.IntText(default, continuous_update=False, layout=_FULL)
    if kind is float:
        return ipywidgets.FloatText(default, continuous_update=False, layout=_FULL)
    return None
