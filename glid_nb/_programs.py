"""Compiled programs that are kept, as executables, between processes.

JAX's own cache keeps the result of XLA, and a program must be traced and lowered before it is found
there, which takes four times as long as reading it. Here a program is found by what it is called
with. Whoever waits for one can watch the stages that it goes through, and end them.
"""

from __future__ import annotations

import functools
import hashlib
import importlib
import os
import pickle
import threading
import uuid
import zlib
from collections import defaultdict
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from glid_nb._files import write_bytes_atomically
from glid_nb._jax import jax
from glid_nb._runtime import COMPILER_OPTIONS, stage


class Program:
    """A function compiled once for each kind of arguments, also where several threads want it."""

    def __init__(
        self, function: Callable[..., Any], donate: int, may_keep: Callable[..., bool]
    ) -> None:
        """``may_keep(*arguments)``: whether their types and our own code say what is compiled."""
        self._function, self._donate, self._may_keep = function, donate, may_keep
        self._ready: dict[Any, Any] = {}
        self._locks: defaultdict[Any, threading.Lock] = defaultdict(threading.Lock)

    def __call__(self, *arguments: Any) -> Any:
        """The function's value; the argument that it donates is gone afterwards."""
        leaves, tree = jax.tree.flatten(arguments)
        device = jax.config.jax_default_device or jax.devices()[0]
        key = (device, tree, *map(jax.typeof, leaves))
        if key not in self._ready:
            with self._locks[key]:  # a second thread waits for what the first compiles
                if key not in self._ready:
                    path = _path(key) if self._may_keep(*arguments) else None
                    self._ready[key] = _kept(path) or self._made(path, arguments)
        return self._ready[key](*arguments)

    def _made(self, path: Path | None, arguments: Any) -> Any:
        stage("trace")

        def program(*arguments: Any) -> Any:
            return self._function(*arguments)

        # With a name of its own JAX's cache does not know it: what comes from there loses its
        # functions when it is kept again.
        program.__name__ = f"{self._function.__name__}_{uuid.uuid4().hex}"
        jitted = jax.jit(program, donate_argnums=self._donate, compiler_options=COMPILER_OPTIONS)
        traced = jitted.trace(*arguments)
        stage("lower")
        lowered = traced.lower()
        stage("compile")
        made = lowered.compile()
        if path is not None:
            content = zlib.compress(pickle.dumps(_serialization().serialize(made)), 1)
            path.parent.mkdir(parents=True, exist_ok=True)
            write_bytes_atomically(path, hashlib.sha256(content).digest() + content)
        return made


def _kept(path: Path | None) -> Any:
    """What an earlier process has compiled; None if there is nothing, or not all of it."""
    if path is None or not path.is_file():
        return None
    stage("load")
    data = path.read_bytes()
    if hashlib.sha256(data[32:]).digest() != data[:32]:
        return None
    return _serialization().deserialize_and_load(*pickle.loads(zlib.decompress(data[32:])))


def _serialization() -> Any:
    return importlib.import_module("jax.experimental.serialize_executable")


def _path(key: Any) -> Path | None:
    """Where a program is kept; None without a folder for compiled programs."""
    folder = jax.config.jax_compilation_cache_dir
    if folder is None or key[0].platform != "cpu":
        return None
    name = hashlib.sha256(repr((_here(), key)).encode()).hexdigest()
    return Path(folder) / f"glid_nb-{name}"


@functools.cache
def _here() -> tuple[Any, ...]:
    """What a kept program depends on beside its arguments: our code, libraries, processor."""
    root = Path(__file__).parent
    files = [(str(path.relative_to(root)), path.stat()) for path in sorted(root.glob("**/*.py"))]
    code = [(name, stat.st_size, stat.st_mtime_ns) for name, stat in files]
    features = np._core._multiarray_umath.__cpu_features__  # type: ignore[attr-defined]
    versions = [version(name) for name in ("jax", "jaxlib")]
    return code, versions, os.environ.get("XLA_FLAGS"), sorted(features.items())
