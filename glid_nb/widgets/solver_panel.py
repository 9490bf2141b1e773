"""Controls of the solver."""

from __future__ import annotations

import html
from collections.abc import Callable
from typing import Any

import ipywidgets

from glid_nb.energies import ENERGIES, CustomEnergy, Energy, energy_by_name
from glid_nb.methods import METHODS
from glid_nb.session.deformation import Deformation
from glid_nb.solvers import Method, Options
from glid_nb.widgets.arguments import check_keywords
from glid_nb.widgets.edit_controls import EditControls
from glid_nb.widgets.field_rows import FULL, FieldRows, control_of

_WORKS_ON = {"harmonic": "", "mesh": " · mesh", "linear": " · linear"}
_CUSTOM = CustomEnergy.label, CustomEnergy.name


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
            1.0, min=1e-3, max=100.0, step=0.1, layout=FULL, tooltip="The energy's parameter s"
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
            description="Pause", icon="pause", tooltip="Let the solver wait", layout=FULL
        )
        self.step = _button("Step", "step-forward", "One frame's iterations", deformation.step)
        self.reset = _button("Reset", "refresh", "The undeformed shape (0)", deformation.reset)
        self.clear = _button(
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
            made = ((k, control_of(method.kinds()[k], v)) for k, v in method.defaults().items())
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
    """All methods, ours first; on what each works, and which lacks its package."""
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
    """By the option's name a label and a control."""
    weight = ipywidgets.FloatLogSlider(
        options.p2p_weight,
        min=0,
        max=8,
        step=0.25,
        readout_format=".0e",
        continuous_update=False,
        layout=FULL,
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
        layout=FULL,
        tooltip="Newton iterations between two frames",
    )
    conformal = ipywidgets.Checkbox(indent=False, layout=FULL, tooltip="No shear anywhere")
    return {
        "p2p_weight": ("Weight λ", weight),
        "sampling": ("Sampling", sampling),
        "certificate": ("Certificate", certificate),
        "hessian": ("Hessian", hessian),
        "iterations_per_call": ("Iterations / frame", iterations),
        "conformal": ("Conformal maps only", conformal),
    }


def _menu(options: Any, tooltip: str) -> ipywidgets.Dropdown:
    return ipywidgets.Dropdown(options=options, layout=FULL, tooltip=tooltip)


def _button(label: str, icon: str, tooltip: str, act: Callable[[], None]) -> ipywidgets.Button:
    button = ipywidgets.Button(description=label, icon=icon, tooltip=tooltip, layout=FULL)
    button.on_click(lambda _: act())
    return button
