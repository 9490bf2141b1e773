"""The shapes of a session with their pictures and poses, as exports take them."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from glid_nb import export as to
from glid_nb.certificate import certificate_of
from glid_nb.imaging.backdrop import Backdrop
from glid_nb.motion import unlike_turns
from glid_nb.session.document import Document, DocumentError, NamedPose
from glid_nb.session.look import background_behind
from glid_nb.session.timeline import Timeline
from glid_nb.session.tracing import layers_of


@dataclass(frozen=True, eq=False)
class PosedShape:
    """One shape, with all of its poses, which are solved."""

    image: NDArray[np.uint8]
    poses: Sequence[NamedPose]
    active: int
    timeline: Timeline
    name: str = ""  # of one of several

    @property
    def turns_alike(self) -> bool:
        """Whether a motion may join the maps of all poses."""
        first, *others = (certificate_of(pose.map) for pose in self.poses)
        return not any(unlike_turns(first, one) for one in others)

    @property
    def moving(self) -> "to.MovingPart":
        """The motion through all poses."""
        motion = self.timeline.motion([pose.map for pose in self.poses])
        return to.MovingPart(self.image, motion, [pose.pose for pose in self.poses], self.name)

    def live(self, *, moving: bool) -> "to.LivePart":
        """What a live page shows: the motion through all poses, or the map of the edited one."""
        current = self.poses[self.active]
        how = current.energy, current.options.p2p_weight, self.name
        if not moving:
            return to.LivePart(self.image, current.map, current.pose, *how)
        part = self.moving
        return to.LivePart(self.image, part.motion, [pose.pose for pose in self.poses], *how)


def live_parts(shapes: Sequence[PosedShape]) -> list["to.LivePart"]:
    """What a live page of these shapes shows: their motions, or their maps if one has no motion."""
    moving = len(shapes[0].poses) > 1 and all(shape.turns_alike for shape in shapes)
    return [shape.live(moving=moving) for shape in shapes]


def shapes_of(document: Document) -> tuple[list[PosedShape], Backdrop]:
    """The visible shapes of a document, the rearmost first, and what lies behind them.

    Without a timeline, the poses are one second apart, in a loop. Raises a DocumentError if all
    parts are hidden, or if there are no poses.
    """
    if not document.poses:
        raise DocumentError("the session has no pose yet; make one in the editor")
    even = replace(Timeline.even(len(document.poses)), repeat="loop")
    documents = [document.of_part(i) for i in range(max(len(document.parts), 1))]
    names = [part.name for part in document.parts] or [""]
    visible = [part.visible for part in document.parts] or [True]
    layers = [layers_of(one) for one in documents]
    shapes = [
        PosedShape(layer.image, one.poses, one.active, one.timeline or even, name)
        for one, layer, name, seen in zip(documents, layers, names, visible, strict=True)
        if seen
    ]
    if not shapes:
        raise DocumentError("all parts of the session are hidden; show one in the editor")
    behind = layers[0].background if len(layers) == 1 else background_behind(layers)
    return shapes, behind
