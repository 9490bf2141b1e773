"""The programs that the next gestures may need, compiled while nobody works."""

from typing import Any

from glid_nb.geometry import MeshMap
from glid_nb.session.deformation import Deformation
from glid_nb.session.edit_state import EditState
from glid_nb.session.worker import LatestWins, weakly
from glid_nb.solvers import Newton, Result, ahead
from glid_nb.solvers.method import Inputs

REST = 2.0  # seconds at rest before anything is compiled
_LOOK = 0.05  # seconds between two looks at the other process


class ProgramsAhead:
    """Lets another process compile what the solver of a deformation may need next.

    It begins once the model has been at rest for a while. Any change ends it at once, for example
    the press that begins a drag. What is compiled by then is kept.
    """

    def __init__(self, deformation: Deformation, rest: float = REST) -> None:
        self.deformation = deformation
        self._rest = rest
        self._asked: tuple[Any, ...] | None = None  # the problem that was asked for last
        self._done = set[tuple[Any, ...]]()  # kinds of problems for which nothing is missing
        prepare = weakly(self._prepare)
        self.worker: LatestWins[EditState] = LatestWins(prepare, self, "programs", waits=False)
        self._stop = deformation.observe(weakly(self._on_model))
        self._on_model("state")

    def close(self) -> None:
        self._stop()
        self.worker.close()

    def _on_model(self, what: str) -> None:
        if what in ("selection", "hand"):
            return
        model = self.deformation
        with model.locked():
            state, begun = model.state, model.begun and not model.paused
            if not (begun and model.settled() and isinstance(state.current.method, Newton)):
                self._asked = None
                self.worker.cancel()
            elif (asked := _asked(state)) != self._asked:
                self._asked = asked
                self.worker.submit(state)

    def _prepare(self, state: EditState, worker: LatestWins[EditState]) -> None:
        if worker.overtaken_within(self._rest):
            return
        inputs = self.deformation.next_inputs()
        if inputs.domain is not state.domain or isinstance(inputs.start, MeshMap):
            return
        if (kind := _kind(inputs)) not in self._done and self._made(inputs, worker):
            self._done.add(kind)

    def _made(self, inputs: Inputs, worker: LatestWins[EditState]) -> bool:
        """Have the missing programs compiled. Returns False if that was ended too early."""
        missing = ahead.missing_programs(inputs)
        if worker.overtaken:
            return False
        process = ahead.start(missing) if missing else None
        while process is not None and process.poll() is None:
            if worker.overtaken_within(_LOOK):
                process.kill()
                process.wait()
                return False
        return True


def _kind(inputs: Inputs) -> tuple[Any, ...]:
    """What the programs of a problem depend on."""
    pose, start = inputs.pose, inputs.start
    rows = len(pose) + int(pose.oriented.sum())
    panels = start.n_panels if isinstance(start, Result) else None
    return inputs.domain, inputs.energy, inputs.options, rows, bool(pose.stiffness), panels


def _asked(state: EditState) -> tuple[Any, ...]:
    edited = state.current
    return state.domain, edited.pose, edited.energy, edited.options
