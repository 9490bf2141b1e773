"""Values go to other processes and come back unchanged."""

from __future__ import annotations

import copy
import functools
import io
import multiprocessing
import pickle
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from typing import Any

import numpy as np
import pytest

from glid_nb import methods
from glid_nb.certificate import certificate_of, certify
from glid_nb.geometry import Cage, Domain, MeshMap
from glid_nb.harmonic import HarmonicMap
from glid_nb.minima import refine, solve, solve_batch
from glid_nb.motion import Motion
from glid_nb.pose import Pose
from glid_nb.solvers import Options, Result, Status

pytestmark = pytest.mark.slow

POSE = Pose([[-8.0, 0], [0, 0], [8, 0]], [[-8.0, 0], [0, 3], [8, 0]])
OTHER = POSE.with_targets(POSE.targets + np.array([0, 0.5]))


class WithoutJax(pickle.Unpickler):
    """Refuses arrays of JAX, whose precision depends on the reading process."""

    def find_class(self, module: str, name: str) -> Any:
        assert not module.startswith("jax"), f"{module}.{name}"
        return super().find_class(module, name)


def unpickled(value: Any) -> Any:
    return WithoutJax(io.BytesIO(pickle.dumps(value))).load()


@functools.cache
def bar() -> Domain:
    return Domain.from_cage(Cage([[-10, -3], [10, -3], [10, 3], [-10, 3]]))


@functools.cache
def made(kind: str) -> Any:
    """One result for each way to make one."""
    if kind == "newton":
        return solve(bar(), POSE)
    if kind == "batch":
        return solve_batch(bar(), [POSE, OTHER])[1]
    if kind == "refined":
        return refine(made("newton"))
    if kind == "stiff":
        stiffness = [{"points": [[-5, 0]], "radius": 2, "strength": 0.5}]
        pose = Pose(POSE.handles, POSE.targets, angles=[0.1, None, None], stiffness=stiffness)
        return solve(bar(), pose)
    mesh = methods.METHODS[kind].family != "harmonic"
    method = methods.by_name(kind, **({"n_vertices": 100} if mesh else {}))
    energy = "arap" if kind == "bdhm" else None
    return solve(bar(), POSE, energy, Options(max_iterations=3), method=method)


KINDS = ["newton", "batch", "refined", "stiff", "lbfgs", "newton-eigen", "bdhm", "mls", "aqp"]


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("copied", [unpickled, copy.deepcopy, copy.copy])
def test_a_result_is_the_same_bit_for_bit(kind: str, copied: Callable[[Any], Any]) -> None:
    result: Result = made(kind)
    other: Result = copied(result)
    if isinstance(result.map, MeshMap):
        assert other.map.images.tobytes() == result.map.images.tobytes()  # type: ignore[union-attr]
        assert other.certificate is None
    else:
        assert isinstance(other.map, HarmonicMap)
        assert other.map.phi.tobytes() == result.map.phi.tobytes()
        assert other.map.psi.tobytes() == result.map.psi.tobytes()
        assert other.step_certificate is not None
        assert other.step_certificate.certified
        assert other.step_certificate.belongs_to(other.map)
        assert certificate_of(other.map).certified
        assert other.certificate is not None
        assert other.certificate.certified
    assert other.history == result.history
    assert other.misses.tobytes() == result.misses.tobytes()
    assert (other.energy, other.status) == (result.energy, result.status)
    assert other.pose.to_dict() == result.pose.to_dict()
    with pytest.raises(ValueError, match="WRITEABLE"):
        other.pose.handles.setflags(write=True)
    if result.discretisation is not None:
        assert other.discretisation is not None
        ours, theirs = (r.discretisation.matrices for r in (result, other))
        for name in ("nodes", "whitening", "whitened", "weights"):
            one, two = (np.asarray(getattr(m, name)) for m in (ours, theirs))
            assert one.dtype == two.dtype
            assert one.tobytes() == two.tobytes()


@pytest.mark.parametrize("kind", ["newton", "stiff", "lbfgs", "batch"])
@pytest.mark.parametrize("same", [True, False])
def test_a_solve_goes_on_from_an_unpickled_result_as_from_the_result(kind: str, same: bool) -> None:
    result: Result = made(kind)
    other = unpickled(result)
    domain = bar() if same else other.map.domain
    pose = result.pose.with_targets(OTHER.targets)
    options = Options(max_iterations=5)
    ours, theirs = (
        solve(where, pose, None, options, start, method=start.method)
        for where, start in ((bar(), result), (domain, other))
    )
    assert isinstance(ours.map, HarmonicMap)
    assert isinstance(theirs.map, HarmonicMap)
    assert theirs.map.phi.tobytes() == ours.map.phi.tobytes()
    assert theirs.map.domain is domain
    assert theirs.iterations == ours.iterations


def test_maps_domains_certificates_and_motions() -> None:
    map_ = made("newton").map
    for value in (map_, bar(), certify(map_), POSE, Options()):
        again = unpickled(value)
        assert type(again) is type(value)
        assert pickle.dumps(unpickled(again)) == pickle.dumps(again)
    motion = Motion([HarmonicMap.identity(bar()), map_], between="bounded")
    for proved in (False, True):
        assert not proved or motion.certificate.certified
        again = unpickled(motion)
        assert again(0.3).phi.tobytes() == motion(0.3).phi.tobytes()
        assert again.certificate.certified
        assert again.settings == motion.settings


def test_results_of_a_pool_of_processes_are_those_of_this_one() -> None:
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(1, mp_context=context) as pool:
        jobs = [pool.submit(solve, bar(), pose) for pose in (POSE, OTHER)]
        first, second = (job.result() for job in jobs)
        again = pool.submit(solve, bar(), OTHER, start=first).result()
    here = solve(bar(), OTHER)
    assert second.map.phi.tobytes() == here.map.phi.tobytes()
    assert again.status is Status.CONVERGED
    assert again.step_certificate.certified
    assert solve(bar(), POSE, start=again).step_certificate is not None
    # Every result comes with a domain of its own; all are equal.
    assert Motion([first, second], between="linear").certificate.certified
