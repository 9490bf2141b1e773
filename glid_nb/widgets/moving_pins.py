"""The pins of a motion, for the page to draw while the motion is seen."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from glid_nb._arrays import Array
from glid_nb.harmonic import images_under
from glid_nb.pose import Pose
from glid_nb.session.animation import Span, shown_pins
from glid_nb.session.edit_state import EditState


def moving_pins(state: EditState, spans: Sequence[Span]) -> dict[str, Any]:
    """Where the pins are that a drag takes while a motion is seen.

    ``spans`` says it from keyframe to keyframe: ``end``, ``times`` of the knots, ``floats``, the
    images x, y of all pins at the first knot, then at the others, and the indices of those that are
    ``locked``. Between two knots the images move on straight lines, as the coefficients do. The
    pins are those of the pose before. ``poses`` says it at the ``keyframes``, whose times are those
    of a closed timeline: there a drag takes that pose's pins, which are at their targets. Places of
    pins that the user has hidden are not numbers.
    """
    poses = [named.pose for named in state.poses]
    moving = [_moving(state, pose, span) for pose, span in zip(poses, spans, strict=False)]
    return {
        "spans": moving,
        "poses": [
            {
                "floats": _wire(shown_pins(state, pose, pose.targets)),
                "locked": _locked(state, pose),
            }
            for pose in poses
        ],
        "keyframes": list(state.timeline.closed_times),
    }


def _moving(state: EditState, pose: Pose, span: Span) -> dict[str, Any]:
    times, maps = span.knots
    places = np.empty((len(maps), 0, 2))
    if len(pose):
        images = images_under(maps, pose.handles)  # (h, 2 m)
        places = shown_pins(state, pose, images).reshape(len(pose), len(maps), 2).swapaxes(0, 1)
    return {
        "end": span.end,
        "times": list(times),
        "floats": _wire(places),
        "locked": _locked(state, pose),
    }


def _locked(state: EditState, pose: Pose) -> list[int]:
    return [i for i, mark in enumerate(state.pins.of(pose.handles)) if mark.locked]


def _wire(places: Array) -> bytes:
    return places.astype(np.float32).tobytes()
