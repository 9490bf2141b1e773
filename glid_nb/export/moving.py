"""A motion on one mesh: its shape and picture at any time."""

import functools
import itertools
import math
import threading
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from numpy.typing import ArrayLike, NDArray
from PIL import Image

from glid_nb._arguments import check_type
from glid_nb._arrays import Array
from glid_nb._errors import InputError
from glid_nb.export.encode import Frames
from glid_nb.export.parts import named_parts
from glid_nb.export.picture import frame_around
from glid_nb.geometry import Cage
from glid_nb.harmonic import HarmonicMap, images_under
from glid_nb.imaging import DeformedMesh, PixelFrame, as_rgba8, fine_mesh, order_of
from glid_nb.imaging.backdrop import Backdrop, drawn_backdrop, over
from glid_nb.imaging.order import Order, order_at
from glid_nb.imaging.progress import Progress, report
from glid_nb.imaging.render import TOLERANCE_PX, check_fits, draw_mesh
from glid_nb.imaging.texture import Texture, texels_per_pixel
from glid_nb.motion import Motion
from glid_nb.pose import Pose

_MEASURED = 8  # of the motion's knots at most, to find how large the picture appears
_LEAST_SCALE = 1.25  # of a picture that is scaled down before frames are drawn
_VERTICES = 1500  # evenly spread vertices before refinement


def check_picture(size: tuple[int, int], shown: Motion | HarmonicMap) -> None:
    """Raise an InputError if a picture of (w, h) pixels does not fit the motion or map."""
    if isinstance(shown, Motion):
        if shown.image_size not in (None, size):
            w, h = shown.image_size
            what = f"the picture has {size[0]} x {size[1]} pixels, but the motion is of {w} x {h}"
            raise InputError(f"{what}; take the picture that its cage was traced from")
        shown = shown.keyframes[0]
    check_fits(PixelFrame(*size), shown)


@dataclass(frozen=True, eq=False)
class MovingMesh:
    """A triangulated domain with its images at the knots of a motion and heights at the keyframes.

    In between, both change linearly, as in the motion. For a ping-pong, only the way forth is
    stored.
    """

    vertices: Array  # (v, 2), world coordinates
    triangles: NDArray[np.int32]  # (t, 3), counter-clockwise, sorted by height at the start
    times: Array  # (n,) times of the knots, seconds
    images: Array  # (n, v, 2)
    height_times: Array  # (m,) times of the keyframes, and of a loop's return
    heights: Array  # (m, v) heights at these times, or one row for all; see `order_of`

    @classmethod
    def of(
        cls,
        shown: Motion | HarmonicMap,
        pose: Sequence[Pose | Order] | Pose | None,
        n_vertices: int,
        tolerance: float | None = None,
    ) -> Self:
        """A mesh that is fine enough for all maps. Each keyframe's pose, or order, gives the
        heights."""
        check_type(
            "the motion",
            shown,
            Motion | HarmonicMap,
            "pass what to export",
            InputError,
        )
        poses = list(pose) if isinstance(pose, Sequence) else [pose]
        for one in poses:
            if not isinstance(one, Order):
                check_type("a pose", one, Pose | None, "give one for each keyframe", InputError)
        if isinstance(shown, HarmonicMap):
            maps, times, pose_times = (shown,), (0.0,), (0.0,)
        else:
            wanted, given = len(shown.keyframes), len(poses)
            if pose is not None and given != wanted:
                raise InputError(f"there are {wanted} keyframes but {given} poses; give one each")
            pieces, pose_times = shown.pieces_forth, shown.times
            maps = (pieces[0].start_map, *(piece.end_map for piece in pieces))
            times = (pieces[0].start, *(piece.end for piece in pieces))
            poses += poses[: shown.repeat == "loop"]
        cage = shown.domain.cage
        image = functools.partial(images_under, maps)
        vertices, images, triangles = fine_mesh(cage, image, n_vertices, tolerance)
        orders = [_order_of(cage, one) for one in poses]
        if all(order is orders[0] for order in orders):
            del orders[1:]
        heights = np.stack([order(vertices) for order in orders])
        images = np.moveaxis(images.reshape(len(vertices), -1, 2), 1, 0)
        triangles = triangles[np.argsort(heights[0][triangles].mean(axis=1), kind="stable")]
        return cls(vertices, triangles, np.array(times), images, np.array(pose_times), heights)

    def at(self, time: float) -> DeformedMesh:
        """The mesh at a time from the motion's start to its end."""
        time = min(time, 2 * self.times[-1] - time)  # a ping-pong's way back
        images, heights = _between(self.times, self.images, time), self.heights_at(time)
        order = np.argsort(heights[self.triangles].mean(axis=1), kind="stable")
        return DeformedMesh(self.vertices, images, self.triangles[order], heights)

    def heights_at(self, time: float) -> Array:
        """(v,) heights at a time on the way forth."""
        still = len(self.heights) == 1
        return self.heights[0] if still else _between(self.height_times, self.heights, time)


@dataclass(frozen=True, eq=False)
class MovingPart:
    """A shape of an animation: its picture, its motion, and a pose for each keyframe, or how its
    sheets lie there."""

    image: ArrayLike
    motion: Motion
    poses: Sequence[Pose | Order] | None = None
    name: str = ""  # of one of several

    def between(self, start: float, end: float) -> Self:
        """The shape between two times of its motion, see `Motion.part`."""
        motion = self.motion.part(start, end)
        if self.poses is None:
            return replace(self, motion=motion)
        orders = [_order_of(self.motion.domain.cage, one) for one in self.poses]
        poses = [order_at(orders, self.motion.times, time) for time in motion.times]
        return replace(self, motion=motion, poses=poses)


def moving_parts(parts: Iterable[MovingPart]) -> list[MovingPart]:
    """Parts with names of their own that can move together. Raises an InputError for others."""
    named = named_parts(parts, MovingPart)
    for part in named:
        what = f"the motion of {part.name!r:.80}" if part.name else "motion"
        check_type(what, part.motion, Motion, "make one of certified maps", InputError)
    if len({(part.motion.repeat, *part.motion.times) for part in named}) > 1:
        what = "the motions of the parts have different times or repeat differently"
        raise InputError(f"{what}; all share one timeline")
    return named


def _order_of(cage: Cage, pose: Pose | Order | None) -> Order:
    return pose if isinstance(pose, Order) else order_of(cage, pose)


def _between(times: Array, values: Array, time: float) -> Array:
    """Interpolate values (n, ...), given at times, linearly at one time."""
    i = int(np.clip(np.searchsorted(times, time, side="right") - 1, 0, len(times) - 2))
    share = (time - times[i]) / (times[i + 1] - times[i])
    return (1 - share) * values[i] + share * values[i + 1]


def frames(
    parts: Sequence[MovingPart],
    size: int,
    fps: float,
    background: Backdrop,
    progress: Progress | None = None,
) -> Frames:
    """Pictures at even times. All show the same part of the plane.

    It contains all shapes, or it is the rectangle of a picture that is the background. The motions
    of all parts have the same times; later parts cover earlier ones.
    """
    times = parts[0].motion.frame_times(fps)
    report(progress, 0, len(times))
    corners = [images_under(p.motion.keyframes, p.motion.domain.cage.exterior) for p in parts]
    extent = np.ptp(np.concatenate([each.reshape(-1, 2) for each in corners]), axis=0)
    tolerance = TOLERANCE_PX * float(extent.max()) / size
    meshes = [MovingMesh.of(p.motion, p.poses, _VERTICES, tolerance) for p in parts]
    places = np.concatenate([mesh.images.reshape(-1, 2) for mesh in meshes])
    frame = frame_around(places, size, background)
    behind = drawn_backdrop(background, frame)
    pairs = zip(parts, meshes, strict=True)
    drawn = [(_scaled(as_rgba8(part.image), mesh, frame), mesh) for part, mesh in pairs]
    done, one_at_a_time = itertools.count(1), threading.Lock()

    def draw(number: int) -> NDArray[np.uint8]:
        pixels = behind
        for texture, mesh in drawn:
            pixels = over(draw_mesh(texture, mesh.at(float(times[number])), frame), pixels)
        assert pixels is not None
        with one_at_a_time:
            report(progress, next(done), len(times))
        return pixels

    return Frames((frame.width, frame.height), len(times), draw)


def _scaled(image: NDArray[np.uint8], mesh: MovingMesh, frame: PixelFrame) -> Texture:
    """The picture as a texture with about a texel for each pixel of the frames.

    `Sampler` averages several texels for each pixel, for every frame. It is quicker to scale the
    picture down once, as far as no frame shows it magnified.
    """
    source = PixelFrame(*image.shape[1::-1])
    places, scales = source.to_pixel(mesh.vertices)[mesh.triangles], []
    for images in mesh.images[:: math.ceil(len(mesh.images) / _MEASURED)]:
        scales.append(texels_per_pixel(frame.to_pixel(images)[mesh.triangles], places))
    if (scale := min(scales)) < _LEAST_SCALE:
        return Texture.from_image(image)
    size = round(source.width / scale), round(source.height / scale)
    small = Image.fromarray(image).convert("RGBa").resize(size, Image.Resampling.HAMMING)
    return Texture.from_image(np.asarray(small.convert("RGBA")))
