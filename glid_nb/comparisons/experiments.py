"""What is measured on which shapes, in the order in which the page shows it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from glid_nb.comparisons import maps, parts, progress
from glid_nb.comparisons.cases import Case, reference_cases, sample_case
from glid_nb.comparisons.store import Measurement, Store

Detail = Callable[[str], None]

TABLE_2 = ("deer", "archery", "giraffe", "rex", "racoon", "raptor")
"""The shapes of Table 2."""
_FURTHER = ("colorbar",)
_SAMPLES = ("gecko", "teapot", "frog", "gingerbread")

NAMES = (
    "progress",
    "bounded",
    "conformal",
    "exponential",
    "lipschitz",
    "hessian-samples",
    "stages",
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
        shapes = tuple(name for name in (*TABLE_2, *_FURTHER) if name in found)
        shapes = shapes or tuple(f"{name}-extreme" for name in _SAMPLES)
        return cls(
            shapes,
            tuple(name for name in ("raptor", "giraffe") if name in found) or shapes[:2],
            "deer" if "deer" in found else shapes[0],
            "archery" if "archery" in found else "frog-extreme",
            "colorbar" if "colorbar" in found else "bar-extreme",
            "gecko-gentle",
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
    """Every chosen experiment, as a list of measurements, one per shape."""
    table: dict[str, tuple[tuple[str, ...], Callable[[Case, Detail], Measurement]]] = {
        "progress": (shapes.progress, progress.measure),
        "bounded": ((shapes.bounded,), maps.measure_bounded),
        "conformal": ((shapes.conformal,), maps.measure_conformal),
        "exponential": ((shapes.exponential,), maps.measure_exponential),
        "lipschitz": (shapes.lipschitz, parts.measure_lipschitz),
        "hessian-samples": ((shapes.hessian_samples,), parts.measure_hessian_samples),
        "stages": (shapes.progress, parts.measure_stages),
    }
    results: dict[str, list[Measurement]] = {}
    for name in NAMES:
        if name not in only:
            continue
        chosen, measure = table[name]
        results[name] = [
            store.get(f"{name}-{shape}", lambda m=measure, s=shape: m(shapes.case(s), detail))
            for shape in chosen
        ]
    return results


def draw_all(results: dict[str, list[Measurement]], folder: Path) -> None:
    """The figures, one PNG each."""
    for data in results.get("progress", []):
        progress.draw(data, folder / f"progress-{data['name']}.png")
    for name, draw in (
        ("bounded", maps.draw_bounded),
        ("conformal", maps.draw_conformal),
        ("exponential", maps.draw_exponential),
        ("hessian-samples", parts.draw_hessian_samples),
    ):
        if name in results:
            draw(results[name][0], folder / f"{name}.png")
    for name, draw_many in (("lipschitz", parts.draw_lipschitz), ("stages", parts.draw_stages)):
        if name in results:
            draw_many(results[name], folder / f"{name}.png")
