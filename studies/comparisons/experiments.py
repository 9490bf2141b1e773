"""What is measured on which shapes, in the order in which the page shows it."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from studies.comparisons import (
    bounded,
    conformal,
    exponential,
    folding,
    hessian_samples,
    iteration_times,
    lipschitz,
    paper,
    progress,
    stages,
)
from studies.comparisons.cases import Case, reference_cases, sample_case
from studies.comparisons.store import Measurement, Store

Detail = Callable[[str], None]

_FURTHER = ("colorbar",)
_SAMPLES = ("gecko", "teapot", "frog", "gingerbread")

NAMES = (
    "progress",
    "iteration-times",
    "bounded",
    "conformal",
    "exponential",
    "lipschitz",
    "hessian-samples",
    "stages",
    "folding",
)
"""The experiments by name."""


@dataclass(frozen=True)
class Shapes:
    """The shapes of each experiment: the paper's where they are given, else our own."""

    progress: tuple[str, ...]
    lipschitz: tuple[str, ...]
    hessian_samples: str
    conformal: str
    exponential: str
    bounded: str
    references: dict[str, Case]

    @classmethod
    def of(cls, folder: Path | None) -> Shapes:
        """The shapes, with those of a folder of reference problems."""
        found = {} if folder is None else reference_cases(folder)
        shapes = tuple(name for name in (*paper.TABLE_2, *_FURTHER) if name in found)
        shapes = shapes or tuple(f"{name}-extreme" for name in _SAMPLES)
        return cls(
            shapes,
            tuple(name for name in ("raptor", "giraffe") if name in found) or shapes[:2],
            "deer" if "deer" in found else shapes[0],
            "archery" if "archery" in found else "frog-extreme",
            "colorbar" if "colorbar" in found else "bar-extreme",
            "gecko-extreme",
            found,
        )

    def case(self, name: str) -> Case:
        """The case of a name; a sample is traced only when it is asked for."""
        if name in self.references:
            return self.references[name]
        sample, _, kind = name.rpartition("-")
        return sample_case(sample, "extreme" if kind == "extreme" else "gentle")


def measure_all(
    store: Store, shapes: Shapes, only: tuple[str, ...], detail: Detail
) -> dict[str, list[Measurement]]:
    """Every chosen experiment, as a list of measurements, one per shape, and those kept already."""
    table: dict[str, tuple[tuple[str, ...], Callable[[Case, Detail], Measurement]]] = {
        "progress": (shapes.progress, progress.measure),
        "iteration-times": (shapes.progress, iteration_times.measure),
        "bounded": ((shapes.bounded,), bounded.measure),
        "conformal": ((shapes.conformal,), conformal.measure),
        "exponential": ((shapes.exponential,), exponential.measure),
        "lipschitz": (shapes.lipschitz, lipschitz.measure),
        "hessian-samples": ((shapes.hessian_samples,), hessian_samples.measure),
        "stages": (shapes.progress, stages.measure),
        "folding": (shapes.progress, folding.measure),
    }
    case = functools.cache(shapes.case)  # tracing a sample takes a moment
    results: dict[str, list[Measurement]] = {}
    for name in NAMES:
        chosen, measure = table[name]
        cases = [case(shape) for shape in chosen]
        if name in only:
            results[name] = [
                store.get(f"{name}-{c.name}", lambda m=measure, c=c: m(c, detail), c.digest)
                for c in cases
            ]
        else:
            kept = [store.kept(f"{name}-{c.name}", c.digest) for c in cases]
            there = [data for data in kept if data is not None]
            if len(there) == len(cases):
                results[name] = there
    return results


def draw_all(results: dict[str, list[Measurement]], folder: Path) -> None:
    """The figures, one PNG each."""
    for data in results.get("progress", []):
        progress.draw(data, folder / f"progress-{data['name']}.png")
    for name, draw in (
        ("bounded", bounded.draw),
        ("conformal", conformal.draw),
        ("exponential", exponential.draw),
        ("hessian-samples", hessian_samples.draw),
    ):
        if name in results:
            draw(results[name][0], folder / f"{name}.png")
    for name, draw_many in (
        ("lipschitz", lipschitz.draw),
        ("stages", stages.draw),
        ("folding", folding.draw),
    ):
        if name in results:
            draw_many(results[name], folder / f"{name}.png")
