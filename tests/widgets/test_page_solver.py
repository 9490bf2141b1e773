"""What the page's own solver is told of the edited pose."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

import glid_nb as glid
from glid_nb.widgets import DeformCanvas
from glid_nb.widgets.page_solver import can_solve

from ..support.domains import domain
from .test_shader import PICTURE

pytestmark = pytest.mark.slow  # most of the time is compiling

PINS = [[-0.5, -0.5], [0.5, -0.5]]


@pytest.fixture
def canvas() -> Iterator[DeformCanvas]:
    """A canvas that a page has drawn, with two pins, at rest."""
    canvas = DeformCanvas(PICTURE, domain("ell"), n_vertices=80)
    canvas.deformation.set_pose(glid.Pose(PINS, PINS))
    assert canvas.deformation.solve(60)
    canvas.pane.stage.drawn = True
    yield canvas
    canvas.close()


def _coefficients(map: glid.HarmonicMap) -> np.ndarray:
    return np.concatenate([map.phi.real, map.phi.imag, map.psi.real, map.psi.imag])


def test_at_rest_the_page_knows_pose_and_map_to_the_last_bit(canvas: DeformCanvas) -> None:
    stage, model = canvas.pane.stage, canvas.deformation
    assert stage.solver["options"] == {"energy": "iso", "s": 1.0, "weight": 1e5, "stiff": None}
    assert stage.solver_script
    assert stage.outline["outline"]["cage"] == model.state.domain.cage.loops[0].tolist()
    number = stage.rest["number"]
    model.drag(1, to=(0.6, -0.3))
    assert model.solve(60)
    assert stage.rest["number"] > number
    assert stage.rest["pose"]["targets"] == model.pose.targets.tolist()
    assert stage.rest["pose"]["angles"] == [None, None]
    told = np.frombuffer(stage.rest["coefficients"], "<f8")
    assert (told == _coefficients(model.map)).all()


def test_nothing_is_told_during_a_drag_and_again_if_it_is_cancelled(canvas: DeformCanvas) -> None:
    stage, model = canvas.pane.stage, canvas.deformation
    before = stage.rest
    model.begin_drag([1])
    model.drag_to(np.array([[0.55, -0.4]]))
    assert model.solve(60)
    assert stage.rest is before
    model.cancel_drag()
    assert model.solve(60)
    # The pose is that of before. The page has to hear of it, for it shows its own map.
    assert stage.rest["number"] > before["number"]
    assert stage.rest["pose"] == before["pose"]


def test_a_drag_that_makes_a_pin_is_told_once(canvas: DeformCanvas) -> None:
    stage, model = canvas.pane.stage, canvas.deformation
    number = stage.rest["number"]
    with model.locked():  # as the events of one message are
        made = model.add_handle((0.0, -0.6))
        model.begin_drag([made])
        model.drag_to(np.array([[0.1, -0.5]]))
    assert stage.rest["number"] == number + 1
    assert stage.rest["pose"]["targets"] == [*PINS, [0.1, -0.5]]
    model.drag_to(np.array([[0.1, -0.4]]))
    assert model.solve(60)
    assert stage.rest["number"] == number + 1
    model.end_drag()
    assert model.solve(60)
    assert stage.rest["pose"]["targets"] == [*PINS, [0.1, -0.4]]


def test_a_page_that_has_drawn_nothing_is_told_nothing() -> None:
    canvas = DeformCanvas(PICTURE, domain("ell"), n_vertices=80)
    assert canvas.deformation.solve(60)
    stage = canvas.pane.stage
    assert (stage.solver, stage.solver_script, stage.rest) == ({}, "", {})
    canvas.close()


def test_the_page_hears_of_another_energy_and_of_stiff_areas(canvas: DeformCanvas) -> None:
    stage, model = canvas.pane.stage, canvas.deformation
    model.set_energy(glid.energies.ExponentialSymmetricDirichlet(0.5))
    assert model.solve(60)
    assert (stage.solver["options"]["energy"], stage.solver["options"]["s"]) == ("exp", 0.5)
    stroke = {"points": [[-0.5, -0.5], [0.0, -0.5]], "radius": 0.2, "strength": 0.5}
    model.set_pose(glid.Pose(PINS, PINS, stiffness=[stroke]))
    assert model.solve(60)
    assert stage.solver["options"]["stiff"]["points"]


def test_what_the_page_cannot_solve_is_left_to_the_kernel(canvas: DeformCanvas) -> None:
    stage, model = canvas.pane.stage, canvas.deformation
    assert can_solve(model.moment)
    model.paused = True
    assert stage.solver == {}
    model.paused = False
    assert model.solve(60)
    assert stage.solver
    model.set_options(conformal=True)
    assert model.solve(60)
    assert not can_solve(model.moment)
    assert stage.solver == {}
