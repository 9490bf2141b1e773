"""List the bundled sample pictures. `glid-nb demo` accepts their names."""

import argparse
import json
from typing import get_args

from glid_nb import samples

_KINDS = get_args(samples.PoseKind)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--json", action="store_true", help="print the list as JSON")


def run(chosen: argparse.Namespace) -> None:
    names = samples.names()
    if chosen.json:
        poses = {name: {k: str(samples.pose_path(name, k)) for k in _KINDS} for name in names}
        files = {name: {"picture": str(samples.path(name)), "poses": poses[name]} for name in names}
        print(json.dumps(files))
        return
    width = max(map(len, names))
    for name in names:
        print(f"{name:<{width}}  {samples.path(name)}  (poses: {', '.join(_KINDS)})")
