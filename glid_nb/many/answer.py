"""A result as a few kilobytes: for the way back from a worker, and for a file.

The bytes hold the coefficients, the course of the solve and the panels of the proof, but no claim
that the map is certified. Whoever reads them proves the map again, on the reader's own domain.
"""

import hashlib
import itertools
import json
import math
import traceback
import zlib
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from glid_nb._arrays import Array
from glid_nb._errors import InputError
from glid_nb.certificate import Certificate, certify
from glid_nb.geometry import Domain, Panels, graded_panels, uniform_panels
from glid_nb.harmonic import HarmonicMap
from glid_nb.many.plan import Plan, our_version
from glid_nb.pose import Pose
from glid_nb.solvers.discretisation import UNIFORM_SAMPLES
from glid_nb.solvers.misses import misses_of
from glid_nb.solvers.options import Options
from glid_nb.solvers.positional import weights_of_images
from glid_nb.solvers.result import Attempt, Iteration, Result, Status

_MAGIC = b"glid_nb-solved 1\n"
_CHECKSUM = hashlib.sha256().digest_size
_MOST_BYTES = 1 << 28  # of an answer's content; a larger one is damaged

# The fields of an iteration, in the order of the columns of its table, with their types.
_COLUMNS: dict[str, Callable[[float], Any]] = {
    "energy_distortion": float,
    "energy_p2p": float,
    "iteration": int,
    "time": float,
    "step": float,
    "decrement": float,
    "sigma2_lower": float,
    "hessian_modified": bool,
    "corrections": int,
    "panels": int,
    "panels_split": int,
    "flips": int,
}
_NEVER_NONE = ("energy_distortion", "energy_p2p", "iteration", "time")

# How far the handles may be from where the claimed energy puts them: relative, and in units.
_RELATIVE, _UNITS = 1e-6, 1e-7


class ProblemError(InputError):
    """One of many problems could not be solved, or what came back was refused.

    ``kind`` is the name of the error's class on the worker, such as "PoseError"; "" for an error
    that was found here.
    """

    def __init__(self, message: str, kind: str = "") -> None:
        super().__init__(message)
        self.kind = kind

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (str(self), self.kind)


class DamagedError(InputError):
    """Bytes are no answer, or not all of one."""


class Answer(NamedTuple):
    """What an answer says; nothing of it is proved."""

    header: dict[str, Any]
    history: Array  # (1 + iterations, columns); the first row is the start
    phi: Array
    psi: Array
    depths: Array  # of the panels on which the solver proved it; empty if it had none


def of_result(result: Result, key: str) -> bytes:
    """The answer with a result whose map is harmonic. ``key`` is the problem's."""
    assert isinstance(result.map, HarmonicMap)
    depths = np.zeros(0, dtype=np.uint8)
    if result.discretisation is not None:  # `Panels.split` allows a depth of 40
        depths = result.discretisation.panels.depth.astype(np.uint8)
    rows = [[_number(getattr(one, name)) for name in _COLUMNS] for one in _steps(result)]
    header = {
        "problem": key,
        "glid_nb": our_version(),
        "status": result.status.value,
        "detail": result.detail,
        "energies": [result.energy_distortion, result.energy_p2p],
        "compile_time": result.compile_time,
        "solve_time": result.solve_time,
        "attempts": [
            [a.name, a.status.value, a.energy, a.iterations, a.given_up] for a in result.attempts
        ],
        "counts": [len(rows), len(result.map.phi), len(depths)],
    }
    table = np.array(rows, dtype="<f8")
    coefficients = [values.astype("<c16").tobytes() for values in (result.map.phi, result.map.psi)]
    return _packed(header, table.tobytes(), *coefficients, depths.tobytes())


def of_error(error: Exception, key: str) -> bytes:
    """The answer with an error. One that is no InputError is a bug, so its traceback travels."""
    text = " ".join(str(error).split())
    lines = "" if isinstance(error, InputError) else "".join(traceback.format_exception(error))
    told = {"error": type(error).__name__, "text": text, "traceback": lines}
    return _packed({"problem": key, "glid_nb": our_version(), **told})


def _steps(result: Result) -> list[Iteration]:
    return [result.initial, *result.history]


def _number(value: Any) -> float:
    return math.nan if value is None else float(value)


def _packed(header: dict[str, Any], *parts: bytes) -> bytes:
    text = json.dumps(header).encode()
    content = zlib.compress(b"".join([len(text).to_bytes(4, "little"), text, *parts]))
    return _MAGIC + hashlib.sha256(content).digest() + content


def read(data: Any) -> Answer:
    """The answer in bytes. Raises a DamagedError for other bytes, also for a part of an answer."""
    head = len(_MAGIC) + _CHECKSUM
    if not isinstance(data, bytes) or data[: len(_MAGIC)] != _MAGIC:
        raise DamagedError("it is no answer of a worker")
    if hashlib.sha256(data[head:]).digest() != data[len(_MAGIC) : head]:
        raise DamagedError("it is cut short or damaged")
    try:
        content = zlib.decompressobj().decompress(data[head:], _MOST_BYTES)
        start = 4 + int.from_bytes(content[:4], "little")
        header, rest = json.loads(content[4:start]), content[start:]
        if "error" in header:
            nothing = np.zeros(0)
            return Answer(header, nothing, nothing, nothing, nothing)
        n_rows, n, n_panels = header["counts"]
        sizes = np.cumsum([0, 8 * n_rows * len(_COLUMNS), 16 * n, 16 * n, n_panels])
        table, phi, psi, depths = (rest[i:j] for i, j in itertools.pairwise(sizes))
        return Answer(
            header,
            np.frombuffer(table, "<f8").reshape(n_rows, len(_COLUMNS)).astype(float),
            np.frombuffer(phi, "<c16").astype(complex),
            np.frombuffer(psi, "<c16").astype(complex),
            np.frombuffer(depths, np.uint8),
        )
    except (ValueError, KeyError, TypeError, AttributeError, zlib.error) as error:
        raise DamagedError(f"it is not as this version writes answers ({error})") from None


def received(data: Any, plan: Plan, pose: Pose, check: bool) -> Result:
    """The result in an answer to a problem, with its map on the plan's domain.

    With ``check`` the map is certified here. Raises a ProblemError for a worker's error; for an
    answer of another problem or another version; for coefficients that make no map; for handles
    that are not where the claimed energy puts them; and, with ``check``, for a map that is not
    certified here. Raises a DamagedError for bytes that are no answer.
    """
    answer = read(data)
    header = answer.header
    if header.get("problem") != plan.problem_key(pose):
        theirs = str(header.get("glid_nb"))
        if theirs != our_version():
            versions = f"the worker has glid_nb {theirs:.40}, and here is {our_version()}"
            raise ProblemError(f"{versions}; install the same version on both")
        raise ProblemError("what came back is the result of another problem")
    if "error" in header:
        error = ProblemError(f"{header['error']}: {header['text']}", str(header["error"]))
        if header.get("traceback"):
            error.add_note(f"On the worker:\n{header['traceback']}")
        raise error
    try:
        map = HarmonicMap(plan.domain, answer.phi, answer.psi)
        result = _result(answer, map, plan, pose)
    except (InputError, ValueError, KeyError, TypeError) as error:
        raise ProblemError(f"what came back is no result of this problem: {error}") from None
    _check_handles(result)
    if not check:
        return result
    proof = certificate_from(answer.depths, map, plan.options)
    if not proof.certified:
        raise ProblemError(f"the map that came back is not certified here: {proof.reason}")
    vars(result)["step_certificate"] = proof
    return result


def _result(answer: Answer, made: HarmonicMap, plan: Plan, pose: Pose) -> Result:
    header = answer.header
    first, *others = [_iteration(row) for row in answer.history]
    distortion, p2p = map(float, header["energies"])
    attempts = (
        Attempt(str(name), Status(status), float(energy), int(iterations), bool(given_up))
        for name, status, energy, iterations, given_up in header["attempts"]
    )
    detail = header["detail"]
    return Result(
        map=made,
        status=Status(header["status"]),
        pose=pose,
        options=plan.options,
        energy_measure=plan.energy,
        method=plan.method,
        initial=first,
        history=tuple(others),
        energy_distortion=distortion,
        energy_p2p=p2p,
        compile_time=float(header["compile_time"]),
        solve_time=float(header["solve_time"]),
        detail=None if detail is None else str(detail),
        attempts=tuple(attempts),
    )


def _iteration(row: Array) -> Iteration:
    values: dict[str, Any] = {
        name: None if math.isnan(value) and name not in _NEVER_NONE else kind(value)
        for (name, kind), value in zip(_COLUMNS.items(), row.tolist(), strict=True)
    }
    return Iteration(**values)


def _check_handles(result: Result) -> None:
    """Raise a ProblemError unless the handles miss their targets as the claimed energy says.

    A result of another pose has other misses. Angles and scales only add to the energy.
    """
    pose, domain = result.pose, result.map.domain  # type: ignore[union-attr]
    if not len(pose):
        return
    weights, _ = weights_of_images(domain, pose, result.options.p2p_weight)
    found = math.sqrt(float(np.average(misses_of(result.map, pose) ** 2, weights=weights)))
    claimed = math.sqrt(max(2 * result.energy_p2p, 0.0) / float(weights.sum()))
    room = _RELATIVE * max(found, claimed) + _UNITS * domain.cage.unit
    least = 0.0 if pose.oriented.any() else claimed - room
    if not least <= found <= claimed + room:
        what = f"the map that came back misses the targets by {found:.3g} on average"
        raise ProblemError(f"{what}, but its energy says {claimed:.3g}: it is of another problem")


def certificate_from(depths: Array, map: HarmonicMap, options: Options) -> Certificate:
    """Prove a map, beginning with the panels on which the solver proved it.

    On them `certify` proves all that the solver proves (docs/proof.md, Lemma 15). Wrong panels
    cannot prove a map that folds: all of them tile the boundary.
    """
    panels = panels_of(map.domain, options, depths) if len(depths) else None
    split = options.sampling == "graded"
    return certify(map, options.certificate, panels, split=split or panels is None)


def panels_of(domain: Domain, options: Options, depths: Array) -> Panels | None:
    """The panels with these depths, bisected from those with which every solve begins.

    None if there are no such panels: another processor may grade a panel differently.
    """
    if options.sampling == "graded":
        panels = graded_panels(domain)
    else:
        panels = uniform_panels(domain.cage, UNIFORM_SAMPLES)
    left, divided = depths.astype(int), list[Array]()
    for level in range(int(left.max(initial=0)), 0, -1):  # put halves together, deepest first
        deepest = np.flatnonzero(left == level)
        first, second = deepest[::2], deepest[1::2]
        if len(first) != len(second) or (second != first + 1).any():
            return None
        whole = np.zeros(len(left), dtype=bool)
        whole[first] = True
        left[first] = level - 1
        left, whole = np.delete(left, second), np.delete(whole, second)
        divided.append(whole)
    if len(left) != len(panels) or left.any():
        return None
    for chosen in reversed(divided):
        panels, _ = panels.split(chosen)
    return panels if np.array_equal(panels.depth, depths) else None
