"""What runs in the browser: JavaScript, style sheets and shaders, and what they take."""

from glid_nb.page.files import bundle, glsl, stylesheet, template
from glid_nb.page.problem import coefficients_of, outline_of, pins_of
from glid_nb.page.shader_map import ShaderMap
from glid_nb.page.shaders import energy_defines, fragment_shader, vertex_shader, webgl2_shaders
