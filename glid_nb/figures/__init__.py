"""Figures of maps, proofs and solves for notebooks, and the plots of the editor."""

import lazy_loader as _lazy

# Load submodules on first use, so that `glid_nb.figures.style` does not import matplotlib.
__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
