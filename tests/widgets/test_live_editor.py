"""The live editor's side in the kernel: what the page sends is checked before it is taken."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from traitlets import TraitError

import glid_nb as glid
from glid_nb import HarmonicMap, InputError, Pose
from glid_nb.page import coefficients_of
from glid_nb.pose import PoseError
from glid_nb.widgets import Editor, LiveEditor

from ..support import shapes

PINS = [[-3.0, 0.0], [3.0, 0.0]]


@pytest.fixture
def live() -> Iterator[LiveEditor]:
    """Two pins on the ring, one of them behind, and its left half stiff."""
    stiffness = [{"points": [[-4, 0]], "radius": 2.0, "strength": 0.5}]
    pose = Pose(PINS, PINS, [0.0, -1.0], stiffness=stiffness)
    live = LiveEditor(shapes.picture(), shapes.domain(), pose)
    yield live
    live.close()


def from_page(live: LiveEditor, pins: list[dict[str, Any]], map: HarmonicMap) -> None:
    """A pose and a map from a view on the page."""
    coefficients = coefficients_of(map)
    live.set_state({"edit": {"by": "view", "pins": pins, "coefficients": coefficients}})


def pin(handle: list[float], target: list[float], **more: Any) -> dict[str, Any]:
    free = {"angle": None, "scale": None, "weight": 1.0, "depth": 0.0, "name": ""}
    return {"handle": handle, "target": target, **free, **more}


def scaled(live: LiveEditor, factor: float) -> HarmonicMap:
    identity = HarmonicMap.identity(live.map.domain)
    return HarmonicMap(identity.domain, factor * identity.phi, identity.psi)


def mirrored(live: LiveEditor) -> HarmonicMap:
    identity = HarmonicMap.identity(live.map.domain)
    return HarmonicMap(identity.domain, identity.psi, identity.phi)


def test_a_pose_of_the_page_and_its_map_are_taken(live: LiveEditor) -> None:
    heard: list[Pose] = []
    live.observe(lambda _: heard.append(live.pose), ["edit"])
    hand = pin(PINS[1], [6.0, 0.0], angle=0.1, depth=-1.0, name="hand")
    pins = [hand, pin([0.0, 3.0], [0.0, 6.0])]
    from_page(live, pins, scaled(live, 2))
    assert heard == [live.pose]
    np.testing.assert_array_equal(live.pose.targets, [[6, 0], [0, 6]])
    np.testing.assert_array_equal(live.pose.angles, [0.1, np.nan])
    assert live.pose.depths.tolist() == [-1, 0]
    assert live.pose.names.tolist() == ["hand", ""]
    assert len(live.pose.stiffness.strokes) == 1
    np.testing.assert_allclose(live.map([[3, 0]]), [[6, 0]], atol=1e-12)
    assert live.certificate.certified
    assert live.certificate.sigma2_lower == pytest.approx(2, rel=1e-6)


def test_what_the_page_must_not_send_changes_nothing(live: LiveEditor) -> None:
    before = live.pose, live.map, live.edit
    good = pin([3.0, 0.0], [6.0, 0.0])
    with pytest.raises(TraitError, match="refused: The map is not locally injective"):
        from_page(live, [good], mirrored(live))
    for wrong in (pin([3.0, 0.0], [np.inf, 0.0]), pin([90.0, 0.0], [6.0, 0.0])):
        with pytest.raises(TraitError, match=r"target|outside"):
            from_page(live, [wrong], scaled(live, 2))
    assert (live.pose, live.map, live.edit) == before


def test_a_pose_that_code_sets_goes_to_the_page(live: LiveEditor) -> None:
    live.pose = Pose([PINS[1]], [[4.0, 1.0]], angles=[0.5])
    assert live.edit["by"] == "kernel"
    assert live.edit["pins"] == [pin(PINS[1], [4.0, 1.0], angle=0.5)]
    assert len(live.edit["coefficients"]) == 4 * live.map.domain.n_coefficients
    before = live.pose
    with pytest.raises(PoseError, match="outside"):
        live.pose = Pose([[90.0, 0.0]], [[0.0, 0.0]])
    assert live.pose is before


def test_an_energy_that_the_page_lacks_is_refused() -> None:
    energy = glid.energies.CustomEnergy(lambda x, y: (x + y) * (1 + (x - y) ** -2))
    with pytest.raises(InputError, match="custom"):
        LiveEditor(shapes.picture(), shapes.domain(), energy=energy)


@pytest.mark.slow
def test_an_editor_solves_the_poses_of_its_live_editor() -> None:
    with_shape = Editor(glid.samples.image("bar"), n_vertices=100)
    with_shape.add_handle((-6, 0))
    live = with_shape.live
    assert with_shape._display_() is with_shape.live is live  # marimo's protocol
    assert len(live.pose) == 1
    from_page(live, [pin([-6.0, 0.0], [-6.0, 1.0])], HarmonicMap.identity(live.map.domain))
    np.testing.assert_array_equal(with_shape.pose.targets, [[-6, 1]])
    assert with_shape.solve(60)
    np.testing.assert_allclose(with_shape.map([[-6, 0]]), [[-6, 1]], atol=1e-3)
    with_shape.trace(offset=5.0)
    assert with_shape.live is not live
    assert live.comm is None  # closed
    with_shape.close()
    empty = Editor()
    assert "glid_nb.Editor(image)" in empty._display_()
    empty.close()
