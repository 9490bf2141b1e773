"""Errors of tracing and rendering."""

from glid_nb._errors import InputError


class RenderError(InputError):
    """A picture cannot be warped as asked; the message says why."""


class TraceError(InputError):
    """No cage can be traced from a picture with these options; the message says why."""
