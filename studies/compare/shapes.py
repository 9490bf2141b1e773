"""The shapes of a comparison: the paper's if they are given, else our samples."""

from collections.abc import Callable

from studies.study import Plan

_PAPER = ("deer", "archery", "giraffe", "rex", "racoon", "raptor", "colorbar")
_SAMPLES = ("gecko-extreme", "teapot-extreme", "frog-extreme", "gingerbread-extreme")


def all_shapes(plan: Plan) -> tuple[str, ...]:
    """The paper's shapes, or some samples in their extreme poses."""
    return tuple(name for name in _PAPER if name in plan.references) or _SAMPLES


def some(names: tuple[str, ...], otherwise: str) -> Callable[[Plan], tuple[str, ...]]:
    """The given reference problems among ``names``, or else a sample."""
    return lambda plan: tuple(n for n in names if n in plan.references) or (otherwise,)
