"""List the bundled sample pictures, which `glid-nb demo` takes by name."""

from __future__ import annotations

import argparse
import json

from glid_nb import samples

_KINDS = ("gentle", "extreme")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--json", action="store_true", help="print the list as JSON")


def run(chosen: argparse.Namespace) -> None:
    names = samples.names()
    width = max(map(len, names))
    if chosen.json:
        print(json.dumps({name: _files(name) for name in names}))
        return
    for name in names:
        print(f"{name:<{width}}  {samples.path(name)}  (poses: {', '.join(_KINDS)})")


def _files(name: str) -> dict[str, object]:
    poses = {kind: str(samples.pose_path(name, kind)) for kind in _KINDS}
    return {"picture": str(samples.path(name)), "poses": poses}
