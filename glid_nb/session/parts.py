"""Several shapes of one session: actions on its parts, and actions done to all of them.

All parts have the same keyframes. An action on keyframes changes all parts in one step for undo.
"""

import functools
import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Concatenate, ParamSpec

import numpy as np
from numpy.typing import NDArray

from glid_nb.geometry import Domain
from glid_nb.harmonic import HarmonicMap
from glid_nb.pose import Pose
from glid_nb.session.document import MOST_PARTS, NamedPose
from glid_nb.session.edit_state import EditError, EditState, Part
from glid_nb.session.names import LONGEST_NAME, free_name

P = ParamSpec("P")

FIRST_KEY = 0  # of the shape that a session had before it had parts


@dataclass(frozen=True, eq=False)
class NewPart:
    """A shape to add to a session."""

    name: str
    image: NDArray[np.uint8]  # (h, w, 4), as large as the session's picture
    domain: Domain


def over_parts(state: EditState, action: Callable[[EditState, int], EditState]) -> EditState:
    """The state after ``action(shape, index)`` on each of its `EditState.shapes`."""
    shapes = state.shapes
    new = [action(shape, index) for index, shape in enumerate(shapes)]
    if not state.parts:
        return new[0]
    if all(one is shape for one, shape in zip(new, shapes, strict=True)):
        return state
    pairs = zip(state.parts, new, strict=True)
    edited = new[state.part]
    return replace(
        state,
        poses=edited.poses,
        active=edited.active,
        timeline=edited.timeline,
        parts=tuple(replace(part, poses=one.poses) for part, one in pairs),
    )


def everywhere(
    action: Callable[Concatenate[EditState, P], EditState],
) -> Callable[Concatenate[EditState, P], EditState]:
    """An action on keyframes that changes all parts alike."""

    @functools.wraps(action)
    def done(state: EditState, *arguments: P.args, **named: P.kwargs) -> EditState:
        return over_parts(state, lambda shape, _: action(shape, *arguments, **named))

    return done


def add_parts(
    state: EditState,
    new: Sequence[NewPart],
    name: str = "",
    image: NDArray[np.uint8] | None = None,
) -> EditState:
    """Add shapes in front of the others, at rest in all keyframes.

    ``name`` and ``image`` are those of the only shape of a session that gets its first parts.
    """
    if not new:
        return state
    parts = state.parts
    if not parts:
        if image is None:
            raise EditError("the picture of the first part is missing; give it")
        parts = (Part(FIRST_KEY, checked_name(name), image, state.domain, state.poses),)
    if len(parts) + len(new) > MOST_PARTS:
        raise EditError(f"a session holds at most {MOST_PARTS} parts; choose fewer")
    size, keys = parts[0].image.shape, itertools.count(1 + max(part.key for part in parts))
    for key, one in zip(keys, new, strict=False):
        if one.image.shape != size:
            sizes = " and ".join(f"{w} x {h}" for h, w, _ in (size, one.image.shape))
            raise EditError(f"the pictures of all parts must have the same size, not {sizes}")
        name = free_name(checked_name(one.name), [part.name for part in parts])
        parts += (Part(key, name, one.image, one.domain, _at_rest(state, one.domain)),)
    return replace(state, parts=parts)


def select_part(state: EditState, index: int) -> EditState:
    """Edit another part, which is shown from then on."""
    part = state.parts[_checked_part(state, index)]
    if index == state.part:
        return state
    state = _with_part(state, index, visible=True)
    return replace(state, part=index, domain=part.domain, poses=part.poses)


def select_next(state: EditState, step: int) -> EditState:
    """Edit the next visible part in front (1) or behind (-1), around the ends."""
    count = len(state.parts)
    order = [(state.part + step * i) % count for i in range(1, count)]
    following = next((i for i in order if state.parts[i].visible), state.part)
    return select_part(state, following) if state.parts else state


def show_part(state: EditState, index: int, visible: bool) -> EditState:
    """Show or hide a part, on the canvas and in exports.

    If the edited part is hidden, the next visible one is edited. Refused for the last visible one.
    """
    _checked_part(state, index)
    if not visible and index == state.part:
        state = select_next(state, 1)
        if index == state.part:
            raise EditError("this is the only visible part; show another one first")
    return _with_part(state, index, visible=bool(visible))


def rename_part(state: EditState, index: int, name: str) -> EditState:
    """Rename a part. A name that another part has gets a number."""
    others = [part.name for i, part in enumerate(state.parts) if i != index]
    return _with_part(state, index, name=free_name(checked_name(name), others))


def move_part(state: EditState, index: int, to: int) -> EditState:
    """Move a part to another place in the order; 0 is the rearmost."""
    _checked_part(state, index)
    to = min(max(to, 0), len(state.parts) - 1)
    if to == index:
        return state
    order = [i for i in range(len(state.parts)) if i != index]
    order.insert(to, index)
    parts = tuple(state.parts[i] for i in order)
    return replace(state, parts=parts, part=order.index(state.part))


def remove_part(state: EditState, index: int) -> EditState:
    """Remove a part. Refused for the only one."""
    _checked_part(state, index)
    if len(state.parts) == 1:
        raise EditError("the only part cannot be removed")
    if index == state.part:
        state = select_next(state, 1)
    if index == state.part:  # all others are hidden
        state = select_part(state, (index + 1) % len(state.parts))
    parts = (*state.parts[:index], *state.parts[index + 1 :])
    return replace(state, parts=parts, part=state.part - (index < state.part))


def checked_name(name: str) -> str:
    """A part's name without spaces around it. Raises an EditError if it is empty or too long."""
    name = name.strip()
    if not 1 <= len(name) <= LONGEST_NAME:
        raise EditError(f"the name of a part must have 1 to {LONGEST_NAME} characters")
    return name


def _with_part(state: EditState, index: int, **changes: Any) -> EditState:
    part = state.parts[_checked_part(state, index)]
    new = replace(part, **changes)
    if (new.name, new.visible) == (part.name, part.visible):
        return state
    return replace(state, parts=(*state.parts[:index], new, *state.parts[index + 1 :]))


def _at_rest(state: EditState, domain: Domain) -> tuple[NamedPose, ...]:
    """Poses without handles on a new domain, for the keyframes of a state."""
    identity = HarmonicMap.identity(domain)
    rest = Pose([], [])
    return tuple(pose.changed(pose=rest, map=identity) for pose in state.poses)


def _checked_part(state: EditState, index: int) -> int:
    if not 0 <= index < len(state.parts):
        raise EditError(f"there is no part {index + 1}; the session has {len(state.parts)}")
    return index
