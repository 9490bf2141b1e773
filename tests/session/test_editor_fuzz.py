"""Random actions on the whole editor: no pose claims a map that it does not have."""

from __future__ import annotations

import contextlib
import tempfile
from pathlib import Path
from typing import Any

import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import settings
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule

from glid_nb.certificate import certify
from glid_nb.session.animation import Animation, motion_of
from glid_nb.session.document import NamedPose
from glid_nb.session.document_file import load_document
from glid_nb.session.edit_state import EditError
from glid_nb.session.editor_model import EditorModel
from glid_nb.session.live_solver import solve_edited

from .test_editor_model import picture

TIMEOUT = 120.0
VISIBLE = 0.01  # world units

index = st.integers(0, 3)
near = st.tuples(st.floats(-6, 6), st.floats(-2.5, 2.5))


def miss(pose: NamedPose) -> float:
    return float(np.abs(pose.map(pose.pose.handles) - pose.pose.targets).max(initial=0))


class Session(RuleBasedStateMachine):
    """Tracing, deforming, the timeline and files in any order, with and without waiting."""

    def __init__(self) -> None:
        super().__init__()
        self.folder = tempfile.TemporaryDirectory()
        self.model = EditorModel(picture())
        self.deformation.add_handles([(-6, 0), (6, 0)])
        self.animation = Animation(self.deformation)
        self.checked: set[NamedPose] = set()

    def teardown(self) -> None:
        self.animation.close()
        self.model.close()
        self.folder.cleanup()

    @property
    def deformation(self) -> Any:
        return self.model.deformation

    def follow(self) -> None:
        """The timeline belongs to the deformation. Another picture has another deformation."""
        if self.animation.deformation is not self.deformation:
            self.animation.close()
            self.animation = Animation(self.deformation)

    @rule(i=index, to=near)
    def drag(self, i: int, to: Any) -> None:
        with contextlib.suppress(EditError):
            self.deformation.drag(i, to)

    @rule(name=st.sampled_from(["undo", "redo", "save_pose", "reset", "stop"]))
    def simple(self, name: str) -> None:
        getattr(self.deformation, name)()

    @rule(
        name=st.sampled_from(["duplicate_pose", "delete_pose", "go_to_pose", "go_to_pose"]), i=index
    )
    def pose(self, name: str, i: int) -> None:
        with contextlib.suppress(EditError):
            getattr(self.deformation, name)(i)

    @rule(i=index, time=st.floats(0, 4))
    def move_pose(self, i: int, time: float) -> None:
        with contextlib.suppress(EditError):
            self.deformation.move_pose(i, time)

    @rule(name=st.sampled_from(["newton", "mean-value"]))
    def set_method(self, name: str) -> None:
        self.deformation.set_method(name)

    @rule()
    def pause(self) -> None:
        self.deformation.paused = not self.deformation.paused

    @rule(on=st.booleans())
    def record(self, on: bool) -> None:
        self.animation.record(on)

    @rule()
    def drop_hole(self) -> None:
        with contextlib.suppress(EditError):
            self.deformation.drop_hole(0)

    @rule(offset=st.sampled_from([2.0, 4.0]))
    def retrace(self, offset: float) -> None:
        self.model.tracing.set_options(offset=offset)
        self.model.apply_tracing()

    @rule()
    def toggle_hole(self) -> None:
        if self.model.tracing.holes:
            self.model.tracing.toggle_hole(0)
            self.model.apply_tracing()

    @rule(name=st.sampled_from(["undo", "redo"]))
    def tracing(self, name: str) -> None:
        getattr(self.model.tracing, name)()
        self.model.apply_tracing()
        self.follow()

    @rule(width=st.sampled_from([60, 80]))
    def another_picture(self, width: int) -> None:
        self.model.tracing.open(picture(width))
        self.model.apply_tracing()
        self.follow()

    @rule()
    def wait(self) -> None:
        assert self.animation.wait(TIMEOUT)
        state = self.deformation.state
        assert all(pose.solved or not pose.unsolved or self.excused(pose) for pose in state.poses)
        assert {span.map.domain for span in self.animation.spans} <= {state.domain}
        assert not any(span.status == "computing" for span in self.animation.spans)

    @rule()
    def make_motion(self) -> None:
        if len(self.deformation.state.poses) < 2:
            return
        self.deformation.finish()
        if any(pose.unsolved for pose in self.deformation.state.poses):
            assert any(map(self.excused, self.deformation.state.poses))
            with pytest.raises(EditError, match="the pose '"):
                self.deformation.solved_state()
            return
        motion = motion_of(self.deformation.solved_state())
        state = self.deformation.state
        assert all(keyframe.domain is state.domain for keyframe in motion.keyframes)
        assert not any(pose.unsolved for pose in state.poses)

    @precondition(lambda self: self.model.has_shape)
    @rule(again=st.booleans())
    def save(self, again: bool) -> None:
        path = Path(self.folder.name) / "s.glid"
        self.model.save(path)
        state, saved = self.deformation.state, load_document(path)
        assert [p.name for p in saved.unsolved] == [p.name for p in state.poses if p.unsolved]
        assert all(map(self.excused, saved.unsolved))
        if again:
            self.model.load(path)
            self.follow()

    def excused(self, pose: NamedPose) -> bool:
        return self.deformation.paused or not pose.method.certified

    @invariant()
    def no_pose_claims_what_it_has_not(self) -> None:
        state = self.deformation.state
        for pose in state.poses:
            assert pose.map.domain is state.domain
            assert state.domain.cage.contains(pose.pose.handles).all()
            if pose.solved and pose not in self.checked:
                self.checked.add(pose)
                assert certify(pose.map).certified
                if miss(pose) > VISIBLE:  # as close as a new solve comes
                    identity = pose.changed(map=state.identity)
                    fresh = solve_edited(identity, lambda _: False)
                    assert miss(pose) <= miss(pose.changed(map=fresh.map)) + VISIBLE
        assert self.deformation.status.level != "error", self.deformation.status.text


Session.TestCase.settings = settings(max_examples=8, stateful_step_count=25, deadline=None)
TestSession = pytest.mark.slow(Session.TestCase)
