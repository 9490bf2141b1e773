"""List the bundled sample pictures, which `glid-nb demo` takes by name."""

from __future__ import annotations

import argparse
import json

import glid_nb

_KINDS = ("gentle", "extreme")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument("--json", action="store_true", help="print the list as JSON")


def run(chosen: argparse.Namespace) -> None:
    """Run the command."""
    names = glid_nb.samples.names()
    if chosen.json:
        print(
            json.dumps(
                {
                    name: {
                        "picture": str(glid_nb.samples.path(name)),
                        "poses": {k: str(glid_nb.samples.pose_path(name, k)) for k in _KINDS},
                    }
                    for name in names
                }
            )
        )
        return
    width = max(map(len, names))
    for name in names:
        print(f"{name:<{width}}  {glid_nb.samples.path(name)}  (poses: {', '.join(_KINDS)})")
