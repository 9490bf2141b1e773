"""Every map that is returned as a result is proved and carries its proof."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from glid_nb import methods, solve_batch
from glid_nb._json import read_json
from glid_nb.certificate import certificate_of, certify
from glid_nb.cli.output import finish
from glid_nb.energies import SymmetricDirichlet, by_name
from glid_nb.geometry import Cage, Domain
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging import TraceOptions
from glid_nb.io import load_document, save_document
from glid_nb.minima import solve
from glid_nb.pose import Pose
from glid_nb.session.document import Document, DocumentError, NamedPose
from glid_nb.session.report import build_report
from glid_nb.solvers import Options, Progress, Result, Status
from glid_nb.solvers.method import StartError

from ..support.domains import domain

pytestmark = pytest.mark.slow  # most of the time is compiling

POSE = Pose([(2.2, 0.5), (-2.2, 0.5), (0.96, -2.2)], [(2.9, 1.5), (-2.2, 0.9), (0.9, -2.6)])


def check_carries(made: Result | Progress) -> None:
    """The result carries the proof of its own map, and computing anew certifies the map, too."""
    proof = made.step_certificate if isinstance(made, Result) else made.certificate
    assert proof is not None
    assert proof.certified
    assert proof.belongs_to(made.map)
    assert proof.winding == 0
    anew = certify(made.map)
    assert anew.certified
    assert proof.sigma2_lower <= anew.panels.sigma2_lower.min() * 1.03
    assert certificate_of(made.map).certified
    assert made.certificate.certified


@pytest.mark.parametrize("method", ["newton", "lbfgs", "newton-staged", "newton-paper"])
def test_every_map_of_a_solve_carries_its_proof(method: str) -> None:
    seen: list[Progress] = []
    options = Options(iterations_per_call=1, max_iterations=2, restarts=0)

    def keep(progress: Progress) -> None:
        check_carries(progress)
        seen.append(progress)

    ring = domain("ring")
    result = solve(ring, POSE, None, options, None, keep, method=methods.by_name(method))
    check_carries(result)
    assert len({len(progress.history) for progress in seen}) >= 2


def test_the_proof_of_a_step_is_what_the_compiled_call_has_proved() -> None:
    """Bounds, panels and windings, unpickled and not made again."""
    result = solve(domain("ring"), POSE, options=Options(restarts=0))
    assert result.step_certificate.reason.startswith("Proved locally injective by the solver on")
    assert len(result.step_certificate.panels) <= (result.n_panels or 0)
    assert result.step_certificate.sigma2_lower == result.history[-1].sigma2_lower
    assert result.step_certificate.windings == (0, 0)


def test_a_batch_carries_proofs() -> None:
    for result in solve_batch(domain("ring"), [POSE, POSE.with_targets(POSE.handles)]):
        check_carries(result)


def test_no_step_at_all_is_proved_too() -> None:
    ring = domain("ring")
    for limit, start in ((0, None), (0, HarmonicMap.identity(ring))):
        result = solve(ring, POSE, options=Options(max_iterations=limit), start=start)
        assert result.iterations == 0
        check_carries(result)


def test_a_result_whose_map_was_replaced_is_proved_again() -> None:
    ring = domain("ring")
    result = solve(ring, POSE, options=Options(restarts=0))
    folded = HarmonicMap(ring, result.map.psi.conj(), result.map.phi.conj())
    wrong = replace(result, map=folded)
    for limit in (0, None):
        with pytest.raises(StartError, match="not certified"):
            solve(ring, POSE, start=wrong, options=Options(max_iterations=limit))
    assert not wrong.certificate.certified
    forged = replace(wrong, step_certificate=replace(result.step_certificate, map=folded))
    with pytest.raises(StartError, match="not certified"):
        solve(ring, POSE, start=forged, options=Options(max_iterations=0))
    assert not forged.certificate.certified
    other = HarmonicMap.identity(ring)
    again = solve(ring, POSE, start=replace(result, map=other), options=Options(max_iterations=0))
    check_carries(again)
    assert certify(again.map).sigma2_lower > 0.999


def _sliver() -> tuple[Domain, Pose]:
    """A notch of 10^-8 in a bar, with targets that move it by 10^6."""
    outline = [[-10, -1], [-9, -1], [-8.99999999, -1.000000003], [10, -1], [10, 1], [-10, 1]]
    pose = Pose([(-9, 0), (9, 0.3)], [(-9e5, 0), (-899982, 0.3)])
    return Domain.from_cage(Cage(outline)), pose


def test_a_bar_with_a_tiny_notch_far_away() -> None:
    bar, pose = _sliver()
    for limit in (0, None):
        result = solve(bar, pose, options=Options(max_iterations=limit))
        check_carries(result)
        assert np.isfinite(result.energy)
    assert result.status.ok
    assert result.energy == pytest.approx(2, abs=1e-6)


def test_what_a_solver_proves_can_be_kept_and_checked(tmp_path: Path) -> None:
    """Beside a slit of 10^-9, where f_z is hardly larger than its rounding errors."""
    right, left = [[10, -1], [10, 1], [1e-9, 1], [1e-9, -0.9]], [[0, -0.9], [0, 1], [-10, 1]]
    slit = Domain.from_cage(Cage([[-10, -1], *right, *left]))
    handles = [(4.835, 0.444), (-5.626, 0.66), (3.153, 0.366)]
    pose = Pose(handles, [(3.946, -1.708), (-5.574, 0.554), (5.964, 1.86)])
    result = solve(slit, pose, options=Options(restarts=0))
    check_carries(result)
    assert np.isfinite([result.certificate.sigma1_upper, certify(result.map).sigma1_upper]).all()
    assert result.certificate.k_upper < 1
    result.step_certificate.save(tmp_path / "proof.json")
    for bound in ("sigma1_upper", "k_upper"):
        assert np.isfinite(float.fromhex(read_json(tmp_path / "proof.json")[bound]))
    poses = (NamedPose("slit", pose, result.energy_measure, Options(), result.map),)
    image = np.zeros((20, 200, 4), np.uint8)
    document = Document(image, slit.cage, slit, TraceOptions(), None, poses, 0)
    save_document(document, tmp_path / "slit.glid")
    kept = load_document(tmp_path / "slit.glid").poses[0].map
    again = solve(kept.domain, pose, start=kept, options=Options(max_iterations=1, align=False))
    check_carries(again)


def test_a_document_is_saved_by_what_it_is_loaded_by(tmp_path: Path) -> None:
    """No file holds the solver's panels, so a proof that needs them is not saved."""
    ring = domain("ring")
    result = solve(ring, POSE, options=Options(restarts=0))
    result.map.kept["proofs"].own = replace(result.certificate)
    assert certificate_of(result.map).certified
    poses = (NamedPose("ring", POSE, result.energy_measure, Options(), result.map),)
    image = np.zeros((20, 20, 4), np.uint8)
    document = Document(image, ring.cage, ring, TraceOptions(), None, poses, 0)
    with pytest.raises(DocumentError, match="not certified"):
        save_document(document, tmp_path / "never.glid")
    assert not (tmp_path / "never.glid").exists()


@pytest.mark.parametrize("gap", [1e-6, 1e-12])
def test_a_nearly_folded_start_never_converges_at_infinity(gap: float) -> None:
    """After the alignment far away, rounding may have folded the map. Then the given map is
    returned."""
    bar, pose = _sliver()
    identity = HarmonicMap.identity(bar).phi
    start = HarmonicMap(bar, identity / 2, identity / 2 * (1 - gap))
    assert certify(start).certified
    for energy in (SymmetricDirichlet(), by_name("exp", 1.0)):
        options = Options(restarts=0, max_iterations=5)
        result = solve(bar, pose, energy, options, start)
        assert result.step_certificate.certified
        assert result.certificate.certified
        assert result.step_certificate.belongs_to(result.map)
        assert np.isfinite(result.energy) or not result.status.ok
        if result.status is Status.UNPROVED:
            np.testing.assert_array_equal(result.map.phi, start.phi)
            assert "is returned" in result.message


def test_the_shell_does_not_succeed_where_nothing_was_proved(
    capsys: pytest.CaptureFixture[str],
) -> None:
    result = solve(domain("ring"), POSE, options=Options(restarts=0))
    report = build_report(result)
    finish(result, report, {}, as_json=True)
    unproved = replace(result, status=Status.UNPROVED)
    with pytest.raises(ValueError, match="could be proved"):
        finish(unproved, report, {}, as_json=True)
    with pytest.raises(ValueError, match="The solver converged"):
        finish(result, {**report, "certified": False, "proof": "Undecided"}, {}, as_json=True)
    assert '"certified": true' in capsys.readouterr().out
