"""Controls of the solver."""

from __future__ import annotations

import html
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import ipywidgets

from glid_nb.energies import ENERGY_NAMES, CustomEnergy, energy_by_name
from glid_nb.methods import MethodChoice, methods
from glid_nb.session.deformation import Deformation
from glid_nb.widgets.edit_controls import EditControls
from glid_nb.widgets.method_settings import LABEL_WIDTH, MethodSettings

ENERGY_LABELS = {
    "iso": "Symmetric Dirichlet",
    "exp": "Exponential sym. Dirichlet",
    "amips": "AMIPS",
    "mips": "MIPS (conformal)",
    "arap": "ARAP",
}
"""What the menu calls the energies."""

_WORKS_ON = {"harmonic": "", "mesh": " · mesh", "linear": " · linear"}
_NOT_INSTALLED = " (not installed)"
_WITH_PARAMETER = ("exp", "amips")
_FULL = {"width": "auto"}


class SolverPanel(EditControls):
    """Method, energy, weight of the targets, variants of ours, and buttons for the solver.

    Parameters
    ----------
    deformation : Deformation
        The model that the controls change; what code changes there shows here.
    """

    def __init__(self, deformation: Deformation, **kwargs: Any) -> None:
        options = deformation.state.current.options
        self.method = _dropdown(_method_menu(), "What solves: ours, or another to compare with")
        self.about = ipywidgets.HTML()
        """What the method does."""
        self.settings = MethodSettings(self._set_settings)
        """The method's own settings."""
        menu = [(ENERGY_LABELS[name], name) for name in ENERGY_NAMES]
        self.energy = _dropdown(menu, "What is minimised")
        self.s = ipywidgets.BoundedFloatText(
            1.0, min=1e-3, max=100.0, step=0.1, layout=_FULL, tooltip="The energy's parameter s"
        )
        self.weight = ipywidgets.FloatLogSlider(
            options.p2p_weight,
            min=0,
            max=8,
            step=0.25,
            readout_format=".0e",
            continuous_update=False,
            layout=_FULL,
            tooltip="How strongly handles are drawn to their targets",
        )
        self.conformal = ipywidgets.Checkbox(
            description="Conformal maps only", indent=False, layout=_FULL
        )
        self.sampling = _dropdown(
            [("Graded panels", "graded"), ("Uniform (paper)", "uniform")],
            "Where the energy is integrated",
        )
        self.certificate = _dropdown(
            [
                ("Hermite–Bernstein", "hermite"),
                ("Lipschitz (paper)", "lipschitz"),
                ("Lipschitz (BDHM)", "bdhm"),
            ],
            "How local injectivity is proved",
        )
        self.hessian = _dropdown(
            [("Adaptive", "adaptive"), ("Projected (paper)", "projected"), ("Exact", "exact")],
            "The matrix of Newton's method",
        )
        self.iterations = ipywidgets.IntSlider(
            options.iterations_per_call,
            min=1,
            max=7,
            continuous_update=False,
            layout=_FULL,
            tooltip="Newton iterations between two frames",
        )
        self.pause = ipywidgets.ToggleButton(
            description="Pause", icon="pause", tooltip="Let the solver wait"
        )
        self.step = _button("Step", "step-forward", "One frame's iterations", deformation.step)
        self.reset = _button("Reset", "refresh", "The undeformed shape (0)", deformation.reset)
        self.clear = _button(
            "Clear handles", "eraser", "Let go of all handles", deformation.clear_handles
        )
        self._options = (
            (self.weight, "p2p_weight"),
            (self.conformal, "conformal"),
            (self.sampling, "sampling"),
            (self.certificate, "certificate"),
            (self.hessian, "hessian"),
            (self.iterations, "iterations_per_call"),
        )
        choice = [("Method", self.method)]
        rows = [
            ("Energy", self.energy),
            ("s", self.s),
            ("Weight λ", self.weight),
            ("Sampling", self.sampling),
            ("Certificate", self.certificate),
            ("Hessian", self.hessian),
            ("Iterations / frame", self.iterations),
        ]
        buttons = ipywidgets.HBox(
            [self.pause, self.step, self.reset, self.clear],
            layout=ipywidgets.Layout(flex_flow="row wrap"),
        )
        for button in buttons.children:
            button.layout.width = "auto"
        parts = [_grid(choice), self.about, self.settings, _grid(rows), self.conformal, buttons]
        super().__init__(deformation, parts, **kwargs)
        self.add_class("glid-solver-panel")
        self.method.add_class("glid-method")
        self.energy.add_class("glid-energy")
        self._show()
        self.method.observe(self._set_method, ["value"])
        for control in (self.energy, self.s):
            control.observe(self._set_energy, ["value"])
        for control, name in self._options:
            control.observe(self._setter(name), ["value"])
        self.pause.observe(self._set_paused, ["value"])
        self._watch()

    def _show(self) -> None:
        current = self.deformation.state.current
        options, energy, choice = current.options, current.energy, current.method
        with self._while_showing():
            self.method.value = choice.name
            self.about.value = _about(choice)
            self.settings.show(choice)
            custom = isinstance(energy, CustomEnergy)
            names = [*self.energy.options]
            if custom and names[-1][1] != "custom":
                self.energy.options = [*names, ("Your own", "custom")]
            self.energy.value = energy.name
            self.s.disabled = energy.name not in _WITH_PARAMETER
            if not self.s.disabled:
                self.s.value = float(getattr(energy, "s", 1.0))
            self.weight.value = options.p2p_weight
            self.conformal.value = options.conformal
            self.sampling.value = options.sampling
            self.certificate.value = options.certificate
            self.hessian.value = options.hessian
            self.iterations.value = options.iterations_per_call
            for control, option in self._options:
                control.disabled = not choice.takes(option)
            self.pause.value = self.deformation.paused
            self.step.disabled = not self.deformation.paused

    def _set_method(self, change: Any) -> None:
        if not self._showing:
            self._act(lambda: self.deformation.set_method(change["new"]))

    def _set_settings(self, settings: Mapping[str, Any]) -> None:
        name = self.deformation.state.current.method.name
        if not self._showing:
            self._act(lambda: self.deformation.set_method(name, **settings))

    def _set_energy(self, _: Any) -> None:
        name, s = str(self.energy.value), self.s.value
        if not self._showing and name != "custom":
            self._act(lambda: self.deformation.set_energy(energy_by_name(name, s)))

    def _setter(self, name: str) -> Callable[[Any], None]:
        def set_option(change: Any) -> None:
            if not self._showing:
                self._act(lambda: self.deformation.set_options(**{name: change["new"]}))

        return set_option

    def _set_paused(self, change: Any) -> None:
        if not self._showing:
            self.deformation.paused = change["new"]


def _method_menu() -> list[tuple[str, str]]:
    """All methods, ours first; on what each works, and which package it lacks."""
    return [
        (
            method.title + _WORKS_ON[method.family] + ("" if method.available else _NOT_INSTALLED),
            name,
        )
        for name, method in methods().items()
    ]


def _about(choice: MethodChoice) -> str:
    text = choice.method.summary
    if choice.method.family != "harmonic":
        text += (
            " Shown for comparison, without a proof; saved and exported is the last certified map."
        )
    return f"<div style='line-height:1.3;opacity:0.75'>{html.escape(text)}</div>"


def _grid(rows: Sequence[tuple[str, ipywidgets.Widget]]) -> ipywidgets.GridBox:
    return ipywidgets.GridBox(
        [item for label, control in rows for item in (ipywidgets.Label(label), control)],
        layout=ipywidgets.Layout(
            grid_template_columns=f"{LABEL_WIDTH} minmax(0, 1fr)", grid_gap="2px 8px"
        ),
    )


def _dropdown(options: Any, tooltip: str) -> ipywidgets.Dropdown:
    return ipywidgets.Dropdown(options=options, layout=_FULL, tooltip=tooltip)


def _button(label: str, icon: str, tooltip: str, act: Callable[[], None]) -> ipywidgets.Button:
    button = ipywidgets.Button(description=label, icon=icon, tooltip=tooltip)
    button.on_click(lambda _: act())
    return button
