"""Compiled programs that are kept, as executables, between processes.

In JAX's own cache a program is found once it is traced and lowered, which takes four times as long
as reading it. Here it is found by the arguments that it is called with, as long as the package's
files are the same, and else by its lowered text. Its stages can be watched (`_runtime.watched`).
"""

import functools
import hashlib
import os
import threading
import time
import uuid
from collections import defaultdict
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path
from typing import Any

from glid_nb._features import compiler_options, processor
from glid_nb._jax import jax
from glid_nb._kept_programs import KeptPrograms
from glid_nb._runtime import default_device, jax_option, stage

_MOST_LOADED = 4  # of 15 MB each; one solve uses up to four


class Program:
    """A function compiled once for each kind of arguments, also where several threads want it.

    Of those in files the few that were used last stay in memory. The call takes its argument number
    ``donated``. ``may_keep(*arguments)`` says whether their types and our own code tell what is
    compiled.
    """

    def __init__(
        self, function: Callable[..., Any], donated: int, may_keep: Callable[..., bool]
    ) -> None:
        self._function, self._donated, self._may_keep = function, donated, may_keep
        self._ready, self._last_use = dict[Any, Any](), dict[Any, float]()  # of those in files
        self._locks: defaultdict[Any, threading.Lock] = defaultdict(threading.Lock)

    def __call__(self, *arguments: Any) -> Any:
        leaves, tree = jax.tree.flatten(arguments)
        key = (default_device(), tree, *map(jax.typeof, leaves))
        if (ready := self._ready.get(key)) is None:
            with self._locks[key]:  # a second thread waits for what the first compiles
                if (ready := self._ready.get(key)) is None:
                    ready = self._ready[key] = self._loaded_or_made(key, arguments)
        if key in self._last_use:
            self._last_use[key] = time.monotonic()
        return ready(*arguments)

    def _loaded_or_made(self, key: Any, arguments: Any) -> Any:
        folder = jax_option("jax_compilation_cache_dir")
        if folder is None or not can_keep_for(key[0]) or not self._may_keep(*arguments):
            lowered = self._lowered(arguments, "")
            stage("compile")
            return lowered.compile()
        self._make_room()
        self._last_use[key] = time.monotonic()
        programs = KeptPrograms(Path(folder))
        alias = f"glid_nb_arguments_{_digest(repr((_package_files(), key)))}"
        if (known := programs.by_alias(alias)) is not None:
            return known
        # With a name of its own JAX's cache does not know it: what comes from there loses its
        # functions when it is kept again.
        own = f"_{uuid.uuid4().hex}"
        lowered = self._lowered(arguments, own)
        # The arguments too: another version may nest the same arrays in other classes.
        text = f"{key!r}{lowered.as_text().replace(own, '')}"
        name = f"glid_nb_program_{_digest(text)}"
        if (known := programs.by_name(name)) is not None:
            programs.name_again(name, alias)
            return known
        stage("compile")
        compiled = lowered.compile()
        programs.keep(compiled, name, [alias])
        return compiled

    def _make_room(self) -> None:
        latest = sorted(self._last_use.items(), key=lambda item: item[1], reverse=True)
        for key, _ in latest[_MOST_LOADED - 1 :]:
            self._ready.pop(key, None)
            self._last_use.pop(key, None)

    def _lowered(self, arguments: Any, name: str) -> Any:
        def program(*arguments: Any) -> Any:
            return self._function(*arguments)

        program.__name__ = self._function.__name__ + name
        jitted = jax.jit(program, donate_argnums=self._donated, compiler_options=compiler_options())
        stage("trace")
        traced = jitted.trace(*arguments)
        stage("lower")
        return traced.lower()


def can_keep_for(device: Any) -> bool:
    """Whether executables for a device are kept: a CPU's, as long as it is JAX's only device.

    They are read for all devices of JAX's default platform, which on a machine with a GPU is that,
    also where a caller chose the CPU.
    """
    return device.platform == jax.default_backend() == "cpu" and jax.device_count() == 1


def _digest(text: str) -> str:
    return hashlib.sha256(f"{_here()}{text}".encode()).hexdigest()


@functools.cache
def _here() -> tuple[Any, ...]:
    """What every program depends on: the libraries, their flags and the processor."""
    return version("jax"), version("jaxlib"), os.environ.get("XLA_FLAGS"), processor()


@functools.cache
def _package_files() -> list[tuple[Any, ...]]:
    root = Path(__file__).parent
    files = [(str(path.relative_to(root)), path.stat()) for path in sorted(root.glob("**/*.py"))]
    return [(name, stat.st_size, stat.st_mtime_ns) for name, stat in files]
