"""The actions of the deformation editor: functions from one state to the next.

An action keeps the certified map or resets it to the identity. Only the solver moves the map.
"""

import bisect
import itertools
import operator
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from glid_nb import methods
from glid_nb._arrays import Array, number_pairs, real_array
from glid_nb.certificate import certificate_of
from glid_nb.energies import Energy
from glid_nb.geometry import Cage, Domain, place
from glid_nb.harmonic import HarmonicMap
from glid_nb.motion.easing import Easing
from glid_nb.motion.settings import Repeat
from glid_nb.pose import DEEPEST, PER_HANDLE, Pose, Stiffness, in_both, misplaced
from glid_nb.session.document import NamedPose, check_room
from glid_nb.session.edit_state import EditError, EditState
from glid_nb.session.parts import everywhere, over_parts
from glid_nb.session.pin_marks import PinMarks
from glid_nb.session.timeline import LEAST_GAP
from glid_nb.solvers import Method

# Least distance of two handles, as a share of the cage's size.
_LEAST_DISTANCE = 1e-6
# Displacements below this share of the cage's size are rounding errors.
_ROUNDING = 1e-13


def add_handles(state: EditState, points: ArrayLike, targets: ArrayLike | None = None) -> EditState:
    """Add handles at points (h, 2) of the domain. Without targets, the shape stays as it is."""
    points = _points(points, "point")
    if not len(points):
        return state
    pose, cage = state.pose, state.domain.cage
    for i, (point, inside) in enumerate(zip(points, cage.contains(points), strict=True)):
        where = place(point, 4)
        if not inside:
            why = misplaced(cage, points)
            what = f"{where} lies outside the shape; choose a place on it"
            raise EditError(f"{what}{'. ' * bool(why)}{why}", what)
        gaps = np.linalg.norm(np.concatenate([pose.handles, points[:i]]) - point, axis=1)
        if (gaps < _LEAST_DISTANCE * cage.longer_side).any():
            raise EditError(f"{where} is pinned already")
    wanted = _places_now(state, points) if targets is None else _points(targets, "to")
    depths = state.order.depths(points).round(2) + 0.0
    added = Pose(points, wanted, depths)
    parts = {n: np.concatenate([getattr(p, n) for p in (pose, added)]) for n in PER_HANDLE}
    return state.changed(pose=replace(pose, **parts))


def remove_handles(state: EditState, indices: Iterable[int], keep_shape: bool = False) -> EditState:
    """Remove some handles. The last one leaves the undeformed shape behind.

    With ``keep_shape`` the map stays, and the pose counts as solved.
    """
    kept = np.setdiff1d(np.arange(len(state.pose)), _checked_indices(state, indices))
    pose = state.pose.only(kept)
    if not keep_shape:
        return _relaxed(state, pose)
    if not state.current.solved:
        raise EditError("the shape is still moving; wait until it has come to rest to keep it")
    return state.with_current(replace(state.current, pose=pose))


def clear_handles(state: EditState) -> EditState:
    """Remove all handles; the shape is the undeformed one again."""
    return _relaxed(state, state.pose.only([]))


def move_targets(state: EditState, indices: Iterable[int], targets: ArrayLike) -> EditState:
    """Move the targets of some handles to (h, 2), inside or outside the shape."""
    chosen = _checked_indices(state, indices)
    moved, wanted = np.array(state.pose.targets), _points(targets, "to")
    if len(wanted) not in (1, len(chosen)):
        raise EditError(f"to holds {len(wanted)} points for {len(chosen)} handles; give one each")
    moved[chosen] = wanted
    return state.changed(pose=state.pose.with_targets(moved))


def move_target(state: EditState, handle: int, to: ArrayLike) -> EditState:
    """Move one target."""
    return move_targets(state, [handle], to)


def nudge(state: EditState, indices: Iterable[int], delta: ArrayLike) -> EditState:
    """Shift the targets of some handles by ``delta`` (2,)."""
    chosen = _checked_indices(state, indices)
    return move_targets(state, chosen, state.pose.targets[chosen] + _points(delta, "delta"))


def set_depths(state: EditState, indices: Iterable[int], depths: ArrayLike) -> EditState:
    """Set the depths of some handles: one number, or one per handle. The map does not change."""
    pose = _with_numbers(state, indices, depths=depths)
    if np.array_equal(pose.depths, state.pose.depths):
        return state
    return state.with_current(replace(state.current, pose=pose))


def name_pin(state: EditState, index: int, name: str) -> EditState:
    """Give a handle a name."""
    return name_pins(state, [index], name)


def name_pins(state: EditState, indices: Iterable[int], name: str) -> EditState:
    """Give some handles the same name."""
    chosen, names = _checked_indices(state, indices), state.pose.names.tolist()
    names = [name if i in chosen else old for i, old in enumerate(names)]
    return state.with_current(replace(state.current, pose=replace(state.pose, names=names)))


def set_pins(state: EditState, indices: Iterable[int], **numbers: ArrayLike | None) -> EditState:
    """Set ``angles`` (radians), ``scales`` or ``weights`` of some handles; None sets them free."""
    return _pinned(state, _with_numbers(state, indices, **numbers))


def mark_pins(state: EditState, indices: Iterable[int], **changes: bool) -> EditState:
    """Set whether some handles are ``locked`` or ``hidden`` for the hand, in all poses. The map
    does not change."""
    return _marked(state, state.pins.changed(_handles_of(state, indices), **changes))


def group_pins(state: EditState, indices: Iterable[int]) -> EditState:
    """Make a group of at least two handles: they are selected and moved together."""
    handles = _handles_of(state, indices)
    if len(handles) < 2:
        raise EditError("a group needs two pins or more; select several, for example by Shift")
    return _marked(state, state.pins.grouped(handles))


def ungroup_pins(state: EditState, indices: Iterable[int]) -> EditState:
    """Take some handles out of their groups."""
    return _marked(state, state.pins.changed(_handles_of(state, indices), group=0))


def show_all_pins(state: EditState) -> EditState:
    """Show the hidden handles of the edited pose again."""
    return mark_pins(state, range(len(state.pose)), hidden=False)


def turned_now(state: EditState, indices: Iterable[int]) -> tuple[Array, Array]:
    """Angles and scales (h,) of handles: the wanted ones, or those of the shape if free."""
    pose = state.pose.only(_checked_indices(state, indices))
    fz, wanted = state.map.wirtinger(pose.handles)[0], (pose.angles, pose.scales)
    free = np.angle(fz), np.abs(fz)
    angles, scales = (np.where(np.isnan(w), f, w) for w, f in zip(wanted, free, strict=True))
    return angles, scales


def turn(
    state: EditState, indices: Iterable[int], by: float = 0.0, scale: float = 1.0
) -> EditState:
    """Turn the shape at some handles by ``by`` radians and multiply its scale by ``scale``."""
    chosen = _checked_indices(state, indices)
    if not len(chosen):
        return state
    angles, scales = turned_now(state, chosen)
    turned = {"angles": wrapped(angles + by)} if by else {}
    scaled = {"scales": scales * scale} if scale != 1 else {}
    return set_pins(state, chosen, **turned, **scaled)


def wrapped(angles: Array) -> Array:
    """The same angles between -pi and pi."""
    return np.angle(np.exp(1j * angles))


def bring_forward(state: EditState, indices: Iterable[int], steps: float = 1) -> EditState:
    """Raise the depths of some handles by ``steps``, at most to 100. Negative steps lower them."""
    chosen = _checked_indices(state, indices)
    depths = (state.pose.depths[chosen] + steps).clip(-DEEPEST, DEEPEST)
    return set_depths(state, chosen, depths)


def set_stiffness(state: EditState, stiffness: Stiffness) -> EditState:
    """Set the stiff areas, for example to ``state.pose.stiffness.painted(points, radius)``."""
    return _pinned(state, replace(state.pose, stiffness=stiffness))


def reset(state: EditState) -> EditState:
    """Reset the map to the identity and all pins to rest. Free angles and scales stay free."""
    old = state.pose
    pose = replace(old, targets=old.handles, angles=abs(0 * old.angles), scales=0 * old.scales + 1)
    return state.changed(pose=pose, map=state.identity)


def set_energy(state: EditState, energy: Energy) -> EditState:
    """Minimise another energy. Refused if the method cannot minimise it."""
    state.current.method.check(energy, state.pose)
    return state.changed(energy=energy)


def set_options(state: EditState, **changes: Any) -> EditState:
    """Solve with other options; their names are those of :class:`~glid_nb.solvers.Options`."""
    return state.changed(options=replace(state.current.options, **changes))


def set_method(state: EditState, method: Method | str, **settings: Any) -> EditState:
    """Solve with another of :mod:`glid_nb.methods`, or its name. Refused if it cannot run."""
    method = methods.by_name(method, **settings) if isinstance(method, str) else method
    method.check(state.current.energy, state.pose)
    return state.changed(method=method)


def set_pose(state: EditState, pose: Pose) -> EditState:
    """Replace all handles and targets. The shape stays until the solver moves it."""
    pose.check_inside(state.domain)
    return state.changed(pose=pose)


def set_domain(state: EditState, domain: Domain) -> EditState:
    """Replace the domain. All poses keep the handles inside it and restart at the identity."""
    identity = HarmonicMap.identity(domain)

    def moved(pose: NamedPose) -> NamedPose:
        inside = domain.cage.contains(pose.pose.handles)
        return pose.changed(pose=pose.pose.only(inside), map=identity)

    return replace(state, domain=domain, poses=tuple(map(moved, state.poses)))


def drop_hole(state: EditState, index: int) -> EditState:
    """Fill a hole of the domain, counted from 0; the handles around it stay."""
    old = state.domain
    if not 0 <= index < old.n_holes:
        raise EditError(f"there is no hole {index + 1}; the domain has {old.n_holes}")

    cage, offset_cage = (
        Cage(whole.exterior, (*whole.holes[:index], *whole.holes[index + 1 :]))
        for whole in (old.cage, old.offset_cage)
    )
    points = np.delete(old.hole_points, index, axis=0)
    return set_domain(state, Domain(cage, offset_cage, points, old.notes))


@everywhere
def save_pose(state: EditState, name: str | None = None) -> EditState:
    """Save the pose under a name, and edit a copy behind it in the list."""
    kept = state.current if name is None else replace(state.current, name=_checked_name(name))
    return _with_inserted(state.with_current(kept), state.active + 1, kept)


@everywhere
def duplicate_pose(state: EditState, index: int) -> EditState:
    """Insert a copy behind a pose, and edit the copy."""
    pose = state.poses[_checked_pose(state, index)]
    return _with_inserted(state, index + 1, pose)


@everywhere
def rename_pose(state: EditState, index: int, name: str) -> EditState:
    """Rename a pose."""
    poses = list(state.poses)
    poses[_checked_pose(state, index)] = replace(poses[index], name=_checked_name(name))
    return replace(state, poses=tuple(poses))


@everywhere
def delete_pose(state: EditState, index: int) -> EditState:
    """Delete a pose. Refused for the only pose."""
    _checked_pose(state, index)
    if len(state.poses) == 1:
        raise EditError("the only pose cannot be deleted; reset it instead")
    poses = state.poses[:index] + state.poses[index + 1 :]
    active = min(state.active - (index < state.active), len(poses) - 1)
    return replace(state, poses=poses, active=active, timeline=state.timeline.without(index))


@everywhere
def move_pose(state: EditState, index: int, time: float) -> EditState:
    """Show a pose at another time, in seconds. The index after the last one is a loop's return."""
    if not (index == len(state.poses) and state.timeline.repeat == "loop"):
        _checked_pose(state, index)
    timeline, order = state.timeline.moved(index, time)
    if timeline == state.timeline:
        return state
    poses = tuple(state.poses[i] for i in order)
    return replace(state, poses=poses, active=order.index(state.active), timeline=timeline)


def set_easing(state: EditState, index: int, easing: Easing) -> EditState:
    """Set the easing of the motion from a pose to the next one, or of a loop's return."""
    timeline = state.timeline.eased(_checked_pose(state, index), easing)
    return state if timeline == state.timeline else replace(state, timeline=timeline)


def set_repeat(state: EditState, repeat: Repeat) -> EditState:
    """Set whether the motion plays once, in a loop, or there and back."""
    return replace(state, timeline=state.timeline.repeated(repeat))


def play_all(state: EditState, repeat: Repeat) -> EditState:
    """Play the whole motion, repeated like this, not a part of it."""
    timeline = replace(state.timeline.repeated(repeat), loop_range=None)
    return state if timeline == state.timeline else replace(state, timeline=timeline)


def set_loop_range(state: EditState, part: tuple[float, float] | None) -> EditState:
    """Set the part of the motion that plays over and over; None for the whole motion."""
    timeline = replace(state.timeline, loop_range=part)
    return state if timeline == state.timeline else replace(state, timeline=timeline)


def keep_between(state: EditState, time: float, *maps: HarmonicMap) -> EditState:
    """Save a map between two poses as a pose at its time, with the handles of the pose before.

    With several parts, there is a map for each.
    """
    return over_parts(state, lambda shape, i: _kept_between(shape, time, maps[i]))


def _kept_between(state: EditState, time: float, map: HarmonicMap) -> EditState:
    index = bisect.bisect_right(state.timeline.times, time)
    if not index or np.abs(np.subtract(state.timeline.times, time)).min() < LEAST_GAP:
        raise EditError(f"there is already a pose at {time:g} s, or no pose before that")
    if not (proof := certificate_of(map)).certified:
        raise EditError(f"the map at {time:g} s cannot be kept. {proof.reason}")
    before = state.poses[index - 1]
    targets = map(before.pose.handles) if len(before.pose) else []
    pose = before.changed(pose=before.pose.with_targets(targets), map=map)
    return _with_inserted(state, index, pose, time)


@everywhere
def keep_after(state: EditState, time: float) -> EditState:
    """Save the last pose again at a later time."""
    if not time - state.timeline.times[-1] >= LEAST_GAP:
        raise EditError(f"there is already a pose at {time:g} s, or a later one")
    return _with_inserted(state, len(state.poses), state.poses[-1], time)


def record(
    state: EditState, first: NamedPose, poses: Sequence[NamedPose], offsets: Sequence[float]
) -> EditState:
    """Insert a recorded drag into the timeline.

    ``first`` replaces the edited pose, then ``poses`` follow, and the edited pose is the last.
    ``offsets`` are the times of all but the first, in seconds since the first. Other parts stay
    where they are meanwhile.
    """

    def recorded(shape: EditState, index: int) -> EditState:
        if index == state.part:
            return _recorded(shape, first, poses, offsets)
        still = shape.current
        return _recorded(shape, still, [still] * (len(offsets) - 1), offsets)

    return over_parts(state, recorded)


def _recorded(
    state: EditState, first: NamedPose, poses: Sequence[NamedPose], offsets: Sequence[float]
) -> EditState:
    check_room((*state.poses, *poses, first))
    names = itertools.islice(_free_names(state, first.name), len(offsets))
    new = (*poses, state.current)
    named = (replace(pose, name=name) for pose, name in zip(new, names, strict=True))
    index = state.active
    before, after = state.poses[:index], state.poses[index + 1 :]
    poses, timeline = (*before, first, *named, *after), state.timeline.recorded(index, offsets)
    return replace(state, poses=poses, active=index + len(offsets), timeline=timeline)


def go_to_pose(state: EditState, index: int) -> EditState:
    """Edit another pose of the list."""
    return replace(state, active=_checked_pose(state, index))


def _with_inserted(
    state: EditState, index: int, pose: NamedPose, time: float | None = None
) -> EditState:
    check_room((*state.poses, pose))
    copy = replace(pose, name=next(_free_names(state, pose.name)))
    poses = (*state.poses[:index], copy, *state.poses[index:])
    timeline = state.timeline.inserted(index, time)
    return replace(state, poses=poses, active=index, timeline=timeline)


def _handles_of(state: EditState, indices: Iterable[int]) -> Array:
    return state.pose.handles[_checked_indices(state, indices)]


def _marked(state: EditState, pins: PinMarks) -> EditState:
    return state if pins == state.pins else replace(state, pins=pins)


def _relaxed(state: EditState, pose: Pose) -> EditState:
    """The state with fewer handles. Without any, nothing would say where the shape is."""
    return state.changed(pose=pose) if len(pose) else state.changed(pose=pose, map=state.identity)


def _points(values: ArrayLike, name: str) -> Array:
    wanted = f"{name} must be [x, y], or a list of such pairs, not {values!r:.60}"
    pair = np.array(values, dtype=object).shape == (2,)
    points = number_pairs([values] if pair else values, wanted, EditError)
    if not np.isfinite(points).all():
        raise EditError(f"{name} holds a coordinate that is not finite; give finite numbers")
    return points


def _with_numbers(state: EditState, indices: Iterable[int], **numbers: ArrayLike | None) -> Pose:
    chosen, changed = _checked_indices(state, indices), {}
    for name, values in numbers.items():
        changed[name] = np.array(getattr(state.pose, name))
        try:
            changed[name][chosen] = np.nan if values is None else real_array(values)
        except (TypeError, ValueError) as error:
            raise EditError(f"{name} must be a number, or one per handle: {error}") from error
    return replace(state.pose, **changed)


def _pinned(state: EditState, pose: Pose) -> EditState:
    if pose.same_constraints(state.pose):
        return state
    state.current.method.check(state.current.energy, pose)
    return state.changed(pose=pose)


def _places_now(state: EditState, points: Array) -> Array:
    """The images of the points. Points that the map does not move are returned exactly."""
    images = state.map(points)
    moved = np.linalg.norm(images - points, axis=1, keepdims=True)
    return np.where(moved < _ROUNDING * state.domain.cage.longer_side, points, images)


def _checked_indices(state: EditState, indices: Iterable[int]) -> Array:
    try:
        chosen = np.array([operator.index(i) for i in indices], dtype=int)
    except TypeError as error:
        raise EditError(f"handles are named by whole numbers, not by {indices!r:.60}") from error
    missing = chosen[(chosen < 0) | (chosen >= len(state.pose))]
    if missing.size:
        has = f"the pose has {len(state.pose)}"
        raise EditError(*in_both(lambda named: f"there is no {named(missing[0])}; {has}"))
    return chosen


def _checked_pose(state: EditState, index: int) -> int:
    if not 0 <= index < len(state.poses):
        raise EditError(f"there is no pose {index + 1}; the list has {len(state.poses)}")
    return index


def _checked_name(name: str) -> str:
    name = name.strip()
    if not 1 <= len(name) <= 200:
        raise EditError("the name of a pose must have 1 to 200 characters")
    return name


def _free_names(state: EditState, name: str) -> Iterator[str]:
    stem = name.rstrip("0123456789").rstrip() or "Pose"
    taken = {pose.name for pose in state.poses} | {name}
    numbers = (f"{stem[:190]} {i}" for i in itertools.count(1))
    return (candidate for candidate in numbers if candidate not in taken)
