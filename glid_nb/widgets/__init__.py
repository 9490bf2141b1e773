"""The notebook's user interface; the browser is known only here."""

from glid_nb.widgets.canvas import DeformCanvas

__all__ = ["DeformCanvas"]
