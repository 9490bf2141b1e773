"""The motion between the poses of a deformation, proved in the background, interval by interval."""

import bisect
import itertools
import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from typing import Literal, NamedTuple

import numpy as np

from glid_nb._arrays import Array
from glid_nb.certificate import certificate_of
from glid_nb.certificate.rounding import rounded_down
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging.order import Order, order_at
from glid_nb.motion import Motion, MotionError, Piece, unlike_turns
from glid_nb.pose import Pose
from glid_nb.session.deformation import Deformation
from glid_nb.session.document import AS_SEEN, NamedPose
from glid_nb.session.edit_state import EditError, EditState, Moment
from glid_nb.session.model import Observed, Observer
from glid_nb.session.timeline import LEAST_GAP, Timeline, on_grid, thinned
from glid_nb.session.worker import LatestWins, weakly

_THINNED = 0.02  # largest error of a recorded target, as a share of the cage's longer side
_INTERVAL = 0.25  # least seconds between two reports of a running proof
_ALMOST = 1 - 1e-9


class Span(NamedTuple):
    """The motion from a keyframe to the next, as far as it is known."""

    start: float
    end: float
    map: HarmonicMap  # of its first keyframe
    status: Literal["computing", "proved", "fails", "refused"] = "computing"
    reason: str = ""  # why it fails and how far it is proved, or why it is refused
    pieces: tuple[Piece, ...] = ()
    """The proved part, from the start on; the whole motion if the status is "proved"."""
    sigma2: tuple[float, ...] = ()  # the certified bound on each piece

    @property
    def until(self) -> float:
        """The last instant that is proved."""
        return self.pieces[-1].end if self.pieces else self.start

    @property
    def knots(self) -> tuple[tuple[float, ...], tuple[HarmonicMap, ...]]:
        """Times and maps between which it is straight, as far as it is proved. If nothing is, the
        shape stays at its keyframe."""
        first = self.pieces[0].start_map if self.pieces else self.map
        ends = [(piece.end, piece.end_map) for piece in self.pieces] or [(self.end, self.map)]
        times, maps = zip((self.start, first), *ends, strict=True)
        return times, maps


class Animation(Observed):
    """The motion through the poses of a deformation, and the recording of a drag.

    ``observe`` reports "motion" and "recording". During a drag or a solve nothing is computed.
    """

    def __init__(self, deformation: Deformation) -> None:
        super().__init__()
        self.deformation = deformation
        self._spans: dict[int, tuple[Span, ...]] = {}  # of each part, by its key
        self.recording = False  # whether the current or next drag becomes keyframes
        self._task: EditState | None = None
        self._asked = False
        self._began: tuple[float, EditState] | None = None
        self._samples: list[tuple[float, NamedPose]] = []  # of the recorded drag
        prove = weakly(self._prove)
        self.worker: LatestWins[EditState] = LatestWins(prove, self, "motion", waits=False)
        self._stop = deformation.observe(weakly(self._on_model))
        self._on_model("state")

    @property
    def state(self) -> EditState:
        """The present state of the deformation."""
        return self.deformation.state

    @property
    def spans(self) -> tuple[Span, ...]:
        """The spans from each keyframe to the next; in a loop also from the last to the first.

        They always belong to the present poses. Of several parts they are those of the edited one.
        """
        with self.deformation.locked():
            state = self.deformation.state
            return self.spans_of(state.keys[state.part])

    def spans_of(self, key: int) -> tuple[Span, ...]:
        """The spans of the part with a key."""
        with self.deformation.locked(), self.locked():
            state = self.deformation.state
            known = self._spans if _same_motion(state, self._task) else _all_spans(state)
            return known[key]

    @property
    def motion(self) -> Motion:
        """The motion as a value, proved or not. Waits until all poses are solved.

        Raises a MotionError if the motion cannot be made, an EditError if a pose cannot be solved.
        """
        return motion_of(self.deformation.solved_state())

    def at(self, time: float, key: int | None = None) -> HarmonicMap | None:
        """The map at a time, or the last one before it at which all parts are proved; None outside
        the motion. It is that of the edited part, or of the part with a key."""
        with self.deformation.locked():
            spans = self.spans if key is None else self.spans_of(key)
            number = next((i for i, s in enumerate(spans) if s.start <= time <= s.end), None)
            if number is None:
                return None
            span, state = spans[number], self.deformation.state
            shown = [part.key for part in state.parts if part.visible] or state.keys
            time = min(time, span.until, *(self.spans_of(one)[number].until for one in shown))
        piece = next((p for p in span.pieces if time <= p.end), None)
        return span.map if piece is None else piece.at(time)

    def seen(self, time: float, key: int | None = None) -> tuple[HarmonicMap, Order] | None:
        """Map and order of a shape's sheets at a time, after the last keyframe those of its pose.
        None before the first keyframe, and without a motion. Parts are as in `at`."""
        with self.deformation.locked():
            state = self._shape(key)
            if self.is_later(time):
                return state.poses[-1].map, state.orders[-1]
            map_ = self.at(time, key)
            return None if map_ is None else (map_, self.order(time, key))

    def _shape(self, key: int | None) -> EditState:
        """The state of the part with a key; without one, that of the edited part."""
        state = self.deformation.state
        return state if key is None else state.shapes[state.keys.index(key)]

    def order(self, time: float, key: int | None = None) -> Order:
        """The order of a shape's sheets at a time, interpolated between two keyframes."""
        state = self._shape(key)
        return order_at(state.orders, state.timeline.closed_times, time)

    def keep(self, time: float) -> None:
        """Save the map at a time as a pose. Between poses, the map must be proved. After the last
        keyframe it is that of the last pose."""
        times = self.deformation.state.timeline.times
        time = time if time in times else round(time, 2)
        if self.is_later(time):
            return self.deformation.keep_after(time)
        if time in times or not self.spans:
            return self.deformation.save_pose()
        with self.deformation.locked():
            every = [self.spans_of(key) for key in self.deformation.state.keys]
            pieces = [[piece for span in spans for piece in span.pieces] for spans in every]
            now = [next((p for p in one if p.start <= time <= p.end), None) for one in pieces]
            if None in now:
                raise EditError(f"nothing is proved at {time:.2f} s, so there is no shape to keep")
            maps = [piece.at(time) for piece in now if piece is not None]
            return self.deformation.keep_between(time, *maps)

    def is_later(self, time: float) -> bool:
        """Whether a time is after the last keyframe, where nothing is played."""
        state = self.deformation.state
        loops = state.timeline.repeat == "loop" and len(state.poses) > 1
        return not loops and round(time, 2) - state.timeline.times[-1] >= LEAST_GAP

    def go_to(self, time: float) -> None:
        """Edit the pose at a time: that of a keyframe, or else a new one, as `keep` makes it."""
        keyframe = self._keyframe_at(time)
        if keyframe is None:
            self.keep(time)
        else:
            self.deformation.go_to_pose(keyframe)

    def pins(self, time: float) -> Array:
        """(h, 2) places of the pins of the pose that `go_to` edits at a time, which `keep` puts
        where the shape is. NaN for those that the user has hidden."""
        with self.deformation.locked():
            state = self.deformation.state
            known = len(state.poses) - 1 if self.is_later(time) else self._keyframe_at(time)
            if known is not None:
                pose = state.poses[known].pose
                places = pose.targets
            else:
                index = bisect.bisect_right(state.timeline.times, time) - 1
                pose, map_ = state.poses[max(index, 0)].pose, self.at(time)
                places = pose.targets if map_ is None or not len(pose) else map_(pose.handles)
            return shown_pins(state, pose, places)

    def _keyframe_at(self, time: float) -> int | None:
        """The index of the pose whose keyframe is at a time; None for none."""
        state = self.deformation.state
        far = np.abs(np.subtract(state.timeline.closed_times, round(time, 2)))
        nearest = int(far.argmin())
        return nearest % len(state.poses) if far[nearest] < LEAST_GAP else None

    def record(self, on: bool) -> None:
        """Set whether the next drag becomes keyframes."""
        with self.locked():
            self.recording, self._began, self._samples = on, None, []
            self.tell("recording")

    def wait(self, timeout: float | None = None) -> bool:
        """Wait until all is proved or refused. Returns False after ``timeout`` seconds."""
        return self.deformation.solve(timeout) and self.worker.wait(timeout)

    def close(self) -> None:
        self._stop()
        self.worker.close()

    def _on_model(self, what: str) -> None:
        if what in ("selection", "hand"):
            return
        model, finished = self.deformation, None
        with model.locked():  # the model's lock always comes first
            moment = model.moment
            with self.locked():
                if self.recording:
                    finished = self._sample(moment, what == "frame")
                self._follow(moment)
            if finished is not None:
                model.record(*finished)

    def _follow(self, moment: Moment) -> None:
        """Start the proof once the edited pose is solved."""
        task = moment.state
        if not _same_motion(task, self._task):
            self.worker.cancel()
            self._asked = False
            spans = _all_spans(task)
            if _told(spans) != _told(self._spans):
                self.tell("motion")
            self._spans = spans
        before, self._task = self._task, task
        if before is not None and before.keys[before.part] != task.keys[task.part]:
            self.tell("motion")  # of another part
        if not self._asked and len(task.poses) > 1 and self.deformation.settled():
            self._asked = True
            self.worker.submit(task)

    # Recording

    def _sample(
        self, moment: Moment, moved: bool
    ) -> tuple[NamedPose, list[NamedPose], list[float]] | None:
        """Record the state of a drag. At its end, return the poses and times to keep."""
        now, past, state = time.monotonic(), self.deformation.history.past, moment.state
        if moment.dragged:
            if self._began is None and past:
                self._began = now, past[-1]
            if moved and (frame := moment.frame) is not None:
                pose, samples = frame.task.pose.pose, self._samples
                noted = samples.pop()[0] if samples and samples[-1][1].pose is pose else now
                seen = {"pose": pose, "map": frame.map, "solution": AS_SEEN}
                samples.append((noted, replace(state.current, **seen)))
            return None
        if self._began is None:
            return None
        (began, before), samples = self._began, self._samples
        self.recording, self._began, self._samples = False, None, []
        self.tell("recording")
        if not past or past[-1] is not before:
            return None  # the drag was cancelled
        samples = [(began, before.current), *samples, (now, state.current)]
        times, places = on_grid(np.array([t for t, _ in samples])), [pose for _, pose in samples]
        points = np.stack([pose.pose.targets for pose in places])
        kept = thinned(times, points, _THINNED * state.domain.cage.longer_side)[1:]
        return before.current, [places[i] for i in kept[:-1]], times[kept].tolist()

    # Proving

    def _prove(self, task: EditState, worker: LatestWins[EditState]) -> None:
        spans, told = _all_spans(task), time.monotonic()
        for key, shape in zip(task.keys, task.shapes, strict=True):
            why = map(self.deformation.why_unsolved, shape.poses)
            reasons = [None if error is None else error.plain for error in why]
            for i, span in proved_spans(shape, reasons, worker):
                spans[key] = (*spans[key][:i], span, *spans[key][i + 1 :])
                if time.monotonic() - told > _INTERVAL:
                    told = time.monotonic()
                    self._publish(task, spans)
        if not worker.overtaken:
            self._publish(task, spans)

    def _publish(self, task: EditState, spans: dict[int, tuple[Span, ...]]) -> None:
        with self.locked():
            if _same_motion(task, self._task):
                self._spans = dict(spans)
                self.tell("motion")


class PartAnimation:
    """The motion of one part, with what a view of an `Animation` reads.

    A part that has just been removed has no motion; its view goes soon.
    """

    def __init__(self, animation: Animation, key: int) -> None:
        self.animation, self.key = animation, key

    @property
    def state(self) -> EditState:
        """The state of the part alone."""
        state = self.animation.deformation.state
        return state.shapes[state.keys.index(self.key)] if self.key in state.keys else state

    @property
    def spans(self) -> tuple[Span, ...]:
        """As `Animation.spans`, of the part."""
        with self.animation.deformation.locked():
            known = self.key in self.animation.deformation.state.keys
            return self.animation.spans_of(self.key) if known else ()

    def seen(self, time: float) -> tuple[HarmonicMap, Order] | None:
        """As `Animation.seen`, of the part."""
        with self.animation.deformation.locked():
            known = self.key in self.animation.deformation.state.keys
            return self.animation.seen(time, self.key) if known else None

    def observe(self, observer: Observer) -> Callable[[], None]:
        """As `Animation.observe`."""
        return self.animation.observe(observer)


def shown_pins(state: EditState, pose: Pose, places: Array) -> Array:
    """Places (h, ...) of the pins of a pose, NaN for those that the user has hidden."""
    hidden = np.array([mark.hidden for mark in state.pins.of(pose.handles)], dtype=bool)
    result = np.array(places, dtype=float)
    result[hidden] = np.nan
    return result


def _same_motion(task: EditState, other: EditState | None) -> bool:
    """Whether two states have the same motion and the same solved poses. Names do not matter, nor
    does the part that is played."""
    if other is None or _whole(task) != _whole(other) or set(task.keys) != set(other.keys):
        return False
    shapes = dict(zip(other.keys, other.shapes, strict=True))
    pairs = [
        pair
        for key, shape in zip(task.keys, task.shapes, strict=True)
        for pair in zip(shape.poses, shapes[key].poses, strict=True)
    ]
    return all(pose.map is its.map and pose.solution is its.solution for pose, its in pairs)


def _all_spans(task: EditState) -> dict[int, tuple[Span, ...]]:
    """The unproved spans of all parts, by their keys."""
    return {key: _spans(shape) for key, shape in zip(task.keys, task.shapes, strict=True)}


def _told(spans: dict[int, tuple[Span, ...]]) -> dict[int, list[tuple[float, float, str]]]:
    """What views show of spans."""
    return {key: [(s.start, s.end, s.status) for s in each] for key, each in spans.items()}


def _whole(task: EditState) -> Timeline:
    return replace(task.timeline, loop_range=None)


def _spans(task: EditState) -> tuple[Span, ...]:
    times = task.timeline.closed_times if len(task.poses) > 1 else ()
    ends = itertools.pairwise(times)
    return tuple(Span(*e, p.map) for e, p in zip(ends, task.poses, strict=False))


def motion_of(task: EditState, first: int = 0, last: int | None = None) -> Motion:
    """The motion through the poses from ``first`` to ``last``; without ``last``, the whole
    timeline."""
    timeline, maps = task.timeline, [pose.map for pose in task.poses]
    if last is None:
        return timeline.motion(maps)
    times = timeline.closed_times[first : last + 1]
    chosen = (maps + maps[:1])[first : last + 1]
    return Motion(chosen, times, easing=timeline.easing[first:last])


def proved_by_all(time: float, animations: Iterable["Animation | PartAnimation"]) -> float:
    """The instant that is shown at a time of several motions with the same keyframes: if some are
    not proved there, the last one before it, in the same interval, that is proved for all."""
    spans = (s for animation in animations for s in animation.spans if s.start <= time <= s.end)
    return min([time, *(span.until for span in spans)])


def proved_spans(
    task: EditState, reasons: list[str | None], worker: LatestWins[EditState]
) -> Iterator[tuple[int, Span]]:
    """Prove interval after interval.

    Motions end and begin at intervals whose poses turn differently around holes. They also end and
    begin at intervals with a pose that is not solved; ``reasons`` says why for each pose.
    """
    spans = _spans(task)
    poses = [*task.poses, task.poses[0]][: len(spans) + 1]
    refused = {}
    for i, pair in enumerate(itertools.pairwise(poses)):
        if worker.overtaken:
            return
        ends = (reasons[i], reasons[(i + 1) % len(reasons)])
        if unsolved := next((reason for reason in ends if reason is not None), None):
            refused[i] = spans[i]._replace(status="refused", reason=unsolved)
            continue
        if reason := unlike_turns(*(certificate_of(pose.map) for pose in pair)):
            names = " and ".join(repr(pose.name) for pose in pair)
            refused[i] = spans[i]._replace(status="refused", reason=f"{names} {reason}")
    yield from refused.items()
    runs = [(None, range(len(spans)))]
    if refused:
        ends = [-1, *refused, len(spans)]
        runs = [(b, range(a + 1, b)) for a, b in itertools.pairwise(ends) if b - a > 1]
    for last, run in runs:
        motion = motion_of(task, run.start, last)
        for i in run:
            if worker.overtaken:
                return
            yield i, _span(motion, i - run.start, spans[i])


def _span(motion: Motion, index: int, span: Span) -> Span:
    try:
        pieces, proofs = motion.interval(index)
    except MotionError as error:
        return span._replace(status="refused", reason=error.plain)
    sigma2 = tuple(proof.sigma2_lower for proof in proofs)
    failing = next((i for i, proof in enumerate(proofs) if not proof.certified), None)
    if failing is None:
        return span._replace(status="proved", pieces=pieces, sigma2=sigma2)
    piece, proof = pieces[failing], proofs[failing]
    until = piece.start + proof.until * (piece.end - piece.start) * _ALMOST
    x, y = proof.place.real, proof.place.imag
    shown = rounded_down(until, 4)
    reason = f"Proved up to {shown} s; the panel near ({x:.2f}, {y:.2f}) fails. Add a keyframe."
    held = pieces[:failing]
    if until > piece.start:
        held += (Piece(piece.start, until, piece.start_map, piece.at(until)),)
    return span._replace(status="fails", reason=reason, pieces=held, sigma2=sigma2[:failing])
