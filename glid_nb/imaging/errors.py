"""The error of everything between a picture and a cage."""

from glid_nb._errors import InputError


class RenderError(InputError):
    """A picture cannot be warped as asked."""


class TraceError(InputError):
    """A picture, or a choice of options, that no cage can be traced from; the message says why.

    Attributes
    ----------
    plain
        The message for who traces with the hand: it names controls rather than options.
    """

    def __init__(self, message: str, plain: str | None = None) -> None:
        super().__init__(message)
        self.plain = message if plain is None else plain
