"""The error of everything between a picture and a cage."""


class RenderError(ValueError):
    """A picture cannot be warped as asked."""


class TraceError(ValueError):
    """A picture, or a choice of options, that no cage can be traced from; the message says why."""
