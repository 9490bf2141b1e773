"""Imports only go downwards. The test reads the source of every module; nothing is imported."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[2] / "glid_nb"

FOUNDATION = "private modules at the top, such as _files"
# The lowest first. The members of one row do not import each other.
LAYERS = (
    (FOUNDATION,),
    ("geometry",),
    ("harmonic",),
    ("pose", "energies"),
    ("certificate", "imaging", "auditing"),
    ("solvers",),
    ("minima",),
    ("methods", "motion", "landmarks", "many"),
    ("page",),
    ("figures",),
    ("samples", "export"),
    ("session",),
    ("widgets", "io"),
    ("course",),
    ("grading",),
    ("cli",),
    ("__main__",),
)
HEIGHT = {name: height for height, row in enumerate(LAYERS) for name in row}
# The command line uses the public face, whose attributes are loaded lazily.
USES_THE_FACE = {"cli"}


def modules() -> list[Path]:
    return sorted(p for p in PACKAGE.rglob("*.py*") if p.suffix in (".py", ".pyi"))


def layer_called(name: str) -> str:
    return FOUNDATION if name.startswith("_") and not name.startswith("__") else name


def layer_of(path: Path) -> str:
    return layer_called(path.relative_to(PACKAGE).with_suffix("").parts[0])


def imported(source: str, package: tuple[str, ...]) -> Iterator[tuple[int, str]]:
    """Line and layer of every import from this package; ``""`` is its public face.

    ``package`` holds the names of the package that the source's module lives in.
    """
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif not isinstance(node, ast.ImportFrom):
            continue
        else:
            base = package[: len(package) - node.level + 1] if node.level else ()
            module = ".".join((*base, *([node.module] if node.module else [])))
            # `from glid_nb import geometry` is an import of the layer, `... import Cage` is not.
            if module == "glid_nb":
                names = [
                    f"glid_nb.{a.name}" if layer_called(a.name) in HEIGHT else module
                    for a in node.names
                ]
            else:
                names = [module]
        for name in names:
            head, *rest = name.split(".")
            if head == "glid_nb":
                yield node.lineno, layer_called(rest[0]) if rest else ""


def violations(source: str, layer: str, package: tuple[str, ...]) -> list[str]:
    found = []
    for line, target in imported(source, package):
        if target == layer:
            continue
        if target == "":
            if layer not in USES_THE_FACE:
                found.append(f"line {line}: {layer} imports the public face glid_nb")
        elif target not in HEIGHT:
            found.append(f"line {line}: {target} is in no row of LAYERS")
        elif HEIGHT[target] >= HEIGHT[layer]:
            found.append(f"line {line}: {layer} imports {target}, which is not below it")
    return found


@pytest.mark.parametrize("path", modules(), ids=lambda p: str(p.relative_to(PACKAGE)))
def test_imports_go_downwards(path: Path) -> None:
    layer = layer_of(path)
    if layer == "__init__":
        return
    assert layer in HEIGHT, f"{layer} is in no row of LAYERS"
    package = path.relative_to(PACKAGE.parent).parent.parts
    assert violations(path.read_text(encoding="utf-8"), layer, package) == []


@pytest.mark.parametrize(
    "source",
    [
        "from glid_nb.solvers import solve",
        "from glid_nb import solvers",
        "import glid_nb.solvers.newton",
        "from ..solvers import solve",
        "def f():\n    from glid_nb.solvers import solve",
        "from glid_nb import Cage",
        "import glid_nb",
        "from glid_nb.unheard_of import f",
    ],
)
def test_an_upward_import_is_found(source: str) -> None:
    assert violations(source, "harmonic", ("glid_nb", "harmonic"))


@pytest.mark.parametrize(
    "source",
    [
        "from glid_nb.geometry import Cage",
        "from .basis import Basis",
        "from ..geometry import Cage",
    ],
)
def test_a_downward_import_is_not(source: str) -> None:
    assert violations(source, "harmonic", ("glid_nb", "harmonic")) == []


def test_every_row_is_used_at_most_once() -> None:
    names = [name for row in LAYERS for name in row]
    assert len(names) == len(set(names))
