"""The tables of the study, made of its parts' results on both devices."""

from typing import Any

from studies.store import Measurement
from studies.tables import Row, digits

AGREEMENT = 1e-8
"""Relative difference of two energies up to which they count as the same."""

Found = dict[str, Measurement]
"""By part and device: ``solves-device``, ``solves-cpu``; and ``machine``."""


def tables(found: Found) -> dict[str, list[Row]]:
    """Every table that has rows."""
    made = {
        "machine": _machine(found),
        "agreement": _agreement(found),
        "solves": _solves(found),
        "stages": _stages(found),
        "batches": _batches(found),
        "lockstep": _lockstep(found),
        "tests": _tests(found),
    }
    return {name: rows for name, rows in made.items() if rows}


def _rows(found: Found, name: str, key: str) -> list[dict[str, Any]]:
    return [row for row in found.get(name, {}).get("rows", ()) if key in row]


def _machine(found: Found) -> list[Row]:
    """The machine; for each part, its duration and how it ended."""
    rows: list[Row] = []
    if "machine" in found:
        here = found["machine"]["taken"]
        versions = ", ".join(f"{name} {number}" for name, number in here["versions"].items())
        rows += [
            {"": "devices", "what": ", ".join(here["devices"])},
            {"": "processor", "what": f"{here['processor']}, {here['cores']} cores"},
            {"": "versions", "what": f"Python {here['python']}, {versions}"},
        ]
    for name, part in found.items():
        if name != "machine":
            ended = part["ended"] or "complete"
            rows.append({"": name, "what": f"{part['seconds']:.0f} s, {ended}"})
    return rows


def _agreement(found: Found) -> list[Row]:
    """The results of both devices; a cell is empty if a device did not reach the shape."""
    rows: list[Row] = []
    for here, there in _both(found, "found"):
        off: float | None = None
        if there is not None:
            off = abs(here["energy"] - there["energy"]) / abs(there["energy"])
        row: Row = {"shape": here["found"], "unknowns": here["unknowns"]}
        row["energy"] = f"{here['energy']:.10g}"
        row["difference, relative"] = None if off is None else f"{off:.1e}"
        row["same"] = None if off is None else "yes" if off <= AGREEMENT else "no"
        for name in ("iterations", "status", "certified"):
            row[f"{name}, device / CPU"] = f"{here[name]} / {there[name] if there else ''}"
        row["k at most, device / CPU"] = _pair((here, there), lambda one: float(one["k"]))
        rows.append(row)
    return rows


def _solves(found: Found) -> list[Row]:
    """Milliseconds of a solve, an iteration and a drag step."""
    return [
        {
            "shape": both[0]["timed"],
            "solve, ms, device / CPU": _pair(both, lambda one: 1e3 * one["solve"]["median"]),
            "iteration, ms, device / CPU": _pair(both, _iteration),
            "drag step, ms, device / CPU": _pair(both, lambda one: 1e3 * one["drag"]["median"]),
            "call, ms, device / CPU": _pair(both, lambda one: 1e3 * one["call"]["median"]),
        }
        for both in _both(found, "timed")
    ]


def _both(found: Found, key: str) -> list[tuple[dict[str, Any], dict[str, Any] | None]]:
    """The lines of each shape from the device and, if it exists, from the CPU."""
    others = {row[key]: row for row in _rows(found, "solves-cpu", key)}
    return [(row, others.get(row[key])) for row in _rows(found, "solves-device", key)]


def _iteration(one: dict[str, Any]) -> float:
    return 1e3 * one["solve"]["median"] / max(one["iterations"], 1)


def _pair(both: Any, number: Any) -> str:
    return " / ".join(digits(number(one)) if one else "" for one in both)


def _stages(found: Found) -> list[Row]:
    """The time of an iteration's stages, and the least time of any program."""
    rows: list[Row] = []
    for device in ("device", "cpu"):
        name = f"solves-{device}"
        timed = {row["timed"]: row for row in _rows(found, name, "timed")}
        counts = {row["counted"]: row["operations"] for row in _rows(found, name, "counted")}
        for one in _rows(found, name, "staged"):
            (first, *_) = _rows(found, name, "dispatch")
            row: Row = {"shape": one["staged"], "on": device}
            row["iteration, ms"] = _iteration(timed[one["staged"]])
            row |= {f"{stage}, ms": digits(1e3 * t, 2) for stage, t in one["stages"].items()}
            row["smallest program, ms"] = digits(1e3 * first["dispatch"]["median"], 2)
            row["operations"] = counts.get(one["staged"])
            rows.append(row)
    return rows


def _batches(found: Found) -> list[Row]:
    """Poses per second by the size of the batch."""
    rates = {
        device: {
            "one by one" if row["kind"] == "one by one" else str(row["poses"]): row
            for row in _rows(found, f"batches-{device}", "poses")
            if row["kind"] != "lockstep"
        }
        for device in ("device", "cpu")
    }
    rows: list[Row] = []
    for size in {**rates["device"], **rates["cpu"]}:
        here, there = (rates[device].get(size) for device in ("device", "cpu"))
        row: Row = {"poses": size}
        for name, one in (("device", here), ("CPU", there)):
            row[f"poses a second, {name}"] = one and one["poses"] / one["seconds"]
        row["certified, device"] = here and here.get("certified")
        rows.append(row)
    return rows


def _lockstep(found: Found) -> list[Row]:
    """The first call of a batch, and the device's part of its time."""
    return [
        {
            "poses in a call": row["poses"],
            "iterations": row["iterations"],
            "with the host, ms": 1e3 * row["seconds"],
            "the call, ms": 1e3 * row["device"],
            "the call, ms a pose": 1e3 * row["device"] / row["poses"],
        }
        for row in _rows(found, "batches-device", "device")
    ]


def _tests(found: Found) -> list[Row]:
    return [
        {
            "folder": row["folder"],
            "passed": row["passed"],
            "failed": len(row["failing"]),
            "failing": " ".join(row["failing"]),
        }
        for row in _rows(found, "tests-device", "folder")
    ]
