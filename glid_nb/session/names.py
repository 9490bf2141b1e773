"""Names of the parts of a session: none is longer than a session file allows, and all differ."""

import itertools
from collections.abc import Collection

LONGEST_NAME = 200  # characters


def free_name(name: str, taken: Collection[str]) -> str:
    """The name, cut to what a part may have, and with a number if it is taken."""
    name = name.strip()[:LONGEST_NAME].rstrip()
    if name and name not in taken:
        return name
    stem = name.rstrip("0123456789").rstrip() or "Part"
    numbered = (f"{stem[: LONGEST_NAME - 10].rstrip()} {i}" for i in itertools.count(2))
    return next(candidate for candidate in numbered if candidate not in taken)
