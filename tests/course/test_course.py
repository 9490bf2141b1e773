"""What a reader sees after running the check of an exercise."""

from __future__ import annotations

import contextlib
import os
import signal
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import glid_nb as glid
from glid_nb import InputError, course
from glid_nb.course import check


def test_an_exercise_whose_assertions_hold_is_right(capsys: pytest.CaptureFixture[str]) -> None:
    with check("exercise 1"):
        assert True
    assert capsys.readouterr().out == "exercise 1: right\n"


def test_a_failed_assertion_says_what_is_missing(capsys: pytest.CaptureFixture[str]) -> None:
    with check("exercise 1"):
        raise AssertionError("the map folds")
    assert capsys.readouterr().out == "exercise 1: not yet: the map folds\n"


def test_an_error_of_the_readers_code_is_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    with check("exercise 2"):
        raise TypeError("a None\nand more")
    expected = "exercise 2: not yet: your code raises TypeError: a None\n"
    assert capsys.readouterr().out == expected


@pytest.mark.parametrize("empty", [None, ...])
def test_a_cell_that_was_not_filled_in_is_called_that(
    empty: Any, capsys: pytest.CaptureFixture[str]
) -> None:
    with check("exercise 2"):
        assert empty - 1.0 < 1e-9
    printed = capsys.readouterr().out
    assert printed.startswith("exercise 2: not yet: the cell still holds None or `...`")


def test_silent_failures_are_not_right(capsys: pytest.CaptureFixture[str]) -> None:
    for failure in (AssertionError(), ValueError()):
        with check("exercise 3"):
            raise failure
    assert capsys.readouterr().out.count("exercise 3: not yet: ") == 2


def test_a_check_ends_when_its_time_is_over(capsys: pytest.CaptureFixture[str]) -> None:
    with check("exercise 1", seconds=0.1):
        while True:
            with contextlib.suppress(Exception):  # the limit is none of the reader's errors
                pass
    expected = "exercise 1: not yet: your code takes longer than 0.1 seconds\n"
    assert capsys.readouterr().out == expected


@pytest.mark.skipif(os.name != "posix", reason="elsewhere only running Python code is interrupted")
def test_a_check_ends_while_the_readers_code_waits(capsys: pytest.CaptureFixture[str]) -> None:
    with check("exercise 1", seconds=0.1):
        threading.Event().wait(60)
    assert "takes longer than 0.1 seconds" in capsys.readouterr().out


def test_the_handler_of_interrupts_is_the_same_after_a_check() -> None:
    before = signal.getsignal(signal.SIGINT)
    with check("exercise 1", seconds=60):
        assert signal.getsignal(signal.SIGINT) is not before
    assert signal.getsignal(signal.SIGINT) is before


def test_outside_the_main_thread_a_check_has_no_limit(capsys: pytest.CaptureFixture[str]) -> None:
    def run() -> None:
        with check("exercise 1", seconds=0):
            assert True

    thread = threading.Thread(target=run)
    thread.start()
    thread.join()
    assert capsys.readouterr().out == "exercise 1: right\n"


def test_a_failed_check_raises_for_nbgrader(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NBGRADER_EXECUTION", "autograde")
    with pytest.raises(AssertionError, match="the map folds"), check("exercise 1"):
        raise AssertionError("the map folds")


def test_answers_in_jax_have_16_digits(capsys: pytest.CaptureFixture[str]) -> None:
    jnp = pytest.importorskip("jax.numpy")
    with check("exercise 1"):
        third = jnp.asarray(1.0) / 3
        assert abs(float(third) - 1 / 3) < 1e-15, "JAX computes with 7 digits"
    assert capsys.readouterr().out == "exercise 1: right\n"


def test_a_call_of_numpy_in_a_function_for_jax_is_named(capsys: pytest.CaptureFixture[str]) -> None:
    jax = pytest.importorskip("jax")
    with check("exercise 2"):
        jax.grad(lambda x: np.sqrt(x))(1.0)
    assert "call jnp and not np in it, such as jnp.sqrt" in capsys.readouterr().out


def test_a_sealed_map_is_evaluated_and_has_no_coefficients() -> None:
    f = glid.HarmonicMap.identity(course.bar())
    sealed = course.Sealed(f)
    points = [[0.5, 0.25]]
    assert np.array_equal(sealed(points), f(points))
    assert np.array_equal(sealed.wirtinger(points), f.wirtinger(points))
    assert not {"phi", "psi"} & set(dir(sealed))
    with pytest.raises(TypeError, match="not Sealed"):
        glid.certify(sealed)  # pyright: ignore[reportArgumentType]


def test_checks_that_are_not_beside_the_notebook_are_missed_in_a_sentence(tmp_path: Path) -> None:
    with pytest.raises(InputError) as refusal:
        course.run_check(tmp_path / "checks" / "07_newton.py", 1, {})
    assert str(refusal.value) == (
        "The folder checks must lie beside this notebook; ask your lecturer, or run make student."
    )


def test_an_interrupt_passes() -> None:
    with pytest.raises(KeyboardInterrupt), check("exercise 1"):
        raise KeyboardInterrupt


def test_nothing_is_said_of_packages_that_are_there(capsys: pytest.CaptureFixture[str]) -> None:
    course.needs("numpy", "jax", without="everything")
    course.needs("numpy")
    assert capsys.readouterr().out == ""
