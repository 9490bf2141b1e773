"""Helpers of the course: checks of exercises, and domains.

An exercise is checked by ``with check("exercise 1"): assert ...``.
"""

import importlib.util
import re
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from glid_nb._errors import InputError
from glid_nb.geometry import Cage, Domain, as_points
from glid_nb.geometry._loops import subdivided

# Names of distributions that differ from the imported name.
_DISTRIBUTIONS = {"igl": "libigl", "glid_check": "glid-check"}


class MissingPackageError(InputError):
    """A chapter cannot run without a package that is not installed."""


def needs(*packages: str, without: str | None = None) -> None:
    """Print a sentence that names the packages (by their import names) that are not installed.

    ``without`` names the parts that the chapter then leaves out. If the chapter cannot run without
    the packages, leave ``without`` out; then a :class:`MissingPackageError` is raised.
    """
    missing = [name for name in packages if importlib.util.find_spec(name) is None]
    if not missing:
        return
    names = " and ".join(_DISTRIBUTIONS.get(name, name) for name in missing)
    which = f"{names}, which {'is' if len(missing) == 1 else 'are'} not installed"
    remedy = "pip install 'glid-nb[course]', and restart the kernel"
    if without is None:
        raise MissingPackageError(f"this chapter needs {which}; run: {remedy}")
    print(f"Without {which}, this chapter leaves out {without}. To see it, run: {remedy}.")


@contextmanager
def check(name: str) -> Iterator[None]:
    """Print whether the assertions of a block hold. All exceptions in the block are caught.

    >>> with check("exercise 1"):
    ...     assert 1 + 1 == 3, "the sum is not 3"
    exercise 1: not yet: the sum is not 3
    """
    try:
        yield
    except AssertionError as failed:
        print(f"{name}: not yet: {failed or 'an assertion does not hold'}")
    except Exception as failed:  # the reader's own code may raise anything
        lines = str(failed).splitlines() or ["no message"]
        raised = f"your code raises {type(failed).__name__}: {lines[0]}"
        if isinstance(failed, TypeError) and re.search("NoneType|ellipsis", lines[0]):
            raised = f"the cell still holds None or `...`, or returns nothing ({raised})"
        print(f"{name}: not yet: {raised}")
    else:
        print(f"{name}: right")


def bar() -> Domain:
    """The bar of chapters 08 to 12, 8 by 2, with 40 vertices on its offset cage."""
    outer = np.array([-4.15 - 1.15j, 4.15 - 1.15j, 4.15 + 1.15j, -4.15 + 1.15j])
    offset = as_points(subdivided(outer, np.array([16, 4, 16, 4])))
    return Domain(Cage([[-4, -1], [4, -1], [4, 1], [-4, 1]]), Cage(offset))


def ring() -> Domain:
    """The ring of chapters 09 and 12, with 24 vertices on each loop of its cages."""
    turn = np.exp(2j * np.pi * np.arange(24) / 24)
    outer, inner, *offset = (as_points(radius * turn) for radius in (3, 1.2, 3.45, 0.84))
    return Domain(Cage(outer, [inner]), Cage(offset[0], offset[1:]), [[0.1, 0.0]])
