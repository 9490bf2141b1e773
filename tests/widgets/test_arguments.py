"""Keywords that a widget does not have are refused by name."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import ipywidgets
import numpy as np
import pytest

import glid_nb as glid
from glid_nb.session.deformation import Deformation
from glid_nb.widgets import TimelinePanel

from ..support.domains import domain

PICTURE = np.full((40, 40, 4), 255, np.uint8)


def unsolved() -> Deformation:
    return Deformation(domain("ell"), begin=False)


MAKERS: dict[str, Callable[..., Any]] = {
    "Editor": lambda **more: glid.Editor(PICTURE, **more),
    "DeformCanvas": lambda **more: glid.widgets.DeformCanvas(PICTURE, unsolved(), **more),
    "CageTracer": lambda **more: glid.widgets.CageTracer(PICTURE, **more),
    "SolverMonitor": lambda **more: glid.widgets.SolverMonitor(unsolved(), **more),
    "SolverPanel": lambda **more: glid.widgets.SolverPanel(unsolved(), **more),
    "TimelinePanel": lambda **more: TimelinePanel(None, **more),  # type: ignore[arg-type]
}


def _widgets() -> set[str]:
    return set(ipywidgets.Widget.get_manager_state(drop_defaults=True)["state"])


@pytest.mark.parametrize("name", MAKERS)
def test_an_unknown_keyword_is_refused_and_leaves_nothing(name: str) -> None:
    before = _widgets()
    with pytest.raises(TypeError, match=f"{name} has no argument 'colour'"):
        MAKERS[name](colour="red")
    assert _widgets() == before


@pytest.mark.parametrize(
    ("name", "given", "meant"),
    [
        ("Editor", "n_vertixes", "n_vertices"),
        ("Editor", "heigth", "height"),
        ("DeformCanvas", "evaluate_in", "evaluated_in"),
        ("DeformCanvas", "show_cages", "show_cage"),
        ("CageTracer", "option", "options"),
        ("SolverMonitor", "plot", "plots"),
        ("SolverPanel", "layuot", "layout"),
    ],
)
def test_what_was_probably_meant_is_said(name: str, given: str, meant: str) -> None:
    with pytest.raises(TypeError, match=f"did you mean '{meant}'"):
        MAKERS[name](**{given: 1})


def test_traits_of_ipywidgets_are_taken() -> None:
    monitor = glid.widgets.SolverMonitor(unsolved(), plots=False, layout={"width": "300px"})
    assert monitor.layout.width == "300px"
    monitor.close()
