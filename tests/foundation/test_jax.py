"""JAX is imported only when something is computed."""

from __future__ import annotations

import subprocess
import sys

import pytest


def run_python(source: str) -> list[str]:
    done = subprocess.run(
        [sys.executable, "-c", source], capture_output=True, text=True, check=True, timeout=120
    )
    return done.stdout.splitlines()


@pytest.mark.slow
def test_an_editor_is_made_and_maps_are_evaluated_and_proved_without_jax() -> None:
    source = """
import sys, glid_nb
glid_nb.Editor(glid_nb.samples.image("gecko"), n_vertices=300).close()  # of more vertices
editor = glid_nb.Editor(glid_nb.samples.image("bar"), n_vertices=300)
print(sorted({"jax", "matplotlib"} & set(sys.modules)))
print(editor.map([[1.0, 0.5]]).round(6).tolist(), editor.certificate.certified)
print("jax" in sys.modules)
from glid_nb._jax import jax
print(jax.config.jax_compilation_cache_dir is not None)
editor.close()
"""
    assert run_python(source) == ["[]", "[[1.0, 0.5]] True", "False", "True"]


@pytest.mark.slow
@pytest.mark.parametrize("imported", ["before", "after"])
def test_an_energy_goes_through_a_users_own_compiled_function(imported: str) -> None:
    lines = ["import jax", "import glid_nb; Energy = glid_nb.energies.AMIPS"]
    source = "\n".join(lines if imported == "before" else reversed(lines))
    source += "\nprint(jax.jit(lambda e: e.s + 1)(Energy(s=2.0)))"
    assert run_python(source) == ["3.0"]


@pytest.mark.slow
def test_what_waits_is_done_once_and_before_anything_is_computed() -> None:
    source = """
from glid_nb import _jax
done = []
_jax.once_loaded(lambda: done.append(float(_jax.jnp.ones(()))))
print(done)
double = _jax.jit(lambda x: 2 * x)
print(double(3.0), done)
_jax.once_loaded(lambda: done.append("at once"))
print(done)
"""
    assert run_python(source) == ["[]", "6.0 [1.0]", "[1.0, 'at once']"]


@pytest.mark.slow
def test_what_waits_does_not_wait_for_a_thread_that_imports_jax() -> None:
    source = """
import importlib.abc, sys, threading
from glid_nb import _jax
from glid_nb.energies import AMIPS
within, may_go_on, done = threading.Event(), threading.Event(), []
class Slow(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path, target=None):
        if name == "jax._src":
            within.set()
            may_go_on.wait(20)
sys.meta_path.insert(0, Slow())
thread = threading.Thread(target=lambda: _jax.jax.Array)
thread.start()
within.wait()
_jax.once_loaded(lambda: done.append("done"))
AMIPS()
print(done)
may_go_on.set()
thread.join()
print(done)
"""
    assert run_python(source) == ["[]", "['done']"]


@pytest.mark.slow
def test_what_is_compiled_later_is_still_a_function_of_its_own_name() -> None:
    source = '''
import sys
from glid_nb import _jax
@_jax.jit
def double(x):
    """Twice."""
    return 2 * x
print(double.__name__, double.__doc__, "jax" in sys.modules)
print(double.lower(1.0).compile()(1.0))
'''
    assert run_python(source) == ["double Twice. False", "2.0"]
