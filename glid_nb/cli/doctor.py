"""Show what is installed and what works, on one screen to paste into a bug report.

The exit code is 1 if a problem keeps glid-nb from working.
"""

import argparse
import json
from collections.abc import Iterator
from typing import Any

import glid_nb
from glid_nb._diagnosis import diagnosis, problems
from glid_nb._errors import InputError


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--json", action="store_true", help="print everything as JSON")


def run(chosen: argparse.Namespace) -> None:
    found = {"glid-nb": glid_nb.__version__, **diagnosis()}
    wrong = problems(found)
    if chosen.json:
        print(json.dumps({**found, "problems": wrong}))
    else:
        rows = list(_rows(found))
        width = max(len(name) for name, _ in rows)
        print("\n".join(f"{name:<{width}}  {text}".rstrip() for name, text in rows))
    if wrong:
        raise InputError("; ".join(wrong))


def _rows(found: dict[str, Any]) -> Iterator[tuple[str, str]]:
    yield "glid-nb", found["glid-nb"]
    yield "Python", found["python"]
    yield "system", found["system"]
    yield "host", found["host"]
    libraries = [f"{name} {one['installed']}" for name, one in found["libraries"].items()]
    for first in range(0, len(libraries), 5):
        yield "" if first else "libraries", ", ".join(libraries[first : first + 5])
    if "error" in found["jax"]:
        yield "JAX", found["jax"]["error"]
    else:
        yield from _jax_rows(found["jax"])
    yield "BLAS", "; ".join(found["blas"]) or "none found"
    for name, folder in found["folders"].items():
        size = f"{folder['files']} files, {folder['bytes'] / 1e6:.1f} MB"
        can = "" if folder["writable"] else ", cannot be written to"
        yield name, f"{folder['path']} ({size}{can}; {folder['variable']} names another)"
    for name, extra in found["extras"].items():
        state = f"missing {', '.join(extra['missing'])}" if extra["missing"] else "installed"
        yield f"[{name}]", f"{state}: {extra['gives']}"


def _jax_rows(jax: dict[str, Any]) -> Iterator[tuple[str, str]]:
    for name, value in jax.items():
        if isinstance(value, bool):
            yield name, "yes" if value else "no"
        elif isinstance(value, list):
            yield name, ", ".join(value) or "none"
        else:
            yield name, "not used" if value is None else str(value)
