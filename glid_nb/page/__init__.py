"""What runs in the browser: JavaScript, style sheets, shaders, and a map as shaders take it."""

from glid_nb.page.files import bundle, glsl, stylesheet, template
from glid_nb.page.shader_map import ShaderMap
from glid_nb.page.shaders import energy_defines, fragment_shader, vertex_shader, webgl2_shaders
