"""Problems, poses, reports and documents; the models behind the user interface.

``__init__.pyi`` lists the two models that users hold, which are loaded on first use.
"""

import lazy_loader as _lazy

__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
