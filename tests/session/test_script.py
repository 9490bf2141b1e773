"""Copy as Python: the lines are run, and their map is compared."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from glid_nb.energies import AMIPS, CustomEnergy, SymmetricDirichlet
from glid_nb.geometry import Domain, MeshMap
from glid_nb.harmonic import HarmonicMap
from glid_nb.methods import LBFGS, MovingLeastSquares
from glid_nb.minima import solve
from glid_nb.pose import Pose
from glid_nb.session.document import Document, DocumentError, NamedPose
from glid_nb.session.script import python_code
from glid_nb.session.timeline import Timeline
from glid_nb.session.tracing import TracingModel
from glid_nb.solvers import Options

from ..support.drawing import DRAWING, far_vertex

HANDLES = [[-6.0, 0.0], [1.5, 0.0], [-1.0, 4.5]]
TARGETS = [[-6.5, 1.0], [1.5, 0.0], [-1.0, 5.2]]


def run(code: str) -> dict[str, Any]:
    scope: dict[str, Any] = {}
    exec(compile(code, "<copied>", "exec"), scope)
    return scope


def document_of(model: TracingModel, **changes: Any) -> Document:
    assert model.domain is not None
    assert model.image is not None
    pose = changes.pop("pose", Pose(HANDLES, TARGETS))
    energy, options = changes.pop("energy", SymmetricDirichlet()), changes.pop("options", Options())
    domain = changes.pop("domain", model.domain)
    map = changes.pop("map", None) or solve(domain, pose, energy, options).map
    named = NamedPose("wave", pose, energy, options, map)
    return Document(
        model.image, domain.cage, domain, model.options, model.state.scribbles, (named,), 0
    )


@pytest.fixture(scope="module")
def model() -> TracingModel:
    return TracingModel(DRAWING)


@pytest.fixture(scope="module")
def solved(model: TracingModel) -> Document:
    return document_of(model)


@pytest.fixture
def picture(tmp_path: Path) -> str:
    path = tmp_path / "it's a picture.png"
    Image.fromarray(DRAWING).save(path)
    return str(path)


@pytest.mark.slow
def test_the_lines_make_the_same_map(solved: Document, picture: str) -> None:
    code = python_code(solved, picture)
    assert len(code.splitlines()) <= 12
    assert "glid.trace(image)" in code
    scope = run(code)
    pose = solved.active_pose
    assert pose is not None
    assert scope["map"].distance(pose.map) < 1e-6
    assert scope["result"].certificate.certified


@pytest.mark.slow
def test_another_method_is_written_with_its_settings(solved: Document, picture: str) -> None:
    pose = solved.active_pose
    assert pose is not None
    options = replace(pose.options, p2p_weight=2e4, corrections=1)
    by_lbfgs = replace(pose, method=LBFGS(memory=7), options=options)
    code = python_code(replace(solved, poses=(by_lbfgs,)), picture)
    assert "glid.solve(domain, pose, glid.energies.SymmetricDirichlet(), glid.Options(p2p_w" in code
    # Options that do not count for the method are left out.
    assert "glid.Options(p2p_weight=20000.0), method=glid.methods.LBFGS(memory=7))" in code
    on_mesh = replace(pose, method=MovingLeastSquares())
    scope = run(python_code(replace(solved, poses=(on_mesh,)), picture))
    assert isinstance(scope["map"], MeshMap)
    np.testing.assert_allclose(scope["map"](HANDLES), TARGETS, atol=1e-6)


@pytest.mark.slow
def test_options_energy_and_edits_are_written() -> None:
    edited = TracingModel(DRAWING)
    edited.move_vertex(0, far_vertex(edited), (5.0, 61.0))
    document = document_of(
        edited, energy=AMIPS(0.3), options=Options(p2p_weight=2e4, iterations_per_call=2)
    )
    code = python_code(document, "nowhere.png")
    assert "read_image" not in code  # the cage is not what tracing gives
    assert (
        "glid.energies.AMIPS(s=0.3), glid.Options(p2p_weight=20000.0, iterations_per_call=2)"
        in code
    )
    scope = run(code)
    np.testing.assert_array_equal(scope["cage"].exterior, document.cage.exterior)
    pose = document.active_pose
    assert pose is not None
    assert scope["map"].distance(pose.map) < 1e-6


def test_a_cut_cage_is_written_out() -> None:
    cut = TracingModel(DRAWING)
    cut.cut([(60, 5), (60, 100)])
    assert cut.domain is not None
    map = HarmonicMap.identity(cut.domain)
    code = python_code(document_of(cut, map=map), "nowhere.png", exact=True)
    assert "read_image" not in code
    np.testing.assert_array_equal(run(code)["cage"].exterior, cut.domain.cage.exterior)


def test_depths_and_angles_are_written(model: TracingModel, picture: str) -> None:
    assert model.domain is not None
    point = model.domain.cage.polygon.representative_point()
    pose = Pose([[point.x, point.y]], [[1.0, 2.0]], [-2.0], angles=[0.5], weights=[0.1])
    document = document_of(model, map=HarmonicMap.identity(model.domain), pose=pose)
    assert "    depths=[-2.0],\n" in python_code(document, picture)
    scope = run(python_code(document, picture, exact=True))
    assert scope["pose"].depths.tolist() == [-2.0]
    assert scope["pose"].same_constraints(pose)
    other = replace(document.poses[0], name="other", pose=Pose([[point.x, point.y]], [[1.0, 2.0]]))
    both = replace(document, poses=(document.poses[0], other))
    assert run(python_code(both, picture, exact=True))["pose"].depths.tolist() == [-2.0]


def test_stiff_areas_are_written(model: TracingModel, picture: str) -> None:
    assert model.domain is not None
    stroke = {"points": [[-6.0, 0.0], [-5.0, 1 / 3]], "radius": 1.5, "strength": 0.7}
    pose = Pose([[-6.0, 0.0]], [[-6.5, 1.0]], stiffness=[stroke])
    document = document_of(model, map=HarmonicMap.identity(model.domain), pose=pose)
    code = python_code(document, picture)
    assert f"    stiffness=[{stroke}],\n" in code
    lines = code[code.index("pose = ") : code.index("result = ")]
    assert run(f"import glid_nb as glid\n{lines}")["pose"].stiffness == pose.stiffness


def test_exact_lines_need_no_solve(model: TracingModel, picture: str) -> None:
    assert model.domain is not None
    document = document_of(model, map=HarmonicMap.identity(model.domain))
    scope = run(python_code(document, picture, exact=True))
    pose = document.active_pose
    assert pose is not None
    assert scope["map"].phi.tobytes() == pose.map.phi.tobytes()
    assert scope["map"].psi.tobytes() == pose.map.psi.tobytes()


def test_trace_options_are_written(picture: str) -> None:
    other = TracingModel(DRAWING)
    other.set_options(offset=2.5, max_edge=float("inf"))
    other.toggle_hole(1)
    assert other.domain is not None
    document = document_of(other, map=HarmonicMap.identity(other.domain))
    code = python_code(document, picture, exact=True)
    assert "offset=2.5" in code
    assert "max_edge=float('inf')" in code
    np.testing.assert_array_equal(run(code)["cage"].exterior, document.cage.exterior)


def test_an_offset_cage_of_ones_own_is_written(model: TracingModel, picture: str) -> None:
    assert model.cage is not None
    domain = Domain.from_cage(model.cage, 0.3)
    document = document_of(model, domain=domain, map=HarmonicMap.identity(domain))
    made = run(python_code(document, picture, exact=True))["domain"]
    np.testing.assert_array_equal(made.offset_cage.exterior, domain.offset_cage.exterior)
    np.testing.assert_array_equal(made.hole_points, domain.hole_points)


def test_what_cannot_be_written_is_refused(model: TracingModel) -> None:
    assert model.domain is not None
    document = document_of(model, map=HarmonicMap.identity(model.domain))
    with pytest.raises(DocumentError, match="no pose yet"):
        python_code(replace(document, poses=()))
    pose = document.active_pose
    assert pose is not None
    custom = CustomEnergy(lambda x, y: (x + y) * (1 + 1 / (x - y) ** 2))
    with pytest.raises(DocumentError, match=r"'wave'.*Python function"):
        python_code(replace(document, poses=(replace(pose, energy=custom),)))


@pytest.mark.slow
def test_all_poses_are_made(solved: Document, picture: str) -> None:
    wave = solved.poses[0]
    rest = replace(wave, name="at\nrest", map=HarmonicMap.identity(solved.domain))
    timeline = Timeline((0.5, 1.0, 3.0), ("in", (0.1, 0, 0.2, 1), "hold"), "loop", 0.25)
    document = replace(solved, poses=(wave, rest, wave), active=1, timeline=timeline)
    scope = run(python_code(document, picture, exact=True))
    gaps = [made.distance(p.map) for made, p in zip(scope["maps"], document.poses, strict=True)]
    assert max(gaps) < 1e-12
    assert scope["map"] is scope["maps"][1]
    motion = scope["motion"]
    assert (motion.times, motion.easing) == ((0.5, 1, 3, 3.25), timeline.easing)
    assert python_code(document, picture).count("glid.solve(domain, pose") == 3
