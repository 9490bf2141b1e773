"""Report the progress of a drawing or an export, and stop it on request."""

from collections.abc import Callable

from glid_nb._errors import InputError

Progress = Callable[[int, int], bool | None]
"""Called with the number of finished parts and the number of all parts. Returning True stops."""


class Stopped(Exception):  # noqa: N818 - not an error
    """The caller's progress function asked to stop."""


def report(progress: Progress | None, done: int, total: int) -> None:
    """Report the progress. Raises Stopped if the progress function returns True."""
    if progress is not None and not callable(progress):
        raise InputError(f"progress is {progress!r:.60}; it must be a function of two numbers")
    if progress is not None and progress(done, total):
        raise Stopped
