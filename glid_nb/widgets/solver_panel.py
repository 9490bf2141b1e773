"""Controls of the solver."""

from __future__ import annotations

import html
from collections.abc import Callable, Mapping
from typing import Any, Literal, get_args, get_origin

import ipywidgets

from glid_nb.energies import ENERGIES, CustomEnergy, Energy, energy_by_name
from glid_nb.methods import METHODS
from glid_nb.session.deformation import Deformation
from glid_nb.solvers import Method, Options
from glid_nb.widgets.arguments import check_keywords
from glid_nb.widgets.asking_button import button
from glid_nb.widgets.edit_controls import EditControls

_WORKS_ON = {"harmonic": "", "mesh": " · mesh", "linear": " · linear"}
_CUSTOM = CustomEnergy.label, CustomEnergy.name
_FULL = {"width": "auto"}


class FieldRows(ipywidgets.GridBox):
    """Rows of a label and a control, one for each of several fields of a value.

    ``on_change`` is called with a field's name and value when a control changes, also by `show`.
    """

    def __init__(self, on_change: Callable[[str, Any], None]) -> None:
        self._on_change = on_change
        self.controls: dict[str, Any] = {}
        """By the field's name."""
        columns = "124px minmax(0, 1fr)"
        super().__init__([], layout={"grid_template_columns": columns, "grid_gap": "2px 8px"})

    def build(self, controls: Mapping[str, tuple[str, Any]]) -> None:
        """Show these rows: by the field's name a label and a control."""
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


class SolverPanel(EditControls):
    """Method, energy, weight of the targets, variants of ours, and buttons for the solver.

    Parameters
    ----------
    deformation : Deformation
        The model that the controls change; what code changes there shows here.
    """

    def __init__(self, deformation: Deformation, **kwargs: Any) -> None:
        check_keywords(type(self), kwargs)
        method = FieldRows(self._set_method)
        self.method = _menu(_methods(), "What solves: ours, or another to compare with")
        method.build({"name": ("Method", self.method)})
        self.about = ipywidgets.HTML()
        """What the method does."""
        self.settings = FieldRows(self._set_setting)
        """The method's own settings."""
        self._shown: type[Method] | None = None
        self._energy = FieldRows(self._set_energy)
        self.energy = _menu([(e.label, name) for name, e in ENERGIES.items()], "What is minimised")
        self.s = ipywidgets.BoundedFloatText(
            1.0, min=1e-3, max=100.0, step=0.1, layout=_FULL, tooltip="The energy's parameter s"
        )
        self._energy.build({"name": ("Energy", self.energy), "s": ("s", self.s)})
        self.options = FieldRows(self._set_option)
        """The options, by their names."""
        self.options.build(_option_controls(deformation.state.current.options))
        (
            self.weight,
            self.sampling,
            self.certificate,
            self.hessian,
            self.iterations,
            self.conformal,
        ) = self.options.controls.values()
        self.pause = ipywidgets.ToggleButton(
            description="Pause", icon="pause", tooltip="Let the solver wait", layout=_FULL
        )
        self.step = button("Step", "step-forward", "One frame's iterations", deformation.step)
        self.reset = button("Reset", "refresh", "The undeformed shape (0)", deformation.reset)
        self.clear = button(
            "Clear handles", "eraser", "Let go of all handles", deformation.clear_handles
        )
        buttons = ipywidgets.HBox(
            [self.pause, self.step, self.reset, self.clear], layout={"flex_flow": "row wrap"}
        )
        parts = [method, self.about, self.settings, self._energy, self.options, buttons]
        super().__init__(deformation, parts, **kwargs)
        self.add_class("glid-solver-panel")
        self.method.add_class("glid-method")
        self.energy.add_class("glid-energy")
        self._show()
        self.pause.observe(self._set_paused, ["value"])
        self._watch()

    def _show(self) -> None:
        current = self.deformation.state.current
        with self._while_showing():
            self._show_method(current.method)
            self._show_energy(current.energy)
            self.options.show(current.options)
            for name, control in self.options.controls.items():
                control.disabled = name not in current.method.options
            self.pause.value = self.deformation.paused
            self.step.disabled = not self.deformation.paused

    def _show_method(self, method: Method) -> None:
        self.method.value = method.name
        text = method.summary
        if not method.certified:
            text += (
                " Shown for comparison, without a proof; saved and exported is the last certified "
                "map."
            )
        self.about.value = f"<div style='line-height:1.3;opacity:0.75'>{html.escape(text)}</div>"
        if type(method) is not self._shown:
            self._shown = type(method)
            made = ((k, _control_of(method.kinds()[k], v)) for k, v in method.defaults().items())
            self.settings.build({k: (k.replace("_", " "), c) for k, c in made if c is not None})
        self.settings.show(method)

    def _show_energy(self, energy: Energy) -> None:
        if isinstance(energy, CustomEnergy) and _CUSTOM not in self.energy.options:
            self.energy.options = [*self.energy.options, _CUSTOM]
        self.energy.value = energy.name
        self.s.disabled = "s" not in energy.parameters()
        if not self.s.disabled:
            self.s.value = float(getattr(energy, "s", 1.0))

    def _set_method(self, _: str, name: str) -> None:
        if not self._showing:
            self._act(lambda: self.deformation.set_method(name))

    def _set_setting(self, name: str, value: Any) -> None:
        method = self.deformation.state.current.method
        settings = {**method.settings, name: value}
        if not self._showing:
            self._act(lambda: self.deformation.set_method(method.name, **settings))

    def _set_energy(self, *_: Any) -> None:
        name, s = self.energy.value, self.s.value
        if not self._showing and name in ENERGIES:
            self._act(lambda: self.deformation.set_energy(energy_by_name(name, s)))

    def _set_option(self, name: str, value: Any) -> None:
        if not self._showing:
            self._act(lambda: self.deformation.set_options(**{name: value}))

    def _set_paused(self, change: Any) -> None:
        if not self._showing:
            self.deformation.paused = change["new"]


def _methods() -> list[tuple[str, str]]:
    """Labels and names of all methods, ours first."""
    return [
        (
            method.label
            + _WORKS_ON[method.family]
            + ("" if method.available() else " (not installed)"),
            name,
        )
        for name, method in METHODS.items()
    ]


def _option_controls(options: Options) -> dict[str, tuple[str, Any]]:
    weight = ipywidgets.FloatLogSlider(
        options.p2p_weight,
        min=0,
        max=8,
        step=0.25,
        readout_format=".0e",
        continuous_update=False,
        layout=_FULL,
        tooltip="How strongly handles are drawn to their targets",
    )
    sampling = _menu(
        [("Graded panels", "graded"), ("Uniform (paper)", "uniform")],
        "Where the energy is integrated",
    )
    certificate = _menu(
        [
            ("Hermite–Bernstein", "hermite"),
            ("Lipschitz (paper)", "lipschitz"),
            ("Lipschitz (BDHM)", "bdhm"),
        ],
        "How local injectivity is proved",
    )
    hessian = _menu(
        [("Adaptive", "adaptive"), ("Projected (paper)", "projected"), ("Exact", "exact")],
        "The matrix of Newton's method",
    )
    iterations = ipywidgets.IntSlider(
        options.iterations_per_call,
        min=1,
        max=7,
        continuous_update=False,
        layout=_FULL,
        tooltip="Newton iterations between two frames",
    )
    conformal = ipywidgets.Checkbox(indent=False, layout=_FULL, tooltip="No shear anywhere")
    return {
        "p2p_weight": ("Weight λ", weight),
        "sampling": ("Sampling", sampling),
        "certificate": ("Certificate", certificate),
        "hessian": ("Hessian", hessian),
        "iterations_per_call": ("Iterations / frame", iterations),
        "conformal": ("Conformal maps only", conformal),
    }


def _control_of(kind: Any, default: Any) -> Any:
    """A control for values of an annotated kind, or None."""
    if get_origin(kind) is Literal:
        return ipywidgets.Dropdown(options=get_args(kind), value=default, layout=_FULL)
    if kind is bool:
        return ipywidgets.Checkbox(default, indent=False, layout=_FULL)
    if kind is int:
        return ipywidgets.IntText(default, continuous_update=False, layout=_FULL)
    if kind is float:
        return ipywidgets.FloatText(default, continuous_update=False, layout=_FULL)
    return None


def _menu(options: Any, tooltip: str) -> ipywidgets.Dropdown:
    return ipywidgets.Dropdown(options=options, layout=_FULL, tooltip=tooltip)
