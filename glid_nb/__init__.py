"""Locally injective image deformation. ``__init__.pyi`` lists the public names.

Names are loaded on first use, so that ``import glid_nb`` is quick and does not import JAX.
"""

import lazy_loader as _lazy

__version__ = "0.1.0"

__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
