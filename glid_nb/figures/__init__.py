"""Figures of results: the overview, and the plots it and the editor are made of.

Names are loaded on first use: the editor takes its colours from `glid_nb.figures.style` long before
anything needs matplotlib.
"""

import lazy_loader as _lazy

__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
