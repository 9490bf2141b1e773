"""Move poses to other shapes: as text, mirrored, moved inside."""

import json
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import shapely

from glid_nb._arrays import Array
from glid_nb.geometry import Cage
from glid_nb.pose import Pose, PoseError
from glid_nb.session.edit_state import EditError, EditState

_BOX = "cage_box"
_NO_POSE = "this text holds no pose; copy one in an editor first (Ctrl+C on its canvas)"
_MARGIN = 0.01  # distance from the boundary of handles moved inside, relative to the shape's size


def pose_text(state: EditState) -> str:
    """The edited pose as JSON, with the corners of its shape's bounding box."""
    return json.dumps({_BOX: _box(state.domain.cage).tolist(), **state.pose.to_dict()})


def paste_pose(state: EditState, text: str) -> EditState:
    """Apply a pose from its text, stretched from its shape's bounding box to this shape's."""
    try:
        data: Any = json.loads(text)
        pose = Pose.from_dict(data)
        box = np.array(data.get(_BOX, _box(state.domain.cage)), dtype=float)
    except (ValueError, TypeError, RecursionError) as error:
        why = f" ({error.plain})" if isinstance(error, PoseError) else ""
        raise EditError(_NO_POSE + why) from error
    if box.shape != (2, 2) or not (box[1] > box[0]).all() or not np.isfinite(box).all():
        raise EditError(f"{_BOX} must be the lower and the upper corner of a box, not {box}")
    here = _box(state.domain.cage)
    if np.allclose(box, here, rtol=0, atol=1e-9):
        return _posed(state, pose)
    stretch = (here[1] - here[0]) / (box[1] - box[0])
    return _posed(state, pose, lambda z: here[0] + (z - box[0]) * stretch, stretch.prod() ** 0.5)


def mirror_pose(state: EditState) -> EditState:
    """Mirror the pose left to right, about the middle of the shape."""
    pose, across = state.pose, _box(state.domain.cage).sum(axis=0) * [1, 0]
    pose = replace(pose, angles=-pose.angles)
    return _posed(state, pose, lambda points: across + points * [-1, 1])


def _posed(
    state: EditState, pose: Pose, place: Callable[[Array], Array] = np.array, scale: float = 1.0
) -> EditState:
    """Apply a pose at other places. Handles outside the shape move inside. Of several handles in
    one place, one is kept."""
    handles, targets = place(pose.handles), place(pose.targets)
    pose = replace(pose, stiffness=pose.stiffness.moved(place, scale))
    moved = _inside(state.domain.cage, handles)
    targets += moved - handles
    gaps = np.linalg.norm(moved[:, None] - moved, axis=2)
    apart = ~np.triu(gaps < _MARGIN / 4 * state.domain.cage.longer_side, 1).any(axis=0)
    new = replace(pose.only(apart), handles=moved[apart], targets=targets[apart])
    state.current.method.check(state.current.energy, new)
    marked = replace(state, pins=state.pins.moved(pose.handles[apart], new.handles))
    return marked.changed(pose=new, map=state.identity)


def _inside(cage: Cage, points: Array) -> Array:
    outside = ~cage.contains(points)
    inner = cage.polygon.buffer(-_MARGIN * cage.longer_side)
    inner = cage.polygon.representative_point() if inner.is_empty else inner
    moved = points.copy()
    ways = shapely.shortest_line(inner, shapely.points(points[outside]))
    moved[outside] = shapely.get_coordinates(ways)[::2]
    return moved


def _box(cage: Cage) -> Array:
    return np.array([cage.exterior.min(axis=0), cage.exterior.max(axis=0)])
