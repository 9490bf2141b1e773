"""What the page's own solver is told, so that it can go ahead of the kernel in a drag."""

from typing import Any

import numpy as np

from glid_nb.energies import ENERGIES, CustomEnergy
from glid_nb.page import bundle, coefficients_of, pins_of
from glid_nb.pose import Pose
from glid_nb.session.edit_state import Moment
from glid_nb.solvers import Options
from glid_nb.solvers.stiffness import stiff_nodes
from glid_nb.widgets.pane import Stage

# With more columns of the basis, the page's solver would be slower than the kernel and a network:
# its matrices have four times as many rows.
_MOST_COLUMNS = 200


class PageSolver:
    """Tells a stage's page the problem, and the pose and map whenever the model is at rest.

    The page solves the same problem as the kernel (``canvas/ahead.js``), and proves every map that
    it shows. What it cannot solve is left to the kernel: methods on a mesh, energies of the user,
    conformal maps and the paper's samples, large cages, and a solver that is paused.
    """

    def __init__(self, stage: Stage) -> None:
        self._stage = stage
        self._told: Any = None  # what was told last of the rest; None since the last drag
        self._n_pins = 0  # how many pins that had
        self._asked: Any = None  # what the options were made from

    def follow(self, moment: Moment) -> None:
        """Tell the page of a moment, if it is at rest and the page has drawn the stage. A drag that
        has just made its pin is told too, so that the page follows that pin from there."""
        moves = bool(moment.dragged) or (moment.busy and not moment.solved)
        if moves:
            self._told = None
        makes_pin = moment.dragged and len(moment.state.pose) > self._n_pins
        if self._stage.drawn and (makes_pin or not moves):
            self._tell_options(moment)
            self._tell_rest(moment)

    def _tell_options(self, moment: Moment) -> None:
        current, domain = moment.state.current, moment.state.domain
        stiffness = current.pose.stiffness
        solves = can_solve(moment)
        asked = (domain, current.energy, current.options, stiffness, solves)
        if asked == self._asked:
            return
        self._asked = asked
        if not solves:
            self._stage.solver = {}
            return
        stiff = bool(stiffness.within(domain.cage))
        self._stage.solver_script = bundle("live")
        self._stage.solver = {
            "options": {
                "energy": current.energy.name,
                "s": float(getattr(current.energy, "s", 1.0)),
                "weight": float(current.options.p2p_weight),
                "stiff": stiff_nodes(domain, stiffness) if stiff else None,
            }
        }

    def _tell_rest(self, moment: Moment) -> None:
        map, pose = moment.map, moment.state.pose
        if self._told is not None and self._told[0] is map and self._told[1] is pose:
            return
        self._told, self._n_pins = (map, pose), len(pose)
        self._stage.rest = {
            "number": self._stage.rest.get("number", 0) + 1,
            "pose": _pose(pose),
            "coefficients": np.array(coefficients_of(map), "<f8").tobytes(),
        }


def can_solve(moment: Moment) -> bool:
    """Whether the page's own solver solves what is edited, as the kernel does."""
    current, usual = moment.state.current, Options()
    options = current.options
    return (
        current.method.certified
        and moment.state.domain.n_coefficients <= _MOST_COLUMNS
        and current.energy.name in ENERGIES
        and not isinstance(current.energy, CustomEnergy)
        and (options.sampling, options.conformal) == (usual.sampling, usual.conformal)
        and not moment.paused
    )


def _pose(pose: Pose) -> dict[str, Any]:
    """A pose as the page's solver takes it: a list for each number of the pins."""
    pins = pins_of(pose)
    numbers = "handle", "target", "weight", "angle", "scale"
    return {f"{number}s": [pin[number] for pin in pins] for number in numbers}
