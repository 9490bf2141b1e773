"""What an editor's model and its solver are at one moment, as one value."""

from __future__ import annotations

from dataclasses import dataclass

from glid_nb.geometry import MeshMap
from glid_nb.harmonic import HarmonicMap
from glid_nb.session.edit_state import EditState, Solution
from glid_nb.session.live_solver import Frame
from glid_nb.solvers import DeformationMap


@dataclass(frozen=True, eq=False)
class Moment:
    """Everything that a view of a deformation needs, and that belongs together.

    A thread that asks the model for one after the other may get a domain and the certificate of
    another one.
    """

    state: EditState
    frame: Frame | None
    """What the solver published last for the state's map; None if that is older."""
    busy: bool
    """Whether the solver has work."""
    paused: bool
    error: Exception | None = None
    """What the solver's thread met, if that was the last thing it did."""
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
        """What a method on a mesh has come to, uncertified, beside :attr:`map`; else None.

        It is not part of the state, and lags behind it while the method works.
        """
        return None if self.frame is None else self.frame.mesh

    @property
    def shown(self) -> DeformationMap:
        """What there is to see: the comparison, or the certified map."""
        return self.map if self.comparison is None else self.comparison

    @property
    def solution(self) -> Solution | None:
        """How the pose was solved; None while it is not."""
        current, frame = self.state.current, self.frame
        if current.method.certified:
            return current.solution
        # A method on a mesh leaves the pose as it is.
        latest = frame is not None and frame.task.pose.asks_the_same(current)
        return frame.solution if frame is not None and latest else None

    @property
    def solved(self) -> bool:
        """Whether the pose's method has come to its end."""
        return self.solution is not None and self.solution.ended
