"""Compile programs of Newton's method before they are needed, in another process.

The other process has the lowest priority and can be ended at any time. It leaves the programs in
the folder of compiled programs (`_programs`), where the first call finds them.
"""

import os
import pickle
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from glid_nb._jax import jax
from glid_nb._runtime import double_precision, jax_option
from glid_nb.pose import Stiffness
from glid_nb.solvers import step
from glid_nb.solvers.method import Inputs
from glid_nb.solvers.newton import Newton, NewtonDescent
from glid_nb.solvers.positional import wider

Arguments = tuple[Any, ...]
"""Those of a compiled call; arrays may be replaced by their types."""

_FEW = 4  # with fewer free rows, the next pins or rings need a program for more rows
# Other folders of the path come first: the package's may hold modules with the same names.
_CODE = "import sys; sys.path.append(sys.argv[1]); from glid_nb.solvers.ahead import main; main()"
_LOWEST = 19  # the lowest priority of POSIX


@double_precision
def missing_programs(inputs: Inputs) -> list[Arguments]:
    """The types of calls that solves of this problem and similar ones may make and that would
    compile, the likeliest first: with the full Hessian, with stiff areas, with more pins."""
    descent = NewtonDescent(Newton(), inputs)
    found = [descent.arguments()]
    found += _with_full_hessian(descent)
    if not inputs.pose.stiffness:
        stiff = replace(inputs, pose=replace(inputs.pose, stiffness=_somewhere(inputs)))
        descent = NewtonDescent(Newton(), stiff)
        found += [descent.arguments(), *_with_full_hessian(descent)]
    problem, *others = found[0]
    if problem.positional.free < _FEW:
        found.append((problem._replace(positional=wider(problem.positional)), *others))
    return [jax.tree.map(_type, one) for one in found if step.run.is_missing(*one)]


def _with_full_hessian(descent: NewtonDescent) -> list[Arguments]:
    return [descent.arguments()] if descent.take_full_hessian() else []


def _somewhere(inputs: Inputs) -> Stiffness:
    """A stiff area inside the shape. All stiff areas have the same programs."""
    cage = inputs.domain.cage
    inside = cage.polygon.representative_point()
    return Stiffness().painted([[inside.x, inside.y]], cage.unit)


def _type(leaf: Any) -> Any:
    return (
        leaf if type(leaf) in (bool, int, float) else jax.ShapeDtypeStruct(leaf.shape, leaf.dtype)
    )


def start(missing: Sequence[Arguments]) -> subprocess.Popen[bytes] | None:
    """Start a process that compiles programs. None if this system starts no processes."""
    root = str(Path(__file__).resolve().parents[2])  # of the package
    silent = subprocess.DEVNULL
    lowest = getattr(subprocess, "IDLE_PRIORITY_CLASS", 0)  # of Windows
    # Only programs for the CPU are kept, so the process must not take a GPU.
    environment = {**os.environ, "JAX_PLATFORMS": "cpu"}
    command = [sys.executable, "-c", _CODE, root]
    try:
        process = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=silent,
            stderr=silent,
            env=environment,
            creationflags=lowest,
        )
    except (OSError, ValueError):  # no such system call, or no interpreter is known
        return None
    assert process.stdin is not None
    try:
        with process.stdin as pipe:
            pipe.write(pickle.dumps((jax_option("jax_compilation_cache_dir"), list(missing))))
    except OSError:  # it has ended before it read that
        process.wait()
        return None
    return process


def main() -> None:
    """Compile what standard input asks for."""
    if hasattr(os, "nice"):
        os.nice(_LOWEST)
    folder, missing = pickle.load(sys.stdin.buffer)
    jax.config.update("jax_compilation_cache_dir", folder)
    _compile(missing)


@double_precision
def _compile(missing: Sequence[Arguments]) -> None:
    for arguments in missing:
        step.run.make(*jax.tree.map(_blank, arguments))


def _blank(leaf: Any) -> Any:
    is_type = isinstance(leaf, jax.ShapeDtypeStruct)
    return np.zeros(leaf.shape, leaf.dtype) if is_type else leaf
