"""The state of the deformation editor and of its solver at one moment."""

from __future__ import annotations

from dataclasses import dataclass

from glid_nb.geometry import MeshMap
from glid_nb.harmonic import HarmonicMap
from glid_nb.session.edit_state import EditState, Solution
from glid_nb.session.live_solver import Frame
from glid_nb.solvers import DeformationMap


@dataclass(frozen=True, eq=False)
class Moment:
    """Everything that a view of a deformation draws, read at one moment and so consistent."""

    state: EditState
    frame: Frame | None
    """The solver's last frame, if it belongs to the state; else None."""
    busy: bool
    """Whether the solver has work."""
    paused: bool
    error: Exception | None = None
    """The exception that ended the last solve, if one did."""
    selection: tuple[int, ...] = ()
    """Indices of the selected handles."""
    dragged: tuple[int, ...] = ()
    """Indices of the handles that are being dragged."""

    @property
    def map(self) -> HarmonicMap:
        """The certified map."""
        return self.state.map

    @property
    def comparison(self) -> MeshMap | None:
        """The uncertified map of a method on a mesh, shown instead of :attr:`map`; else None.

        It lags behind the state while the method works.
        """
        return None if self.frame is None else self.frame.mesh

    @property
    def shown(self) -> DeformationMap:
        """The map to draw: the comparison, or the certified map."""
        return self.map if self.comparison is None else self.comparison

    @property
    def solution(self) -> Solution | None:
        """How the solve of the pose ended; None before."""
        current, frame = self.state.current, self.frame
        if current.method.certified:
            return current.solution
        # The result of a method on a mesh is only in the frame.
        latest = frame is not None and frame.task.pose.asks_the_same(current)
        return frame.solution if frame is not None and latest else None

    @property
    def solved(self) -> bool:
        """Whether the solve of the pose has come to its end."""
        return self.solution is not None and self.solution.ended
