"""Results for other programs: pictures, meshes, drawings, pages and animations.

Pure functions of a picture and a map that return bytes or text; who calls them writes the files.
"""

from glid_nb.export.animation import animation_bytes
from glid_nb.export.cage_svg import cage_svg
from glid_nb.export.mesh import TexturedMesh, mesh_glb, mesh_obj, textured_mesh
from glid_nb.export.page import page_html
from glid_nb.export.picture import picture_png

__all__ = [
    "TexturedMesh",
    "animation_bytes",
    "cage_svg",
    "mesh_glb",
    "mesh_obj",
    "page_html",
    "picture_png",
    "textured_mesh",
]
