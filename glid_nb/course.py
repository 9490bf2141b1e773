"""Checks of the course's exercises: ``with check("exercise 1"): assert ...``."""

import re
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def check(name: str) -> Iterator[None]:
    """Print whether the assertions of a block hold; whatever goes wrong in it ends there.

    >>> with check("exercise 1"):
    ...     assert 1 + 1 == 2
    exercise 1: right
    >>> with check("exercise 2"):
    ...     assert 1 + 1 == 3, "the sum is not 3"
    exercise 2: not yet: the sum is not 3
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
