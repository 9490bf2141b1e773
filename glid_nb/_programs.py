"""Compiled programs that are kept as executables between processes.

JAX's own cache finds a program only after tracing and lowering it, which takes four times as long
as reading it. This cache finds a program by the types of its arguments, as long as the package's
files have not changed. After a change it finds it by its lowered text. `_runtime.watched` observes
the stages.
"""

import functools
import hashlib
import logging
import os
import threading
import time
import uuid
from collections import defaultdict
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path
from typing import Any

from glid_nb._cache_folder import is_refused
from glid_nb._features import compiler_options, processor
from glid_nb._jax import jax
from glid_nb._kept_programs import KeptPrograms
from glid_nb._runtime import default_device, jax_option, stage

# Programs in memory, 15 MB each. A solve uses up to four; to read one takes as long as many solves.
MOST_LOADED = 8
_LOG = logging.getLogger(__name__)
_FORMAT = 2  # of the files; a change of how programs are written needs another number


class Program:
    """A function compiled once for each combination of argument types, also with several threads.

    Of the programs in files, the few that were used last stay in memory. A call destroys the
    argument number ``donated``. ``may_keep(*arguments)`` returns whether the arguments' types and
    our own code determine the compiled program.
    """

    def __init__(
        self, function: Callable[..., Any], donated: int, may_keep: Callable[..., bool]
    ) -> None:
        self.function, self.donated, self.may_keep = function, donated, may_keep
        # The last uses are recorded for programs in files only.
        self._ready, self._last_use = dict[Any, Any](), dict[Any, float]()
        self._locks: defaultdict[Any, threading.Lock] = defaultdict(threading.Lock)

    def __call__(self, *arguments: Any) -> Any:
        return self._ready_for(arguments)(*arguments)

    def make(self, *arguments: Any) -> None:
        """Read or compile the program for the types of these arguments, without a call."""
        self._ready_for(arguments)

    def is_missing(self, *arguments: Any) -> bool:
        """Whether a call would compile a program that another process could leave in a file."""
        key = _key(arguments)
        folder = self._folder(key, arguments)
        if folder is None or key in self._ready or is_refused(folder):
            return False
        return not KeptPrograms(folder).has(_alias(key))

    def _ready_for(self, arguments: Any) -> Any:
        key = _key(arguments)
        if (ready := self._ready.get(key)) is None:
            with self._locks[key]:  # a second thread waits for the first one to compile
                if (ready := self._ready.get(key)) is None:
                    ready = self._ready[key] = self._loaded_or_made(key, arguments)
        if key in self._last_use:
            self._last_use[key] = time.monotonic()
        return ready

    def _folder(self, key: Any, arguments: Any) -> Path | None:
        """The folder where the program is kept; None if it is not kept."""
        folder = jax_option("jax_compilation_cache_dir")
        if folder is None or not can_keep_for(key[0]) or not self.may_keep(*arguments):
            return None
        return Path(folder)

    def _loaded_or_made(self, key: Any, arguments: Any) -> Any:
        if (folder := self._folder(key, arguments)) is None:
            return _compiled(self._lowered(arguments, ""))
        self._make_room()
        self._last_use[key] = time.monotonic()
        programs, alias = KeptPrograms(folder), _alias(key)
        if (known := programs.by_alias(alias)) is not None:
            return known
        # A unique name keeps the program out of JAX's own cache. A program from that cache would
        # lose its functions when it is written again.
        own = f"_{uuid.uuid4().hex}"
        lowered = self._lowered(arguments, own)
        # The arguments too: another version may nest the same arrays in other classes.
        text = f"{key!r}{lowered.as_text().replace(own, '')}"
        name = f"glid_nb_program_{_digest(text)}"
        if (known := programs.by_name(name)) is not None:
            programs.name_again(name, alias)
            return known
        compiled = _compiled(lowered)
        programs.keep(compiled, name, [alias])
        return compiled

    def _make_room(self) -> None:
        latest = sorted(self._last_use.items(), key=lambda item: item[1], reverse=True)
        for key, _ in latest[MOST_LOADED - 1 :]:
            self._ready.pop(key, None)
            self._last_use.pop(key, None)

    def _lowered(self, arguments: Any, name: str) -> Any:
        def program(*arguments: Any) -> Any:
            return self.function(*arguments)

        program.__name__ = self.function.__name__ + name
        jitted = jax.jit(program, donate_argnums=self.donated, compiler_options=compiler_options())
        stage("trace")
        traced = jitted.trace(*arguments)
        stage("lower")
        return traced.lower()


def _compiled(lowered: Any) -> Any:
    stage("compile")
    _LOG.info("compiling a program for this size of problem, which takes seconds")
    start = time.perf_counter()
    compiled = lowered.compile()
    _LOG.info("compiled in %.1f s", time.perf_counter() - start)
    return compiled


def _key(arguments: Any) -> tuple[Any, ...]:
    """The device and the types of the arguments, which determine the program."""
    leaves, tree = jax.tree.flatten(arguments)
    return default_device(), tree, *map(jax.typeof, leaves)


def _alias(key: tuple[Any, ...]) -> str:
    return f"glid_nb_arguments_{_digest(repr((package_files(), key)))}"


def can_keep_for(device: Any) -> bool:
    """Whether executables for a device are kept: for a CPU, if it is JAX's only device.

    JAX loads executables for all devices of its default platform. On a machine with a GPU this is
    the GPU, even if the caller chose the CPU.
    """
    return device.platform == jax.default_backend() == "cpu" and jax.device_count() == 1


def _digest(text: str) -> str:
    return hashlib.sha256(f"{_here()}{text}".encode()).hexdigest()


@functools.cache
def _here() -> tuple[Any, ...]:
    """The libraries, their flags and the processor, on which every program depends, and how we
    write it."""
    return _FORMAT, version("jax"), version("jaxlib"), os.environ.get("XLA_FLAGS"), processor()


@functools.cache
def package_files() -> list[tuple[Any, ...]]:
    """Name, size and time of change of each file of this package."""
    root = Path(__file__).parent
    files = [(str(path.relative_to(root)), path.stat()) for path in sorted(root.glob("**/*.py"))]
    return [(name, stat.st_size, stat.st_mtime_ns) for name, stat in files]
