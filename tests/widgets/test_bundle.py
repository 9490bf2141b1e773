"""Joining the page's modules."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import glid_nb
from glid_nb import _scripts
from glid_nb._scripts import bundle, stylesheet

_TEXTS = (".py", ".js", ".css", ".glsl", ".frag", ".vert", ".html")


def test_every_module_comes_once_and_before_its_users() -> None:
    text = bundle("tracer/main.js")
    assert not re.search(r"^import |^export (?!default)", text, re.MULTILINE)
    assert text.count("class View {") == 1
    assert text.index("class View {") < text.index("class Stage {")
    assert text.index("function make(") < text.index("function makePanel(")
    assert text.rstrip().endswith("export default { render };")


@pytest.mark.parametrize("entry", ["tracer/main.js", "canvas/main.js"])
def test_top_level_names_differ(entry: str) -> None:
    names = re.findall(r"^(?:const|function|class) (\w+)", bundle(entry), re.MULTILINE)
    assert len(names) == len(set(names))


def test_imports_name_what_is_exported() -> None:
    folder = _scripts._FOLDER
    for module in folder.glob("*/*.js"):
        text = module.read_text()
        for names, other in re.findall(r'^import \{ ([^}]*) \} from "([^"]+)";', text, re.M):
            exported = (module.parent / other).read_text()
            for name in names.split(", "):
                assert re.search(
                    rf"^export (?:async )?(class|const|function) {name}\b", exported, re.M
                )
                assert len(re.findall(rf"\b{name}\b", text)) > 1, f"{module.name}: {name} unused"


def test_a_circle_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "a.js").write_text('import { b } from "./b.js";\nexport const a = b;\n')
    (tmp_path / "b.js").write_text('import { a } from "./a.js";\nexport const b = a;\n')
    monkeypatch.setattr(_scripts, "_FOLDER", tmp_path)
    with pytest.raises(ValueError, match=r"a\.js imports itself by way of b\.js"):
        bundle("a.js")


def test_the_stylesheet_uses_only_variables_that_it_defines() -> None:
    text = stylesheet("tracer/tracer.css")
    defined = set(re.findall(r"(--glid-[\w-]+):", text)) | {"--glid-height"}
    assert set(re.findall(r"var\((--glid-[\w-]+)", text)) <= defined


def test_no_file_holds_the_marks_of_a_merge() -> None:
    files = [path for path in Path(glid_nb.__file__).parent.rglob("*") if path.suffix in _TEXTS]
    marked = [path for path in files if re.search("^(<{7}|>{7}) ", path.read_text(), re.MULTILINE)]
    assert files
    assert marked == []
