"""Motions as files: JSON with the settings and every map at which the motion bends."""

from __future__ import annotations

import itertools
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from glid_nb import _json
from glid_nb._errors import about
from glid_nb.certificate import certificate_of
from glid_nb.certificate.proof import exact_text
from glid_nb.harmonic import HarmonicMap
from glid_nb.harmonic import map as maps
from glid_nb.motion.settings import MotionError

if TYPE_CHECKING:
    from glid_nb.motion.motion import Motion

FORMAT = "glid_nb-motion"
PROOF_FORMAT = "glid_nb-motion-proof"
FORMAT_VERSION = 1

_MOST_KNOTS = 10_000
_DOMAIN_KEYS = ("cage", "holes", "offset_cage", "offset_holes", "hole_points")
_SETTINGS = ("times", "easing", "repeat", "between", "tolerance", "turns")
_REQUIRED = {
    **dict.fromkeys(("format", "version", *_DOMAIN_KEYS, *_SETTINGS), _json.anything),
    "times": _json.check_list,
    "knots": _json.check_list,
}
_OPTIONAL = {"handles": _json.check_points, "notes": _json.anything}
_KNOT = {"time": _json.anything, "phi": _json.anything, "psi": _json.anything}


def texts(motion: Motion, proof: bool = True) -> tuple[str, ...]:
    """The motion's file, and the proof that ``glid-check`` reads; MotionError if there is none."""
    pieces = motion.pieces_forth
    knots = [(pieces[0].start, pieces[0].start_map), *((p.end, p.end_map) for p in pieces)]
    handles = {} if motion.handles is None else {"handles": motion.handles.tolist()}
    shared = {
        "version": FORMAT_VERSION,
        **motion.domain.to_dict(),
        "knots": [
            {"time": time, **{key: map.to_dict()[key] for key in ("phi", "psi")}}
            for time, map in knots
        ],
    }
    settings = {key: getattr(motion, key) for key in _SETTINGS}
    text = _json.json_text({"format": FORMAT, **shared, **settings, **handles})
    if len(knots) > _MOST_KNOTS or text.count(",") > _json.MOST_VALUES:
        raise MotionError(f"no file holds {len(knots):,} maps like these; raise the tolerance")
    if not proof:
        return (text,)
    if not motion.certificate.certified:
        raise MotionError(f"there is no proof to write: {motion.certificate.reason}")
    proofs = motion.certificate.pieces[: len(pieces)]
    claims = {
        "format": PROOF_FORMAT,
        "pieces": [[p.sigma2_lower, p.sigma1_upper, p.k_upper] for p in proofs],
        "windings": list(certificate_of(motion.keyframes[0]).windings),
    }
    del shared["notes"]
    return text, exact_text({**shared, **claims})


def load(path: str | Path, cls: type[Motion]) -> Motion:
    """The motion of a file, proved anew; MotionError names the file and what is wrong there."""
    with about(path, MotionError):
        data = _json.read_json(path)
        if not isinstance(data, dict) or data.get("format") != FORMAT:
            raise MotionError(f'this is no glid_nb motion: the key "format" is not "{FORMAT}"')
        if data.get("version") != FORMAT_VERSION:
            given = f"motion version {data.get('version')!r:.20} is not supported"
            raise MotionError(f"{given}; expected {FORMAT_VERSION}")
        _json.check_fields(data, "the motion", _REQUIRED, _OPTIONAL)
        times, knots = _knots(data)
        closed = data["repeat"] == "loop"
        wanted = data["times"]
        ends = [times[0], times[-1]] == [*wanted[:1], *wanted[-1:]]
        if not ends or any(time not in times for time in wanted):
            raise MotionError('"times" must be times of knots, the first and the last included')
        at = [knots[times.index(t)] for t in wanted]
        ends = zip((at[0].phi, at[0].psi), (at[-1].phi, at[-1].psi), strict=True)
        if closed and not all(np.array_equal(*pair) for pair in ends):
            raise MotionError("the last knot of the loop is not its first keyframe")
        settings = {key: data[key] for key in (*_SETTINGS[1:], "handles") if key in data}
        motion = cls(at[: len(at) - closed], wanted, **settings)
        vars(motion)["_knots"] = (times, knots)
        motion.certificate  # noqa: B018 - proves every piece
        return motion


def _knots(data: dict[str, Any]) -> tuple[list[float], list[HarmonicMap]]:
    given = data["knots"]
    if not 2 <= len(given) <= _MOST_KNOTS:
        raise MotionError(f'"knots" must hold 2 to {_MOST_KNOTS:,} maps, not {len(given)}')
    times, found = [], []
    for i, knot in enumerate(given):
        with about(f"knots[{i}]", MotionError):
            _json.check_fields(knot, "a knot", _KNOT)
            if type(knot["time"]) not in (int, float) or not np.isfinite(knot["time"]):
                raise MotionError(f"time is {knot['time']!r:.40}; it must be a finite number")
            if i == 0:
                domain = {key: data.get(key) for key in (*_DOMAIN_KEYS, "notes")}
                head = {"format": maps.FORMAT, "version": maps.FORMAT_VERSION}
                found.append(HarmonicMap.from_dict({**knot, **domain, **head}))
            else:
                both = (maps.complex_from_pairs(knot[key], f'"{key}"') for key in ("phi", "psi"))
                found.append(HarmonicMap(found[0].domain, *both))
        times.append(float(knot["time"]))
    for i, (before, after) in enumerate(itertools.pairwise(times)):
        if not before < after:
            raise MotionError(f"knots[{i + 1}] is not later than knots[{i}]")
    return times, found
