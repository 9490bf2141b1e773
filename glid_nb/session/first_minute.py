"""The hints of the first minute: what to try next, one at a time."""

from typing import Literal

from glid_nb.session.edit_state import EditState

Step = Literal["pin", "drag", "turn", "keep", "play"]

HINTS: dict[Step, str] = {
    "pin": "Click the shape to pin a point, then drag the pin",
    "drag": "Drag the pin: the shape follows, and never folds",
    "turn": "Drag around the pin on its ring to turn the shape; the knob scales it too",
    "keep": "Keep this pose as a keyframe: Key (K) in the timeline",
    "play": "Change the new pose, then play the motion: Space, or the button in the timeline",
}
"""The steps in their order, and how to make each."""


class FirstMinute:
    """The steps that somebody has made, and the hint at the next one.

    A hint is not given again once its step was made, in any editor that shares this object.
    """

    def __init__(self) -> None:
        self._made: set[Step] = set()

    def made(self, *steps: Step) -> None:
        """Note that these steps were made."""
        self._made.update(steps)

    def hint(self, state: EditState) -> str:
        """Note the steps that a state shows, and return the hint at the next; empty after the
        last."""
        self.made(*steps_in(state))
        return next((text for step, text in HINTS.items() if step not in self._made), "")


IN_THIS_SESSION = FirstMinute()
"""What the user of this process has done."""


def steps_in(state: EditState) -> list[Step]:
    """The steps that somebody must have made to reach a state."""
    poses = [named.pose for named in state.poses]
    shown: dict[Step, bool] = {
        "pin": any(len(pose) for pose in poses),
        "drag": any((pose.targets != pose.handles).any() for pose in poses),
        "turn": any(pose.oriented.any() for pose in poses),
        "keep": len(poses) > 1,
    }
    return [step for step, is_made in shown.items() if is_made]
