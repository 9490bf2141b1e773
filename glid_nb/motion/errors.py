"""The error of motions."""

from glid_nb._errors import InputError


class MotionError(InputError):
    """Keyframes, times or settings that make no motion, or a file of one that is not valid."""
