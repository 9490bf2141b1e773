"""Results for other programs: pictures, meshes, drawings, pages and animations.

Pure functions of a picture and a map or a motion that return bytes or text; writing files is the
caller's job, but for `animate`. Names are loaded on first use: the table of formats needs no more.
"""

import lazy_loader as _lazy

__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
