"""Results for other programs: pictures, meshes, drawings, pages and animations.

Pure functions of a picture and a map or a motion that return bytes or text; writing files is the
caller's job, but for `animate`.
"""

from glid_nb.export.cage_svg import cage_svg as cage_svg
from glid_nb.export.mesh import mesh_glb as mesh_glb
from glid_nb.export.mesh import mesh_obj as mesh_obj
from glid_nb.export.mesh import motion_glb as motion_glb
from glid_nb.export.mesh import textured_mesh as textured_mesh
from glid_nb.export.motion import MOTION_FORMATS as MOTION_FORMATS
from glid_nb.export.motion import animate as animate
from glid_nb.export.motion import motion_file_names as motion_file_names
from glid_nb.export.motion import motion_files as motion_files
from glid_nb.export.motion import suffix_of as suffix_of
from glid_nb.export.page import page_html as page_html
from glid_nb.export.picture import animation_bytes as animation_bytes
from glid_nb.export.picture import picture_png as picture_png
