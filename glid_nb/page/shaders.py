"""Shaders, put together from the files in ``glsl``: for three.js, and for WebGL 2 without it."""

from glid_nb.energies import ENERGIES
from glid_nb.page.files import glsl
from glid_nb.page.shader_map import ShaderMap

# What three.js puts before its shaders.
_WEBGL2_VERTEX = """#version 300 es
#define attribute in
#define varying out
#define IN_BLOCKS
uniform mat4 projectionMatrix;
const mat4 modelViewMatrix = mat4(1.0);
in vec3 position;
"""
_WEBGL2_FRAGMENT = """#version 300 es
#define varying in
#define texture2D texture
#define gl_FragColor shown
precision highp float;
out vec4 shown;
"""


def vertex_shader(name: str, shader_map: ShaderMap | None) -> str:
    """The shader ``name.vert``, which evaluates the map itself.

    Without a ``shader_map`` it takes images and derivatives from the vertex buffers ``image`` and
    ``derivatives``.
    """
    if shader_map is None:
        return glsl("image_buffer.glsl") + glsl(f"{name}.vert")
    return shader_map.defines() + glsl("harmonic.glsl") + glsl(f"{name}.vert")


def fragment_shader(name: str, n_colors: int) -> str:
    """The shader ``name.frag``, whose colour map has ``n_colors`` stops."""
    parts = [f"#define N_COLORS {n_colors}\n", glsl("colors.glsl")]
    if name == "picture":
        parts += [energy_defines(), glsl("energy.glsl")]
    return "".join([*parts, glsl(f"{name}.frag")])


def webgl2_shaders(name: str, shader_map: ShaderMap | None, n_colors: int) -> tuple[str, str]:
    """Both shaders for a page without three.js; a map's arrays come in blocks of uniforms."""
    vertex = _WEBGL2_VERTEX + vertex_shader(name, shader_map)
    return vertex, _WEBGL2_FRAGMENT + fragment_shader(name, n_colors)


def energy_defines() -> str:
    """What stands before ``energy.glsl``: the density of every energy, chosen by its number."""
    known = [energy.shader for energy in ENERGIES.values()]
    choices = [f"energy.x < {i + 0.5} ? ({text}) : " for i, text in enumerate(known) if text]
    return f"#define ENERGY_DENSITY {''.join(choices)}0.0\n"
