"""The editor's actions as pure functions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from glid_nb.energies import AMIPS
from glid_nb.geometry import Cage, Domain
from glid_nb.harmonic import HarmonicMap
from glid_nb.pose import Pose, PoseError
from glid_nb.session import actions, pose_text
from glid_nb.session.document import Solution
from glid_nb.session.edit_state import EditError, EditState
from glid_nb.solvers import OptionError, Status

from ..support.domains import domain


@pytest.fixture
def state() -> EditState:
    return EditState.initial(domain("ring"), Pose([[2, 0], [-2, 0]], [[2.5, 0], [-2, 0]]))


def test_a_handle_is_pinned_where_it_is(state: EditState) -> None:
    new = actions.add_handles(state, (0, 2))
    assert new.pose.handles[2].tolist() == [0, 2]
    assert new.pose.targets[2].tolist() == [0, 2]
    assert len(state.pose) == 2
    assert new.map is state.map
    assert not new.current.solved


def test_no_new_handles_are_no_step(state: EditState) -> None:
    assert actions.add_handles(state, []) is state


def test_what_has_moved_is_pinned_where_it_has_moved_to(state: EditState) -> None:
    identity = state.map
    turned = HarmonicMap(state.domain, 1j * identity.phi, -1j * identity.psi)
    new = actions.add_handles(
        state.with_current(state.current.changed(map=turned)), [(0, 2), (0.1, 2.1)]
    )
    np.testing.assert_allclose(new.pose.targets[2:], [[-2, 0], [-2.1, 0.1]], atol=1e-9)


@pytest.mark.parametrize(
    ("action", "message"),
    [
        (lambda s: actions.add_handles(s, (0, 0)), "outside the shape"),
        (lambda s: actions.add_handles(s, (2, 0)), "pinned already"),
        (lambda s: actions.add_handles(s, [(0, 2), (0, 2)]), "pinned already"),
        (lambda s: actions.add_handles(s, (np.nan, 2)), "not finite"),
        (lambda s: actions.move_targets(s, [0], (np.inf, 2)), "not finite"),
        (lambda s: actions.add_handles(s, "ab"), r"point must be \[x, y\].*not 'ab'"),
        (lambda s: actions.add_handles(s, (0, 2), "ab"), r"to must be \[x, y\].*not 'ab'"),
        (lambda s: actions.add_handles(s, (True, 2)), "true and false are not numbers"),
        (lambda s: actions.add_handles(s, (1, 2, 3)), r"point must be.*shape is \(3,\)"),
        (lambda s: actions.move_targets(s, [0], None), r"to must be \[x, y\]"),
        (lambda s: actions.move_targets(s, [0], [(1, 2), (3, 4)]), "2 points for 1 handles"),
        (lambda s: actions.move_targets(s, "a", (1, 2)), "whole numbers, not by 'a'"),
        (lambda s: actions.move_targets(s, [0.5], (1, 2)), "whole numbers"),
        (lambda s: actions.nudge(s, [0], "left"), r"delta must be \[x, y\]"),
        (lambda s: actions.move_targets(s, [2], (0, 0)), "no handle 2"),
        (lambda s: actions.remove_handles(s, [-1]), "no handle -1"),
        (lambda s: actions.drop_hole(s, 1), "no hole 2"),
        (lambda s: actions.delete_pose(s, 0), "only pose"),
        (lambda s: actions.go_to_pose(s, 1), "no pose 2"),
        (lambda s: actions.rename_pose(s, 0, " "), "1 to 200 characters"),
    ],
)
def test_what_cannot_be_done_is_refused(
    state: EditState, action: Callable[[EditState], EditState], message: str
) -> None:
    with pytest.raises(EditError, match=message):
        action(state)


def test_a_wrong_option_is_refused(state: EditState) -> None:
    with pytest.raises(OptionError, match="p2p_weight"):
        actions.set_options(state, p2p_weight=-1.0)


def test_handles_are_removed_and_cleared(state: EditState) -> None:
    assert actions.remove_handles(state, [0]).pose.handles.tolist() == [[-2, 0]]
    assert len(actions.clear_handles(state).pose) == 0


def test_a_shape_without_pins_is_at_rest(state: EditState) -> None:
    ring = state.domain
    phi = state.map.phi.copy()
    phi[: len(ring.offset_cage.exterior)] += 10
    aside = HarmonicMap(ring, phi, state.map.psi)
    moved = state.changed(map=aside)
    assert actions.remove_handles(moved, [0]).map is aside
    assert actions.remove_handles(moved, [0, 1]).map is moved.identity
    assert actions.clear_handles(moved).map is moved.identity


def test_targets_move_and_are_nudged(state: EditState) -> None:
    moved = actions.move_targets(state, [1], (-3, 1))
    assert moved.pose.targets.tolist() == [[2.5, 0], [-3, 1]]
    assert actions.nudge(moved, [0, 1], (0.5, 0)).pose.targets.tolist() == [[3, 0], [-2.5, 1]]


def test_reset_goes_back_to_the_undeformed_shape(state: EditState) -> None:
    turned = actions.set_pins(state, [0], angles=-0.5)
    turned = actions.set_pins(turned, [1], scales=1.5)
    new = actions.reset(turned)
    assert new.pose.targets.tolist() == state.pose.handles.tolist()
    np.testing.assert_allclose(new.map([[2, 0]]), [[2, 0]], atol=1e-9)
    np.testing.assert_array_equal(new.pose.angles, [0, np.nan])  # free pins stay free
    np.testing.assert_array_equal(new.pose.scales, [np.nan, 1])


def test_a_dropped_hole_keeps_the_handles(state: EditState) -> None:
    new = actions.drop_hole(state, 0)
    assert new.domain.n_holes == 0
    assert new.pose.handles.tolist() == state.pose.handles.tolist()
    assert actions.add_handles(new, (0, 0)).pose.handles[2].tolist() == [0, 0]
    assert new.map.domain is new.domain


def test_another_domain_keeps_the_handles_inside(state: EditState) -> None:
    new = actions.set_domain(state, domain("ell"))
    assert new.pose.handles.tolist() == [[2, 0], [-2, 0]]
    third = actions.add_handles(state, (0, 2.5))
    assert len(actions.set_domain(third, domain("twin")).pose) == 0


def test_the_list_of_poses(state: EditState) -> None:
    two = actions.save_pose(state, "left")
    assert [p.name for p in two.poses] == ["left", "left 1"]
    assert two.active == 1
    assert two.pose is state.pose
    moved = actions.set_energy(actions.move_targets(two, [0], (0, 2)), AMIPS(0.5))
    back = actions.go_to_pose(moved, 0)
    assert back.pose is state.pose
    assert back.current.energy == state.current.energy
    assert actions.go_to_pose(back, 1).pose is moved.pose
    three = actions.duplicate_pose(back, 0)
    assert [p.name for p in three.poses] == ["left", "left 2", "left 1"]
    fewer = actions.delete_pose(three, 0)
    assert (len(fewer.poses), fewer.active) == (2, 0)
    assert actions.rename_pose(fewer, 1, " right ").poses[1].name == "right"


def test_a_pose_fits_a_similar_shape(state: EditState) -> None:
    posed = actions.set_pins(state, [0], angles=0.3)
    text = pose_text.pose_text(posed)
    twice = EditState.initial(Domain.from_cage(Cage(2 * state.domain.cage.exterior)))
    pose = pose_text.paste_pose(twice, text).pose
    np.testing.assert_allclose(pose.handles, 2 * posed.pose.handles)
    np.testing.assert_allclose(pose.targets, 2 * posed.pose.targets)
    assert pose.angles[0] == 0.3
    # A handle that would lie in the hole moves to its edge.
    moved = text.replace("[[2.0, 0.0]", "[[0.1, 0.0]")
    assert moved != text
    pose_text.paste_pose(state, moved).pose.check_inside(state.domain)


def test_depths_move_nothing_and_are_a_step_of_their_own(state: EditState) -> None:
    solution = Solution(Status.CONVERGED, "done", (), ())
    state = state.with_current(replace(state.current, solution=solution))
    new = actions.bring_forward(actions.set_depths(state, [0], -2.5), [0, 1])
    assert new.pose.depths.tolist() == [-1.5, 1]
    assert new.map is state.map
    assert new.current.solution is solution  # nothing is solved again
    assert actions.set_depths(new, [1], 1.0) is new
    assert actions.bring_forward(new, [1], 1000).pose.depths.tolist() == [-1.5, 100]
    assert actions.remove_handles(new, [0]).pose.depths.tolist() == [1]
    assert actions.set_domain(new, new.domain).pose.depths.tolist() == [-1.5, 1]
    assert actions.move_target(new, 0, (3, 0)).pose.depths.tolist() == [-1.5, 1]
    with pytest.raises(EditError, match="depths must be a number, or one per handle"):
        actions.set_depths(state, [0, 1], [1.0, 2.0, 3.0])
    with pytest.raises(PoseError, match="depths must be 2 numbers"):
        actions.set_depths(state, [0], float("nan"))


def test_a_new_handle_has_the_depth_of_the_shape_there(state: EditState) -> None:
    assert actions.add_handles(state, (0, 2)).pose.depths.tolist() == [0, 0, 0]
    deep = actions.add_handles(actions.set_depths(state, [0], -1), [(1.9, 0.1), (-1.9, 0.1)])
    assert -1 < deep.pose.depths[2] < -0.5
    assert abs(deep.pose.depths[3]) < 0.1
    points = np.array([[2.2, 0.3], [0.0, 2.0], [-2.2, 0.0]])
    before = actions.set_depths(state, [0], -1).order(points)
    np.testing.assert_allclose(deep.order(points), before, atol=0.02)


def test_a_handle_can_be_removed_without_moving_the_shape(state: EditState) -> None:
    with pytest.raises(EditError, match="still moving"):
        actions.remove_handles(state, [0], keep_shape=True)
    solution = Solution(Status.CONVERGED, "done", (), ())
    solved = state.with_current(replace(state.current, solution=solution))
    kept = actions.remove_handles(solved, [0], keep_shape=True)
    assert kept.pose.handles.tolist() == [[-2, 0]]
    assert kept.map is solved.map
    assert kept.current.solved
    assert not actions.remove_handles(solved, [0]).current.solved
