"""The public face: complete, light, and without side effects."""

from __future__ import annotations

import ast
import subprocess
import sys
from operator import attrgetter
from pathlib import Path

import pytest

import glid_nb

STUB = Path(glid_nb.__file__).with_suffix(".pyi")


ROOMS = ("energies", "io", "session", "widgets")
"""Modules of the face whose names are public, too."""


def names_at_the_top() -> list[str]:
    tree = ast.parse(STUB.read_text(encoding="utf-8"))
    imports = [node for node in tree.body if isinstance(node, ast.ImportFrom)]
    return [alias.name for node in imports for alias in node.names]


def public_names() -> list[str]:
    """Every public name as it stands after ``glid.``, without the rooms themselves."""
    top = [name for name in names_at_the_top() if name not in ROOMS]
    within = [(room, name) for room in ROOMS for name in getattr(glid_nb, room).__all__]
    return top + [f"{room}.{name}" for room, name in within if name not in top]


def run_python(source: str) -> str:
    done = subprocess.run(
        [sys.executable, "-c", source], capture_output=True, text=True, check=True, timeout=120
    )
    return done.stdout.strip()


@pytest.mark.parametrize("name", public_names())
def test_every_name_resolves_to_something_documented(name: str) -> None:
    assert attrgetter(name)(glid_nb).__doc__


def test_the_names_are_listed() -> None:
    assert set(names_at_the_top()) <= set(dir(glid_nb))
    assert len(public_names()) == len(set(public_names()))


def test_a_room_has_a_word_about_itself() -> None:
    assert all(getattr(glid_nb, room).__doc__ for room in ROOMS)


def test_an_unknown_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="unheard_of"):
        getattr(glid_nb, "unheard_of")  # noqa: B009


def test_importing_loads_nothing_heavy() -> None:
    heavy = ("jax", "numpy", "scipy", "matplotlib", "skimage", "shapely", "pythreejs", "ipywidgets")
    loaded = run_python(f"import glid_nb, sys; print([m for m in {heavy} if m in sys.modules])")
    assert loaded == "[]"


@pytest.mark.slow
def test_loading_every_name_leaves_the_jax_configuration_alone() -> None:
    source = """
import jax
before = dict(jax.config.values)
import glid_nb
for name in glid_nb.__all__:
    getattr(glid_nb, name)
after = dict(jax.config.values)
print({key: (before[key], after[key]) for key in before if before[key] != after[key]})
import jax.numpy as jnp
print(jnp.ones(3).dtype)
"""
    assert run_python(source).splitlines() == ["{}", "float32"]


def test_the_version_is_the_distributions() -> None:
    from importlib.metadata import version

    assert glid_nb.__version__ == version("glid-nb")


def test_the_citation_names_the_version() -> None:
    text = (STUB.parents[1] / "CITATION.cff").read_text(encoding="utf-8")
    assert f"\nversion: {glid_nb.__version__}\n" in text
