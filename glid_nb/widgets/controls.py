"""Buttons, messages, and the base of boxes of controls over a deformation."""

import html
import threading
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import ipywidgets

from glid_nb._errors import InputError
from glid_nb.session.deformation import Deformation
from glid_nb.widgets.closing import ClosingWidget

# The style of texts about refused actions, legible in any theme.
REFUSED = "color:color-mix(in srgb, #d55e00 75%, var(--jp-ui-font-color1, #222))"


def paragraph(text: str, style: str = "") -> str:
    """Text as HTML."""
    return f"<div style='line-height:1.4;overflow-wrap:anywhere;{style}'>{html.escape(text)}</div>"


def button(
    label: str, icon: str, tooltip: str, act: Callable[[], object], layout: Any = "auto"
) -> ipywidgets.Button:
    """A button whose click calls ``act``. ``layout`` is its width or a shared layout."""
    layout = {"width": layout, "flex": "0 0 auto"} if isinstance(layout, str) else layout
    made = ipywidgets.Button(description=label, icon=icon, tooltip=tooltip, layout=layout)
    made.on_click(lambda _: act())
    return made


def toggle(label: str, icon: str, tooltip: str, layout: Any) -> ipywidgets.ToggleButton:
    """A button that stays pressed."""
    return ipywidgets.ToggleButton(description=label, icon=icon, tooltip=tooltip, layout=layout)


def heading(text: str) -> ipywidgets.HTML:
    """The title of a part of the inspector."""
    return ipywidgets.HTML(f"<h4>{html.escape(text)}</h4>").add_class("glid-heading")


class FieldRows(ipywidgets.GridBox):
    """Rows of labels and controls. Changes, also by `show`, call ``on_change(name, value)``."""

    def __init__(
        self,
        controls: Mapping[str, tuple[str, Any]],
        on_change: Callable[[str, Any], None] | None = None,
    ) -> None:
        self._on_change = on_change
        columns = "76px minmax(0, 1fr)"  # in the inspector, for the longest name of an energy
        super().__init__([], layout={"grid_template_columns": columns, "grid_gap": "4px 8px"})
        self.build(controls)

    def build(self, controls: Mapping[str, tuple[str, Any]]) -> None:
        """Show these rows. ``controls`` has a label and a control for each field's name."""
        old = self.children
        self.controls: dict[str, Any] = {name: one for name, (_, one) in controls.items()}
        if (act := self._on_change) is not None:
            for name, control in self.controls.items():
                control.observe(lambda change, name=name: act(name, change["new"]), "value")
        rows = ((ipywidgets.Label(label), control) for label, control in controls.values())
        self.children = [part for row in rows for part in row]
        self.layout.display = "none" if not controls else None
        for part in old:
            part.close()

    def show_row(self, name: str, shown: bool) -> None:
        """Show or hide a row."""
        first = 2 * list(self.controls).index(name)
        for part in self.children[first : first + 2]:
            part.layout.display = None if shown else "none"

    def show(self, value: Any) -> None:
        """Show the fields of a value."""
        for name, control in self.controls.items():
            control.value = getattr(value, name)


class EditControls(ClosingWidget, ipywidgets.VBox):
    """Controls of a deformation. A subclass makes them, then calls this constructor."""

    def __init__(
        self, deformation: Deformation, children: Sequence[ipywidgets.Widget], **kwargs: Any
    ) -> None:
        self.deformation = deformation  # the model of this view
        self.refusal = ipywidgets.HTML().add_class("glid-refusal")
        """Why the last change was refused."""
        # Whether controls follow the model. Per thread, because another thread may use them.
        self._following = threading.local()
        super().__init__([*children, self.refusal], **kwargs)
        self._follow()
        self._endings = (deformation.observe(self._on_model),)

    def _show(self) -> None:
        raise NotImplementedError

    def _on_model(self, what: str) -> None:
        if what == "state" and not self.deformation.dragged:
            self.refusal.value = ""
            self._follow()

    def _follow(self) -> None:
        with self.deformation.locked():  # another thread may show another moment
            self._following.now = True
            try:
                self._show()
            finally:
                self._following.now = False

    def _bind(self, control: ipywidgets.Widget, act: Callable[[Any], None]) -> None:
        control.observe(lambda change: self._act(lambda: act(change["new"])), ["value"])

    def _act(self, act: Callable[[], None]) -> None:
        if getattr(self._following, "now", False):
            return
        try:
            act()
            self.refusal.value = ""
        except InputError as error:
            self.refusal.value = paragraph(error.plain, REFUSED)
            self._follow()
