"""Controls of the solver."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import ipywidgets

from glid_nb.energies import ENERGY_NAMES, CustomEnergy, energy_by_name
from glid_nb.session.deformation import Deformation
from glid_nb.widgets.edit_controls import EditControls

ENERGY_LABELS = {
    "iso": "Symmetric Dirichlet",
    "exp": "Exponential sym. Dirichlet",
    "amips": "AMIPS",
    "arap": "ARAP",
}
"""What the menu calls the energies."""

_WITH_PARAMETER = ("exp", "amips")
_FULL = {"width": "auto"}


class SolverPanel(EditControls):
    """Energy, weight of the targets, variants of the method, and buttons for the solver.

    Parameters
    ----------
    deformation : Deformation
        The model that the controls change; what code changes there shows here.
    """

    def __init__(self, deformation: Deformation, **kwargs: Any) -> None:
        options = deformation.state.current.options
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
            [("Hermite–Bernstein", "hermite"), ("Lipschitz (paper)", "lipschitz")],
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
        rows = [
            ("Energy", self.energy),
            ("s", self.s),
            ("Weight λ", self.weight),
            ("Sampling", self.sampling),
            ("Certificate", self.certificate),
            ("Hessian", self.hessian),
            ("Iterations / frame", self.iterations),
        ]
        grid = ipywidgets.GridBox(
            [item for label, control in rows for item in (ipywidgets.Label(label), control)],
            layout=ipywidgets.Layout(
                grid_template_columns="124px minmax(0, 1fr)", grid_gap="2px 8px"
            ),
        )
        buttons = ipywidgets.HBox(
            [self.pause, self.step, self.reset, self.clear],
            layout=ipywidgets.Layout(flex_flow="row wrap"),
        )
        for button in buttons.children:
            button.layout.width = "auto"
        super().__init__(deformation, [grid, self.conformal, buttons], **kwargs)
        self.add_class("glid-solver-panel")
        self._show()
        for control in (self.energy, self.s):
            control.observe(self._set_energy, ["value"])
        for control, name in (
            (self.weight, "p2p_weight"),
            (self.conformal, "conformal"),
            (self.sampling, "sampling"),
            (self.certificate, "certificate"),
            (self.hessian, "hessian"),
            (self.iterations, "iterations_per_call"),
        ):
            control.observe(self._setter(name), ["value"])
        self.pause.observe(self._set_paused, ["value"])
        self._watch()

    def _show(self) -> None:
        current = self.deformation.state.current
        options, energy = current.options, current.energy
        with self._while_showing():
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
            self.pause.value = self.deformation.paused
            self.step.disabled = not self.deformation.paused

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


def _dropdown(options: Any, tooltip: str) -> ipywidgets.Dropdown:
    return ipywidgets.Dropdown(options=options, layout=_FULL, tooltip=tooltip)


def _button(label: str, icon: str, tooltip: str, act: Callable[[], None]) -> ipywidgets.Button:
    button = ipywidgets.Button(description=label, icon=icon, tooltip=tooltip)
    button.on_click(lambda _: act())
    return button
