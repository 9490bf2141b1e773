"""How the package runs JAX: nothing leaks into the user's program."""

from __future__ import annotations

import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from glid_nb import _runtime
from glid_nb._cache_folder import CacheWarning
from glid_nb._features import enable_x64
from glid_nb.certificate import certify
from glid_nb.harmonic import HarmonicMap

from ..support.domains import domain


def run_python(source: str) -> list[str]:
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", source],
        capture_output=True,
        text=True,
        timeout=200,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.split("\n")[:-1]


@pytest.mark.slow
def test_a_float32_program_beside_the_package_is_unchanged() -> None:
    """In one process, in the main thread and in others, before, during and after the work."""
    lines = run_python("""
import threading
import jax, jax.numpy as jnp, numpy as np
before = dict(jax.config.values)

@jax.jit
def step(x):
    return jnp.sin(x) * 3 + jnp.arange(x.shape[0])

def float32_program():
    x = jnp.linspace(0, 1, 7)
    y = step(x)
    assert x.dtype == y.dtype == jnp.ones(3).dtype == jnp.float32, (x.dtype, y.dtype)
    assert jnp.arange(3).dtype == jnp.int32
    assert jnp.asarray(np.ones(2)).dtype == jnp.float32
    assert jax.random.normal(jax.random.key(0)).dtype == jnp.float32
    return np.asarray(y).tobytes(), step._cache_size()

first = float32_program()
import glid_nb
from glid_nb.certificate import certify
from glid_nb.geometry import Cage, Domain
assert float32_program() == first

seen, errors, stop, begun = [], [], threading.Event(), threading.Event()
def watch():
    while not stop.wait(0.001):  # a pause, for the solver to get on
        try:
            seen.append(float32_program())
        except BaseException as error:
            errors.append(error)
            break
        begun.set()
watcher = threading.Thread(target=watch)
watcher.start()
assert begun.wait(60)
cage = Cage([[0, 0], [2, 0], [2, 1], [0, 1]])
result = glid_nb.solve(Domain.from_cage(cage), glid_nb.Pose([[0.5, 0.5]], [[1.5, 0.5]]))
map = result.map
c = certify(map)
assert c.certified
assert map([[0.5, 0.5]]).dtype == np.float64
stop.set()
watcher.join()
assert not errors, errors
assert set(seen) == {first} and len(seen) > 100, len(seen)
assert float32_program() == first
try:
    certify(map, "no such method")
except ValueError:
    pass
assert float32_program() == first
after = dict(jax.config.values)
print(sorted(key for key in after if after[key] != before.get(key)))
""")
    assert lines == ["[]"]


def test_double_precision_is_a_scope() -> None:
    @_runtime.double_precision
    def add(a: float, *, b: float = 1.0) -> jax.Array:
        """Docstring."""
        return jnp.asarray(a) + b

    assert add(2.0, b=3.0).dtype == jnp.float64
    assert add.__name__ == "add"
    assert add.__doc__ == "Docstring."
    assert jnp.asarray(1.0).dtype == jnp.float32

    @_runtime.double_precision
    def fail() -> None:
        add(1.0)
        raise RuntimeError("inside")

    with pytest.raises(RuntimeError, match="inside"):
        fail()
    assert jnp.asarray(1.0).dtype == jnp.float32


def test_results_are_double_inside_a_users_own_settings() -> None:
    map = HarmonicMap.identity(domain("ring"))
    points = domain("ring").cage.exterior
    with enable_x64():
        inside = map(points)
        assert jnp.asarray(1.0).dtype == jnp.float64
    assert inside.dtype == np.float64
    np.testing.assert_array_equal(inside, map(points))
    with jax.debug_nans(True):
        assert certify(map).certified


def test_threads_may_evaluate_at_once() -> None:
    map = HarmonicMap.identity(domain("ring"))
    points = domain("ring").cage.exterior

    def work(i: int) -> bool:
        ours = np.array_equal(map(points + 1e-9 * i), expected[i])
        return ours and jnp.ones(1).dtype == jnp.float32

    expected = [map(points + 1e-9 * i) for i in range(8)]
    with ThreadPoolExecutor(4) as pool:
        assert all(pool.map(work, range(8)))


BLAS = """
import threading
import pytest, threadpoolctl
import numpy, scipy.linalg
from glid_nb._runtime import single_blas_thread

def threads():
    return {i["num_threads"] for i in threadpoolctl.threadpool_info() if i["user_api"] == "blas"}

assert threads() == {2}, threads()
"""


@pytest.mark.slow
def test_blas_is_limited_and_set_back(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "2")
    run_python(
        BLAS
        + """
with single_blas_thread():
    assert threads() == {1}
    with single_blas_thread():
        assert threads() == {1}
    assert threads() == {1}
assert threads() == {2}
with pytest.raises(RuntimeError, match="inside"), single_blas_thread():
    raise RuntimeError("inside")
assert threads() == {2}
"""
    )


@pytest.mark.slow
def test_the_last_of_several_threads_sets_blas_back(monkeypatch: pytest.MonkeyPatch) -> None:
    """Like an editor's solver thread and a cell's solve that overlap, while both threads live
    on."""
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "2")
    run_python(
        BLAS
        + """
entered, may_leave, left, end = (threading.Event() for _ in range(4))
seen = {}

def editor():
    with single_blas_thread():
        seen["in the thread"] = threads()
        entered.set()
        may_leave.wait()
    left.set()
    end.wait()

thread = threading.Thread(target=editor)
thread.start()
entered.wait()
with single_blas_thread():
    seen["in both"] = threads()
    may_leave.set()
    left.wait()
    seen["in the last"] = threads()
seen["after"] = threads()
with single_blas_thread():
    seen["again"] = threads()
seen["at last"] = threads()
end.set()
thread.join()
one, two = {1}, {2}
expected = {"in the thread": one, "in both": one, "in the last": one, "after": two,
            "again": one, "at last": two}
assert seen == expected, seen
"""
    )


def test_cache_directory(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("GLID_NB_CACHE", str(tmp_path / "named"))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "xdg"))
    assert _runtime.cache_directory() == tmp_path / "named"
    monkeypatch.delenv("GLID_NB_CACHE")
    assert _runtime.cache_directory() == tmp_path / "xdg" / "glid_nb"
    monkeypatch.delenv("XDG_CACHE_HOME")
    monkeypatch.setattr(Path, "home", lambda: tmp_path)
    assert _runtime.cache_directory() == tmp_path / ".cache" / "glid_nb"


def test_a_user_without_a_home_has_folders_among_the_temporary_files(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def fail() -> Path:
        raise RuntimeError("Could not determine home directory.")

    for name in ("GLID_NB_CACHE", "XDG_CACHE_HOME", "GLID_NB_DATA", "XDG_DATA_HOME"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(Path, "home", fail)
    monkeypatch.setattr(_runtime.tempfile, "gettempdir", lambda: str(tmp_path))
    assert _runtime.cache_directory().parent == tmp_path
    assert _runtime.data_directory().parent == tmp_path


def test_where_nothing_can_be_written_the_cache_is_off_after_one_warning(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "file").write_text("not a folder", encoding="utf-8")
    monkeypatch.setenv("GLID_NB_CACHE", str(tmp_path / "file" / "below"))
    before = jax.config.jax_compilation_cache_dir
    jax.config.update("jax_compilation_cache_dir", None)
    try:
        with pytest.warns(CacheWarning, match="name a folder of your own .* GLID_NB_CACHE") as told:
            folders = [_runtime.enable_compilation_cache() for _ in range(2)]
        assert folders == [None, None]
        assert len(told) == 1
        assert jax.config.jax_compilation_cache_dir is None
    finally:
        jax.config.update("jax_compilation_cache_dir", before)


@pytest.mark.slow
def test_the_compilation_cache_is_used_when_it_is_asked_for(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.delenv("JAX_COMPILATION_CACHE_DIR", raising=False)
    source = f"""
import os
os.environ["GLID_NB_CACHE"] = {str(tmp_path)!r}
from glid_nb import _runtime
from glid_nb._cache_folder import CacheWarning
from glid_nb._features import enable_x64
from glid_nb._jax import jit, jnp
print(_runtime.enable_compilation_cache())
clock = _runtime.compilation_clock()
assert clock is _runtime.compilation_clock()
jit(lambda x: jnp.sin(x) @ x)(jnp.ones(8))
print(clock.programs > 0 and clock.seconds > 0)
"""
    assert run_python(source) == [str(tmp_path / "compiled"), "True"]
    kept = {path.name for path in (tmp_path / "compiled").iterdir()}
    assert kept
    assert run_python(source) == [str(tmp_path / "compiled"), "True"]
    assert {p.name for p in (tmp_path / "compiled").iterdir() if p.name.endswith("-cache")} == {
        name for name in kept if name.endswith("-cache")
    }


@pytest.mark.slow
def test_a_users_own_compilation_cache_stays(tmp_path: Path) -> None:
    lines = run_python(f"""
import jax
jax.config.update("jax_compilation_cache_dir", {str(tmp_path)!r})
before = dict(jax.config.values)
from glid_nb import _runtime
from glid_nb._cache_folder import CacheWarning
from glid_nb._features import enable_x64
print(_runtime.enable_compilation_cache())
print(dict(jax.config.values) == before)
""")
    assert lines == [str(tmp_path), "True"]
