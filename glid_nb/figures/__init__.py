"""Figures of maps, proofs and solves: what notebooks draw, and the plots of the editor.

Names are loaded on first use: `glid_nb.figures.style` must not import matplotlib.
"""

import lazy_loader as _lazy

__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
