"""Errors of tracing and rendering."""

from glid_nb._errors import InputError


class RenderError(InputError):
    """A picture cannot be warped as asked; the message says why."""


class TraceError(InputError):
    """No cage can be traced from a picture with these options; the message says why.

    Attributes
    ----------
    plain
        The message for users of the editor: it names controls rather than options.
    """

    def __init__(self, message: str, plain: str | None = None) -> None:
        super().__init__(message)
        self.plain = message if plain is None else plain
