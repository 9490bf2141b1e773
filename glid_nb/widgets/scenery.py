"""The scenes of one renderer: that of the edited shape, and those of the shapes around it."""

from collections.abc import Callable, Iterable, Sequence
from typing import Any

from glid_nb._arrays import Array
from glid_nb.geometry import Domain
from glid_nb.harmonic import HarmonicMap
from glid_nb.page import outline_of
from glid_nb.session.scenery import Scenery
from glid_nb.widgets.layers import picture_texture
from glid_nb.widgets.scene import HIGHEST, Drawing, Scene

_FEWEST = 300  # vertices of a small shape beside large ones
_LEVEL = 0.99  # share of a shape's range of heights that it uses, so that it never meets the next
_SUITS = 0.6, 1.6  # a mesh is kept if it has this many times the wanted vertices


class Textures:
    """Pictures as textures. The page gets each one once, as long as something is drawn from it."""

    def __init__(self) -> None:
        self._known: dict[int, tuple[Array, Any]] = {}  # with the picture, so that its id stays

    def of(self, picture: Array) -> Any:
        """The texture of a picture (h, w, 4)."""
        if id(picture) not in self._known:
            self._known[id(picture)] = picture, picture_texture(picture)
        return self._known[id(picture)][1]

    def keep(self, pictures: Iterable[Array]) -> None:
        """Close the textures of all other pictures."""
        kept = {id(picture) for picture in pictures}
        for key in self._known.keys() - kept:
            self._known.pop(key)[1].close()


class Surroundings:
    """The scenes of the shapes around the edited one, by their keys.

    ``new_scene(map, picture, share)`` makes a scene with a share of all vertices, and
    ``suits(scene, share)`` says whether a scene is like one.
    """

    def __init__(
        self,
        new_scene: Callable[[HarmonicMap, Array, float], Scene],
        suits: Callable[[Scene, float], bool],
    ) -> None:
        self._new_scene, self._suits = new_scene, suits
        self.scenery: tuple[Scenery, ...] = ()  # what is shown, the backmost shape first
        self.scenes: dict[str, Scene] = {}  # its scenes, in the same order

    def share(self, domain: Domain, edited: Domain) -> float:
        """The share of all vertices that a shape gets, by its area; 1 for a shape alone."""
        areas = [shape.map.domain.cage.polygon.area for shape in self.scenery]
        return domain.cage.polygon.area / (edited.cage.polygon.area + sum(areas))

    def take(self, domain: Domain, texture: Any) -> Scene | None:
        """The scene of a shape that is edited from now on, with what it has on the page."""
        for key, scene in self.scenes.items():
            if scene.domain is domain and scene.texture is texture:
                return self.scenes.pop(key)
        return None

    def show(self, edited: Scene, spare: list[Scene], textures: Textures) -> list[Scene]:
        """Show the scenery around the scene of the edited shape. Returns the scenes that are no
        longer drawn.

        ``spare`` scenes are used again, such as that of the shape that was edited until now.
        """
        free, self.scenes = [*self.scenes.values(), *spare], {}
        for shape in self.scenery:
            share = self.share(shape.map.domain, edited.domain)
            scene = self._kept(free, shape, textures.of(shape.picture), share)
            if scene is None:
                scene = self._new_scene(shape.map, shape.picture, share)
            self.scenes[shape.key] = scene
        self.move(self.scenery)
        return free

    def _kept(self, free: list[Scene], shape: Scenery, texture: Any, share: float) -> Scene | None:
        """The scene of a shape among free ones, from which it is removed."""
        for i, scene in enumerate(free):
            same = scene.domain is shape.map.domain and scene.texture is texture
            if same and self._suits(scene, share):
                return free.pop(i)
        return None

    def move(self, scenery: Iterable[Scenery]) -> None:
        """Give the scenes of some shapes the maps and the orders of these."""
        for shape in scenery:
            self.scenes[shape.key].show(Drawing(shape.map, order=shape.order))

    def in_order(self, edited: Scene) -> list[Scene]:
        """All scenes, the backmost first."""
        behind = [self.scenes[shape.key] for shape in self.scenery if not shape.above]
        above = [self.scenes[shape.key] for shape in self.scenery if shape.above]
        return [*behind, edited, *above]

    @property
    def outlined(self) -> list[dict[str, Any]]:
        """`Stage.part_shapes`."""
        return [
            {"key": key, "materials": scene.materials, **outlined(scene)}
            for key, scene in self.scenes.items()
        ]

    @property
    def wires(self) -> dict[str, bytes]:
        """`Stage.part_maps`."""
        return {key: wire_of(scene) for key, scene in self.scenes.items()}

    def close(self) -> None:
        """Free the page's resources."""
        for scene in self.scenes.values():
            scene.close()


def stacked_meshes(edited: Scene, scenes: Sequence[Scene]) -> list[Any]:
    """The meshes of scenes, the backmost first, in drawing order.

    Each shape has its own range of heights, so the depth test orders the parts of a shape, and a
    later shape covers the earlier ones wholly. Lines along the boundary are drawn over all shapes.
    """
    pictures, size = [], 1 / len(scenes)
    for i, scene in enumerate(scenes):
        middle = 2 * HIGHEST * ((i + 0.5) * size - 0.5)
        for mesh in scene.picture_meshes:
            _put(mesh, middle, size if size == 1 else _LEVEL * size)
            pictures.append(mesh)
    return [*pictures, *(mesh for mesh in edited.meshes if mesh not in pictures)]


def _put(mesh: Any, height: float, scale: float) -> None:
    """Give a mesh its range of heights. Says nothing to the page if it has it."""
    if tuple(mesh.position)[2] != height:
        mesh.position = (0.0, 0.0, height)
    if tuple(mesh.scale)[2] != scale:
        mesh.scale = (1.0, 1.0, scale)


def suits(scene: Scene, n_vertices: int) -> bool:
    """Whether a scene's mesh is about as fine as wanted."""
    least, most = _SUITS
    return least * n_vertices <= scene.n_vertices <= most * n_vertices


def vertices_of(total: int, share: float) -> int:
    """The number of vertices of a shape with a share of all of them."""
    return total if share == 1 else max(int(total * share), min(total, _FEWEST))


def outlined(scene: Scene) -> dict[str, Any]:
    """The domain of a scene: `Stage.outline`."""
    sizes = {"chain": scene.shader_map.n_chain, "shaderHoles": scene.shader_map.n_holes}
    return {"outline": outline_of(scene.domain), **sizes}


def wire_of(scene: Scene) -> bytes:
    """The map of a scene for the page: `Stage.coefficients`."""
    return scene.shader_map.wire(scene.map) if scene.evaluated_in != "kernel" else b""
