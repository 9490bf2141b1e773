"""The files that the package sends to the browser: bundles, style sheets and shaders."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import glid_nb
from glid_nb.page import bundle, stylesheet, template, webgl2_shaders

_TEXTS = (".py", ".js", ".css", ".glsl", ".frag", ".vert", ".html")
_WIDGETS = ("canvas", "clipboard", "loader", "rows", "timeline", "toolbar", "tracer")


@pytest.mark.parametrize("name", _WIDGETS)
def test_a_widgets_bundle_is_one_module_that_imports_nothing(name: str) -> None:
    text = bundle(name)
    assert not re.search(r"^import |\bimport\(\"", text, re.MULTILINE)
    assert "as default" in text


def test_the_exported_pages_bundle_is_a_plain_script() -> None:
    text = bundle("exported")
    assert not re.search(r"^(import|export) ", text, re.MULTILINE)
    assert "</script" not in text


@pytest.mark.parametrize("name", ["canvas", "timeline", "toolbar", "tracer"])
def test_a_stylesheet_imports_nothing(name: str) -> None:
    assert "@import" not in stylesheet(name)
    assert ".glid-skin" in stylesheet(name)


def test_the_stylesheet_uses_only_variables_that_it_defines() -> None:
    text = stylesheet("tracer")
    defined = set(re.findall(r"(--glid-[\w-]+):", text)) | {"--glid-height"}
    assert set(re.findall(r"var\((--glid-[\w-]+)", text)) <= defined


def test_the_exported_page_names_what_its_script_looks_for() -> None:
    named = set(re.findall(r'\bid="(\w+)"', template("exported")))
    assert set(re.findall(r'\bbyId\("(\w+)"', bundle("exported"))) <= named


def test_shaders_without_three_js_say_their_version_first() -> None:
    for text in webgl2_shaders("picture", None, 5):
        assert text.startswith("#version 300 es\n")


def test_no_file_holds_the_marks_of_a_merge() -> None:
    files = [path for path in Path(glid_nb.__file__).parent.rglob("*") if path.suffix in _TEXTS]
    marked = [
        path for path in files if re.search("^(<{7}|>{7}) ", path.read_text("utf-8"), re.MULTILINE)
    ]
    assert files
    assert marked == []
