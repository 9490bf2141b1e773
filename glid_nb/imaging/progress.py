"""How far a drawing or an export is, and its end where the caller wants no more."""

from collections.abc import Callable

from glid_nb._errors import InputError

Progress = Callable[[int, int], bool | None]
"""Called with the numbers of finished and of all parts; True ends the work."""


class Stopped(Exception):  # noqa: N818 - not an error
    """The caller's progress function wants no result."""


def report(progress: Progress | None, done: int, total: int) -> None:
    """Tell how far the work is; Stopped where it is to go no further."""
    if progress is not None and not callable(progress):
        raise InputError(f"progress is {progress!r:.60}; it must be a function of two numbers")
    if progress is not None and progress(done, total):
        raise Stopped
