"""Results for other programs: pictures, meshes, drawings, pages and animations.

These are pure functions of a picture and a map or a motion. They return bytes or text, and the
caller writes the files; only `animate` writes files itself. Names are loaded on first use, so that
importing the table of formats loads nothing else.
"""

import lazy_loader as _lazy

__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
