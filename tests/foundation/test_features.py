"""A missing feature of the installed libraries is replaced, or named in one sentence."""

from __future__ import annotations

import types
from collections.abc import Iterator
from typing import Any

import jax
import numpy as np
import pytest

from glid_nb import _features, _jax
from glid_nb._errors import IncompatibleVersionsError, InputError


@pytest.fixture(autouse=True)
def asked_anew() -> Iterator[None]:
    """Each test asks the libraries anew, and leaves no answers to the next one."""
    asked = (
        _features.compiler_options,
        _features.lapack_in_place,
        _features.executables,
        _features.x64_context,
    )
    for question in asked:
        question.cache_clear()
    yield
    for question in asked:
        question.cache_clear()


def test_an_option_that_xla_does_not_know_is_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    wanted = {"xla_cpu_no_such_option": True, "xla_cpu_enable_fast_math": False}
    monkeypatch.setattr(_features, "WANTED_OPTIONS", wanted)
    assert _features.compiler_options() == {"xla_cpu_enable_fast_math": False}
    assert _features.unknown_options() == ["xla_cpu_no_such_option"]
    double = _features.solver_jit(lambda x: 2 * x)
    assert double(np.float32(2)) == 4


def test_another_error_of_the_compiler_is_not_taken_for_an_unknown_option(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def fail(*_: Any, **__: Any) -> Any:
        raise RuntimeError("out of memory")

    monkeypatch.setattr(_features, "jax", types.SimpleNamespace(jit=fail))
    monkeypatch.setattr(_features, "WANTED_OPTIONS", {"xla_cpu_enable_fast_math": False})
    with pytest.raises(RuntimeError, match="out of memory"):
        _features.compiler_options()


def test_lapack_is_not_called_in_place_where_jax_calls_it_otherwise(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert _features.lapack_in_place()
    _features.lapack_in_place.cache_clear()
    monkeypatch.setattr(_features, "KNOWN_CALLS", ("@lapack_dpotrf_of_tomorrow",))
    assert not _features.lapack_in_place()


def test_the_scope_of_double_precision_is_found_where_old_and_new_jax_have_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    modules = {"jax": types.SimpleNamespace(), "jax.experimental": types.SimpleNamespace()}
    monkeypatch.setattr(_features, "import_jax", modules.__getitem__)
    modules["jax.experimental"].enable_x64 = lambda enabled: ("old", enabled)
    assert _features.enable_x64() == ("old", True)
    _features.x64_context.cache_clear()
    modules["jax"].enable_x64 = lambda enabled: ("new", enabled)
    assert _features.enable_x64(False) == ("new", False)


def test_what_no_version_may_lack_is_named_with_the_versions(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(_features, "import_jax", lambda _: types.SimpleNamespace())
    with pytest.raises(InputError, match=r"needs jax\.enable_x64\. Installed are jax \d+\.\d+"):
        _features.enable_x64()


def test_an_attribute_that_jax_lacks_is_named_with_the_versions() -> None:
    with pytest.raises(IncompatibleVersionsError, match=rf"jax\.tomorrow.*jax {jax.__version__}"):
        _ = _jax.jax.tomorrow
    assert not hasattr(_jax.jax, "tomorrow")


def test_a_jax_that_cannot_be_imported_is_told_in_one_sentence(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def fail(_: str) -> Any:
        raise RuntimeError("jaxlib version 9 is newer than\nand incompatible with jax version 8")

    monkeypatch.setattr(_jax.importlib, "import_module", fail)
    with pytest.raises(IncompatibleVersionsError) as caught:
        _jax.import_jax("jax.numpy")
    text = str(caught.value)
    assert "jaxlib version 9 is newer than and incompatible with jax version 8" in text
    assert f"jax {jax.__version__}" in text
    assert "pip install" in text
    assert "\n" not in text


def test_a_library_that_is_not_installed_is_called_missing() -> None:
    assert _jax.installed("no-such-library") == "no-such-library missing"


def test_without_a_table_of_processor_features_there_is_still_a_name(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    full = _features.processor.__wrapped__()
    monkeypatch.setattr(_features, "np", types.SimpleNamespace())
    name = _features.processor.__wrapped__()
    assert name
    assert full.startswith(name)
