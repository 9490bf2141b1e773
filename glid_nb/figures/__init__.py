"""Figures of results: the overview, and the plots that it shares with the editor.

Names are loaded on first use: `glid_nb.figures.style` must not import matplotlib.
"""

import lazy_loader as _lazy

__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
