"""The notebook's user interface: thin views over plain models; the browser is known only here."""

from glid_nb.widgets.tracer import CageTracer

__all__ = ["CageTracer"]
