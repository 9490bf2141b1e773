"""Controls of a method's own settings, made from what the method says of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Literal, get_args, get_origin

import ipywidgets

from glid_nb.solvers import Method

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
        self._method: Method | None = None
        self._built: str | None = None
        self.controls: dict[str, Any] = {}
        """By the setting's name."""
        layout = ipywidgets.Layout(
            grid_template_columns=f"{LABEL_WIDTH} minmax(0, 1fr)", grid_gap="2px 8px"
        )
        super().__init__([], layout=layout)

    def show(self, method: Method) -> None:
        """Bring the rows up to date."""
        if method == self._method:
            return
        self._method = None  # what the controls tell meanwhile comes from here
        if method.name != self._built:
            self._build(method)
        for name, control in self.controls.items():
            control.value = getattr(method, name)
        self._method = method

    def _build(self, method: Method) -> None:
        old = self.children
        kinds, controls = method.kinds(), {}
        for name, default in method.defaults().items():
            control = _control(kinds[name], default)
            if control is not None:
                control.observe(self._changed, ["value"])
                controls[name] = control
        self.controls, self._built = controls, method.name
        rows = [(ipywidgets.Label(name.replace("_", " ")), c) for name, c in controls.items()]
        self.children = [part for row in rows for part in row]
        self.layout.display = None if rows else "none"
        for part in old:
            part.close()

    def _changed(self, _: Any) -> None:
        method = self._method
        if method is None:
            return
        values = {name: control.value for name, control in self.controls.items()}
        hidden = {k: v for k, v in method.settings.items() if k not in values}
        own = {k: v for k, v in values.items() if v != method.defaults()[k]}
        self._method = None  # whatever becomes of it is shown
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
