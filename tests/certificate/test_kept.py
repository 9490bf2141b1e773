"""What proofs keep of a domain changes no bit of a certificate, and takes little memory."""

from __future__ import annotations

import threading
import weakref
from collections.abc import Iterator
from dataclasses import fields
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from glid_nb._runtime import CHUNK_ELEMENTS
from glid_nb.certificate import PROOFS, Certificate, certify, certify_step, kept
from glid_nb.geometry import Domain, Panels, graded_panels
from glid_nb.harmonic import HarmonicMap, basis_of

from ..support.domains import NAMES, domain, random_map

pytestmark = pytest.mark.slow


@pytest.fixture(autouse=True)
def _nothing_kept() -> Iterator[None]:
    kept.forget()
    yield
    kept.forget()


def bits(certificate: Certificate) -> list[Any]:
    """All that a certificate says, to the last bit."""
    alone = [getattr(certificate, one.name) for one in fields(certificate)]
    plain = [repr(value) for value in alone if not isinstance(value, Panels | HarmonicMap)]
    panels = certificate.panels
    return plain + [getattr(panels, one.name).tobytes() for one in fields(panels)]


def fresh(map: HarmonicMap, kind: Any) -> list[Any]:
    """A certificate for which nothing was kept."""
    kept.forget()
    return bits(certify(map, kind))


@settings(max_examples=20, deadline=None)
@given(
    st.lists(
        st.tuples(
            st.sampled_from(NAMES),
            st.sampled_from([0.0, 0.01, 0.05, 0.3]),
            st.integers(0, 3),
            st.sampled_from(list(PROOFS)),
        ),
        min_size=2,
        max_size=6,
    )
)
def test_certificates_are_the_same_whatever_was_proved_before(given: list[Any]) -> None:
    cases = [(random_map(name, size, seed), kind) for name, size, seed, kind in given]
    alone = [fresh(map, kind) for map, kind in cases]
    kept.forget()
    for _ in range(2):
        assert [bits(certify(map, kind)) for map, kind in cases] == alone


def test_steps_are_proved_the_same() -> None:
    a, b = (random_map("ring", 0.02, seed) for seed in (1, 2))
    kept.forget()
    alone = certify_step(a, b)
    again = certify_step(a, b)
    assert repr(again) == repr(alone)


def test_panels_of_the_caller_are_not_taken_for_others() -> None:
    map = random_map("ell", 0.01, 1)
    coarse = graded_panels(map.domain)
    fine, _ = coarse.split(np.arange(len(coarse)) % 2 == 0)
    for panels in (fine, coarse, fine):
        warm = bits(certify(map, panels=panels, split=False))
        kept.forget()
        assert warm == bits(certify(map, panels=panels, split=False))


def rows_of(one: Domain, shift: float = 0, kind: str = "hermite") -> kept.PanelRows:
    """The rows of as many panels as one chunk has."""
    count = CHUNK_ELEMENTS // basis_of(one).n_columns
    start = np.resize(graded_panels(one).start, count) + shift
    end = np.resize(graded_panels(one).end, count) + shift
    return kept.panel_rows(start, end, basis_of(one).singularities, PROOFS[kind])


def test_equal_domains_share_what_is_kept() -> None:
    one = domain("twin")
    same = Domain(one.cage, one.offset_cage, one.hole_points)
    assert same is not one
    assert rows_of(one) is rows_of(same)
    assert rows_of(one, kind="lipschitz") is not rows_of(one)
    with pytest.raises(ValueError, match="read-only"):
        rows_of(one).beside[0] = 0


def test_only_the_latest_are_kept() -> None:
    first = weakref.ref(rows_of(domain("ell")).beside)
    for i in range(1, 40):
        rows_of(domain("ell"), 1e-3 * i)
        assert i > 20 or first() is not None
    assert first() is None


@pytest.mark.parametrize("kind", list(PROOFS))
def test_a_chunk_takes_few_megabytes(kind: str) -> None:
    for name in NAMES:
        rows = rows_of(domain(name), kind=kind)
        size = sum(array.nbytes for array in (*rows.ends, *rows.proof, rows.beside))
        assert size < 4.3e6


def test_threads_agree() -> None:
    maps = [random_map(name, 0.01, 1) for name in NAMES for _ in range(2)]
    alone = [fresh(map, "hermite") for map in maps]
    kept.forget()
    together, found = threading.Barrier(len(maps)), dict[int, Any]()

    def prove(i: int) -> None:
        together.wait()
        found[i] = bits(certify(maps[i]))

    threads = [threading.Thread(target=prove, args=(i,)) for i in range(len(maps))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert [found[i] for i in range(len(maps))] == alone
