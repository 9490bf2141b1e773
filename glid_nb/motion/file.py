"""Motions as files: JSON with the settings and every map at which the motion bends."""

import itertools
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from glid_nb import _json
from glid_nb._errors import about
from glid_nb.certificate import certificate_of
from glid_nb.certificate.pieces import PieceCertificate
from glid_nb.certificate.proof import exact_text
from glid_nb.geometry import as_points
from glid_nb.harmonic import HarmonicMap
from glid_nb.harmonic import map as maps
from glid_nb.motion.curve import Piece
from glid_nb.motion.errors import MotionError
from glid_nb.motion.settings import LATEST, checked

Maps = list[HarmonicMap]

_VERSION, MOST_KNOTS = 2, 10_000
_EASINGS_BEFORE = {"linear", "in", "out", "in-out"}  # that version 1 knows
SETTINGS = ("easing", "repeat", "between", "tolerance", "turns")
OF_INTERVALS = ("easing", "turns")  # one value for each interval
_REQUIRED = {
    **_json.keys("format", "version", *maps.DOMAIN_KEYS, *SETTINGS),
    "times": _json.check_list,
    "knots": _json.check_list,
}
_OPTIONAL = {"handles": _json.check_points, **_json.keys("notes", "image_size_px")}


def texts(
    pieces: Sequence[Piece], settings: Mapping[str, Any], proofs: Sequence[PieceCertificate]
) -> tuple[str, ...]:
    """The file of a motion and, if its pieces' proofs are given, the file for ``glid-check``."""
    first = pieces[0].start_map
    knots = [(pieces[0].start, first), *((p.end, p.end_map) for p in pieces)]
    shared = {
        "version": 1,  # of the proof, and of the motion where programs of version 1 can read it
        **first.domain.to_dict(),
        "knots": [
            {"time": time, "phi": as_points(map.phi).tolist(), "psi": as_points(map.psi).tolist()}
            for time, map in knots
        ],
    }
    told = {key: value for key, value in settings.items() if key != "image_size"}
    if (size := settings.get("image_size")) is not None:
        told["image_size_px"] = list(size)
    if not _EASINGS_BEFORE.issuperset(settings["easing"]):
        told["version"] = _VERSION
    text = _json.json_text({"format": "glid_nb-motion", **shared, **told})
    if len(knots) > MOST_KNOTS or text.count(",") > _json.MOST_VALUES:
        raise MotionError(f"{len(knots):,} maps are too many for a file; raise the tolerance")
    if not proofs:
        return (text,)
    claims = {
        "format": "glid_nb-motion-proof",
        "pieces": [[p.sigma2_lower, p.sigma1_upper, p.k_upper] for p in proofs],
        "windings": list(certificate_of(first).windings),
    }
    del shared["notes"]
    return text, exact_text({**shared, **claims})


def read(path: str | Path) -> tuple[Maps, dict[str, Any], list[float], Maps]:
    """Keyframes and settings, then all times at which the motion bends, and its maps there."""
    data = _json.read_json(path)
    _json.checked_version(data, "motion", _VERSION)
    _json.check_fields(data, "the motion", _REQUIRED, _OPTIONAL)
    times, knots = _knots(data)
    wanted = data["times"]
    ends = [times[0], times[-1]] == [*wanted[:1], *wanted[-1:]]
    if not ends or any(time not in times for time in wanted):
        raise MotionError('"times" must be times of knots, the first and the last included')
    keyframes = [knots[times.index(time)] for time in wanted]
    if data["repeat"] == "loop":
        back, first = keyframes.pop(), keyframes[0]
        if not (np.array_equal(back.phi, first.phi) and np.array_equal(back.psi, first.psi)):
            raise MotionError("the last knot of the loop is not its first keyframe")
    settings = {key: data[key] for key in ("times", *SETTINGS, "handles") if key in data}
    if (size := data.get("image_size_px")) is not None:
        settings["image_size"] = _json.picture_size(size, "image_size_px")
    return keyframes, settings, times, knots


def _knots(data: dict[str, Any]) -> tuple[list[float], list[HarmonicMap]]:
    given = data["knots"]
    if not 2 <= len(given) <= MOST_KNOTS:
        raise MotionError(f'"knots" must hold 2 to {MOST_KNOTS:,} maps, not {len(given)}')
    times, found = [], []
    for i, knot in enumerate(given):
        with about(f"knots[{i}]", MotionError):
            _json.check_fields(knot, "a knot", _json.keys("time", "phi", "psi"))
            times.append(checked("time", float, knot["time"], least=-LATEST))
            if i == 0:
                domain = {key: data.get(key) for key in (*maps.DOMAIN_KEYS, "notes")}
                head = {"format": maps.FORMAT, "version": maps.FORMAT_VERSION}
                found.append(HarmonicMap.from_dict({**knot, **domain, **head}))
            else:
                both = (maps.complex_from_pairs(knot[key], f'"{key}"') for key in ("phi", "psi"))
                found.append(HarmonicMap(found[0].domain, *both))
    for i, (before, after) in enumerate(itertools.pairwise(times)):
        if not before < after:
            raise MotionError(f"knots[{i + 1}] is not later than knots[{i}]")
    return times, found
