"""The controls of the solver."""

import dataclasses
from collections.abc import Mapping
from typing import Any, Literal, get_args, get_origin

import ipywidgets

from glid_nb._arguments import field_kinds
from glid_nb.energies import ENERGIES, CustomEnergy, Energy, by_name
from glid_nb.methods import METHODS
from glid_nb.session.deformation import Deformation
from glid_nb.solvers import Iteration, Method, Options
from glid_nb.widgets.controls import EditControls, FieldRows, button, paragraph, toggle

_WORKS_ON = {"harmonic": "", "mesh": " · mesh", "linear": " · linear"}
_UNPROVED = " Shown for comparison, without a proof. Save and export use the last certified map."
_CUSTOM = CustomEnergy.label, CustomEnergy.name
_FULL = {"width": "auto"}
_STEPS = 12  # most single steps that are listed
_OPTIONS = "p2p_weight", "sampling", "certificate", "hessian", "iterations_per_call", "conformal"
_LATE = {"continuous_update": False}
_CONTROLS: dict[type, tuple[Any, dict[str, Any]]] = {
    bool: (ipywidgets.Checkbox, {"indent": False}),
    int: (ipywidgets.IntText, _LATE),
    float: (ipywidgets.FloatText, _LATE),
}
_WEIGHTS = {"min": 0, "max": 8, "step": 0.25, "readout_format": ".0e"}
_SLIDERS: dict[str, tuple[Any, dict[str, Any]]] = {
    "p2p_weight": (ipywidgets.FloatLogSlider, {**_WEIGHTS, **_LATE}),
    "iterations_per_call": (ipywidgets.IntSlider, {"min": 1, "max": 7, **_LATE}),
}


class SolverPanel(EditControls):
    """Controls of a model's solver: method, energy, options, and buttons."""

    def __init__(self, deformation: Deformation, **kwargs: Any) -> None:
        act, model = self._act, deformation

        def set_setting(name: str, value: Any) -> None:
            method = model.state.current.method
            act(lambda: model.set_method(method.name, **{**method.settings, name: value}))

        self.method = _menu(_methods(), "The method: ours, or another one for comparison")
        rows = {"name": ("Method", self.method)}
        method = FieldRows(rows, lambda _, name: act(lambda: model.set_method(name)))
        self.about = ipywidgets.HTML()  # what the method does
        self.settings = FieldRows({}, set_setting)  # the method's own settings
        self._shown: type[Method] | None = None
        self.energy = _menu({name: e.label for name, e in ENERGIES.items()}, "Energy to minimise")
        self.s = ipywidgets.BoundedFloatText(
            1.0, min=1e-3, max=100.0, step=0.1, layout=_FULL, tooltip="The energy's parameter s"
        )
        rows = {"name": ("Energy", self.energy), "s": ("s", self.s)}
        self._energy_rows = energy = FieldRows(rows, self._set_energy)
        self.options = FieldRows(
            _option_controls(deformation.state.current.options),
            lambda name, value: act(lambda: model.set_options(**{name: value})),
        )
        """The options, by their names."""
        self.pause = toggle("Pause", "pause", "Pause the solver", _FULL)
        self._bind(self.pause, lambda paused: setattr(model, "paused", paused))
        self.step = button("Step", "step-forward", "Run the iterations of one frame", model.step)
        self.reset = button("Reset", "refresh", "The undeformed shape (0)", model.reset)
        self.clear = button("Clear pins", "eraser", "Remove all pins", model.clear_handles)
        self.steps = ipywidgets.HTML(layout={"height": "96px", "overflow": "hidden auto"})
        """Descriptions of single steps, the last one first; hidden unless the solver is paused."""
        shown = [self.pause, self.step, self.reset, self.clear]
        buttons = ipywidgets.HBox(shown, layout={"flex_flow": "row wrap"})
        parts = [method, self.about, self.settings, energy, self.options, buttons, self.steps]
        super().__init__(deformation, parts, **kwargs)
        self.add_class("glid-solver-panel")
        method.add_class("glid-method")
        energy.add_class("glid-energy")

    def _on_model(self, what: str) -> None:
        super()._on_model(what)
        if what != "selection":
            self._show_steps()

    def _show_steps(self) -> None:
        moment = self.deformation.moment
        self.steps.layout.display = None if moment.paused else "none"
        history = moment.frame.history[-_STEPS:] if moment.paused and moment.frame else ()
        told = [paragraph(step_in_words(iteration)) for iteration in reversed(history)]
        self.steps.value = "".join(told) or paragraph("Step shows its numbers here.")

    def _show(self) -> None:
        current = self.deformation.state.current
        self._show_method(current.method)
        self._show_energy(current.energy)
        self.options.show(current.options)
        for name, control in self.options.controls.items():
            control.disabled = name not in current.method.options
        self.pause.value = self.deformation.paused
        self.step.disabled = not self.deformation.paused
        self.step.layout.display = None if self.deformation.paused else "none"
        self._show_steps()

    def _show_method(self, method: Method) -> None:
        self.method.value = method.name
        text = method.summary + ("" if method.certified else _UNPROVED)
        self.about.value = paragraph(text, "opacity:0.75")
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
        self._energy_rows.show_row("s", not self.s.disabled)
        if not self.s.disabled:
            self.s.value = float(getattr(energy, "s", 1.0))

    def _set_energy(self, *_: Any) -> None:
        name, s = self.energy.value, self.s.value
        if name in ENERGIES:
            self._act(lambda: self.deformation.set_energy(by_name(name, s)))


def step_in_words(iteration: Iteration) -> str:
    """An iteration in words: its Hessian, its step length, and how many panels were split."""
    parts = [f"Iteration {iteration.iteration}"]
    if iteration.hessian_modified is not None:
        parts.append(f"Hessian {'projected' if iteration.hessian_modified else 'exact'}")
    if iteration.step is not None:
        parts.append(f"step length {iteration.step:.3g}")
    if iteration.panels_split is not None:
        parts.append(f"{iteration.panels_split or 'none'} of {iteration.panels} panels split")
    return " · ".join([*parts, f"E = {iteration.energy:.6g}"])


def _methods() -> dict[str, str]:
    missing = {True: "", False: " (not installed)"}
    return {
        name: method.label + _WORKS_ON[method.family] + missing[method.available()]
        for name, method in METHODS.items()
    }


def _option_controls(options: Options) -> dict[str, tuple[str, Any]]:
    kinds, controls = field_kinds(Options), {}
    about = {field.name: field.metadata for field in dataclasses.fields(options)}
    for name in _OPTIONS:
        control = _control_of(kinds[name], getattr(options, name), about[name]["choices"], name)
        control.tooltip = about[name]["help"]
        controls[name] = about[name]["label"], control
    return controls


def _control_of(
    kind: Any, value: Any, labels: Mapping[str, str] | None = None, name: str = ""
) -> Any:
    if get_origin(kind) is Literal:
        return _menu(labels or {choice: choice for choice in get_args(kind)}, value=value)
    control, look = _SLIDERS.get(name) or _CONTROLS.get(kind) or (None, {})
    return None if control is None else control(value=value, layout=_FULL, **look)


def _menu(labels: Mapping[Any, str], tooltip: str = "", **value: Any) -> ipywidgets.Dropdown:
    options = [(str(label), value) for value, label in labels.items()]
    return ipywidgets.Dropdown(options=options, layout=_FULL, tooltip=tooltip, **value)
