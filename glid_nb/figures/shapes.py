"""Figures of maps on the shapes: distortion, pictures, basis functions, panels."""

from collections.abc import Iterable, Sequence
from typing import Any, Literal, NamedTuple, Self

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import LogNorm, Normalize, to_rgba_array
from matplotlib.tri import Triangulation as Triangles
from numpy.typing import ArrayLike, NDArray

from glid_nb._arrays import Floats
from glid_nb._runtime import double_precision
from glid_nb.certificate import Certificate
from glid_nb.energies import Energy, SymmetricDirichlet, isometry_energy
from glid_nb.figures import drawing, style
from glid_nb.figures.drawing import NotebookFigure
from glid_nb.figures.plots import CertificatePlot
from glid_nb.figures.style import BLUE, GREEN, GREY, INK, VERMILION, distortion_colors
from glid_nb.geometry import Domain, MeshMap, as_points, triangulate
from glid_nb.harmonic import HarmonicMap
from glid_nb.imaging import DeformedMesh, PixelFrame, deformed_loops, deformed_mesh
from glid_nb.imaging.rasterise import render_mesh
from glid_nb.imaging.texture import Texture
from glid_nb.methods.mesh.operators import MeshOperators
from glid_nb.pose import Pose
from glid_nb.solvers import Sensitivity

Quantity = Literal["sigma1", "sigma2", "k", "energy", "distortion"]
AnyMap = HarmonicMap | MeshMap
Maps = AnyMap | Sequence[AnyMap]

_LABELS = {"sigma1": "σ₁", "sigma2": "σ₂", "k": r"$k = |f_{\overline{z}}| / |f_z|$"}
_LABELS |= {"energy": "energy density", "distortion": "max(σ₁, 1/σ₂)"}
_VERTICES = 3000
_PIXELS = 600  # of the longer side of one drawn picture
_WIDTH, _WIDTH_OF_ONE, _TALLEST = 7.4, 4.6, 3.8  # inches
_ABREAST = 4
_CHECKS = 24  # along the longer side of a shape
# Folds get rings if they have fewer triangles than _FEW, or together span less than _SMALL of the
# axes' size.
_FEW, _SMALL = 5, 0.03
# Face, edge, edge width and hatch of folds, drawn on each other. Colour-blind people see them too.
_FOLDED = ("none", "white", 2.8, ""), ("none", INK, 1.5, "")
_FOLDED += (VERMILION, "face", 0.5, ""), ("none", INK, 0.0, "/////")
# Roots of the arrows of a field, the longest arrow as a share of the shape, and their look.
_ARROWS, _ARROW = 60, 0.08
_QUIVER: dict[str, Any] = {"angles": "xy", "scale_units": "xy", "scale": 1, "width": 0.004}
_MANY = 400  # with more panels than this, the dots at their ends would hide the colours


class DrawnMap(NamedTuple):
    """A map as triangles, with (t,) |f_z| and |f_zbar| on each triangle."""

    mesh: DeformedMesh
    abs_fz: Floats
    abs_fzb: Floats
    outline: list[Floats]
    counted: bool

    @classmethod
    def of(
        cls, map: AnyMap, pose: Pose | None = None, count: int = _VERTICES, tolerance: float = 0.03
    ) -> Self:
        """The triangles of a map. For a harmonic map there are ``count`` vertices, or more to stay
        within ``tolerance``."""
        if isinstance(map, HarmonicMap):
            mesh = deformed_mesh(map, count, tolerance, pose)
            middles = map.wirtinger(mesh.vertices[mesh.triangles].mean(axis=1))
            corners = [w[mesh.triangles.T] for w in map.wirtinger(mesh.vertices)]
            # A fold begins on the boundary, so corners show it earlier than middles.
            fz, fzb = np.abs([np.vstack(w) for w in zip(middles, corners, strict=True)])
            at = np.where((fz > fzb).all(axis=0), 0, (fz - fzb).argmin(axis=0))[None]
            fz, fzb = (np.take_along_axis(w, at, axis=0)[0] for w in (fz, fzb))
            return cls(mesh, fz, fzb, deformed_loops(map, 0.01), False)
        mesh = map.triangulation
        order = np.argsort(mesh.vertices[mesh.triangles, 0].mean(axis=1), kind="stable")
        w = map.images @ np.array([1, 1j])
        fz, fzb = (np.abs(v)[order] for v in MeshOperators(mesh).wirtinger(w))
        drawn = DeformedMesh(mesh.vertices, map.images, mesh.triangles[order], mesh.vertices[:, 0])
        return cls(drawn, fz, fzb, [map.images[loop] for loop in mesh.border], True)

    @property
    def folded(self) -> NDArray[np.bool_]:
        """(t,) bool: the triangles that the map flips."""
        return ~(self.abs_fz > self.abs_fzb)

    @double_precision
    def values(self, quantity: Quantity | Energy) -> Floats:
        """(t,) values; an energy is infinite where the map folds."""
        sigma1, sigma2 = self.abs_fz + self.abs_fzb, self.abs_fz - self.abs_fzb
        known = {"sigma1": sigma1, "sigma2": sigma2}
        known["k"] = self.abs_fzb / np.maximum(self.abs_fz, 1e-300)
        known["distortion"] = np.maximum(sigma1, 1 / np.maximum(sigma2, 1e-300))
        if isinstance(quantity, str) and quantity in known:
            return known[quantity]
        energy = SymmetricDirichlet() if quantity == "energy" else quantity
        if not isinstance(energy, Energy):
            raise ValueError(f"unknown quantity {quantity!r}; choose one of {', '.join(_LABELS)}")
        xy: Any = np.where(self.folded, [[1], [0]], [self.abs_fz**2, self.abs_fzb**2])
        return np.where(self.folded, np.inf, np.asarray(energy.density(*xy)))


def distortion(
    maps: Maps,
    quantity: Quantity | Energy = "sigma1",
    pose: Pose | None = None,
    *,
    titles: Sequence[str] = (),
) -> NotebookFigure:
    """Fields of distortion on the deformed shapes, side by side, with one scale of colours.

    ``maps`` is one or several maps, HarmonicMap or MeshMap. ``titles`` has one title for each map.
    Dark parts are distorted. Folded parts are hatched in vermilion, and the title says so. Rings
    mark few or tiny folds. The targets of a pose are cyan, the handles' images black. The quantity
    is "sigma1", "sigma2" (Equation (2)), "k" (the little dilatation), "distortion" (max(sigma_1,
    1 / sigma_2)), "energy" (the symmetric Dirichlet density), or the density of a given Energy.
    """
    maps, sheets = _listed(maps, pose)
    figure, grid = _side_by_side(maps, sheets, pose, titles, 0.55)
    draw_distortion(grid, sheets, quantity, shrink=0.5, aspect=36)
    figure.draw_without_rendering()  # a second layout, at drawing, settles the titles
    return figure


def draw_distortion(
    grid: Sequence[Axes], sheets: Sequence[DrawnMap], quantity: Quantity | Energy, **bar: Any
) -> None:
    """Draw a quantity on each sheet in its axes, with one scale and a colour bar below."""
    values = [sheet.values(quantity) for sheet in sheets]
    known = np.concatenate([v[~s.folded] for v, s in zip(values, sheets, strict=True)])
    known = known if len(known) else np.ones(1)  # a map that folds everywhere
    norm, colors = _scale(quantity, known)
    look: Any = {"norm": norm, "cmap": colors, "edgecolors": "face", "linewidth": 0.2}
    for axes, sheet, field in zip(grid, sheets, values, strict=True):
        shape = Triangles(*sheet.mesh.images.T, triangles=sheet.mesh.triangles)
        field = np.clip(field, norm.vmin, norm.vmax)
        drawn = axes.tripcolor(shape, facecolors=field, rasterized=True, zorder=0, **look)
        drawing.loops(axes, sheet.outline, color=INK, linewidth=0.4)
    below, above = known.min() < 0.98 * norm.vmin, known.max() > 1.02 * norm.vmax
    ends = ("both" if above else "min") if below else ("max" if above else "neither")
    label = _LABELS[quantity] if isinstance(quantity, str) else quantity.label
    ticks = drawing.log_ticks(*drawn.get_clim()) if isinstance(norm, LogNorm) else None
    drawing.color_bar(grid, drawn, label, format="{x:g}", extend=ends, ticks=ticks, **bar)


def sensitivity(
    sensitivities: Sensitivity | Sequence[Sensitivity], *, titles: Sequence[str] = ()
) -> NotebookFigure:
    """How maps move, side by side: derivatives, as those of :meth:`Result.sensitivity`.

    Colours show :meth:`Sensitivity.speed`, how far a point moves at most for each unit of change.
    Arrows show the fields, the first one blue, the second one green. ``titles`` has one title for
    each.
    """
    listed = [sensitivities] if isinstance(sensitivities, Sensitivity) else [*sensitivities]
    for one in listed:
        if not isinstance(one, Sensitivity):
            raise TypeError(f"{type(one).__name__} is no sensitivity; see result.sensitivity")
    maps, sheets = _listed([one.map for one in listed], None)
    figure, grid = _side_by_side(maps, sheets, None, titles, 0.55)
    speeds = [one.speed(sheet.mesh.vertices) for one, sheet in zip(listed, sheets, strict=True)]
    most = max(1e-12, *(float(np.quantile(speed, 0.99)) for speed in speeds))
    for axes, one, sheet, speed in zip(grid, listed, sheets, speeds, strict=True):
        shape = Triangles(*sheet.mesh.images.T, triangles=sheet.mesh.triangles)
        look: Any = {"norm": Normalize(0, most), "cmap": distortion_colors()}
        drawn = axes.tripcolor(shape, speed, shading="gouraud", rasterized=True, zorder=0, **look)
        drawing.loops(axes, sheet.outline, color=INK, linewidth=0.4)
        roots = triangulate(one.map.domain.cage, _ARROWS).vertices
        longest = np.ptp(sheet.mesh.images, axis=0).max() * _ARROW
        for field, color in zip(one.fields, (BLUE, GREEN), strict=False):
            arrows = field(roots) * longest / most
            axes.quiver(*one.map(roots).T, *arrows.T, color=color, **_QUIVER)
    label = "world units for each unit of change"
    drawing.color_bar(grid, drawn, label, format="{x:g}", extend="max", shrink=0.5, aspect=36)
    figure.draw_without_rendering()  # as above
    return figure


def picture(
    image: ArrayLike | None,
    maps: Maps,
    pose: Pose | None = None,
    *,
    titles: Sequence[str] = (),
    cages: bool = False,
    numbers: bool = False,
) -> NotebookFigure:
    """A picture under each map, side by side. Maps, pose, titles and folds are as in `distortion`.

    The image is the one from which the cage was traced, or None for a chequered one. ``cages``
    draws a map's undeformed cage (solid) and offset cage (dotted). ``numbers`` draws the targets'
    numbers instead of dots.
    """
    maps, sheets = _listed(maps, pose)
    figure, grid = _side_by_side(maps, sheets, None if numbers else pose, titles, 0.05)
    for axes, map, sheet in zip(grid, maps, sheets, strict=True):
        draw_deformed(axes, image, sheet, _PIXELS)
        if image is None:  # its pale checks would not show where the shape ends
            drawing.loops(axes, sheet.outline, color=INK, linewidth=0.4)
        if cages and isinstance(map, HarmonicMap):
            drawing.loops(axes, map.domain.cage.loops, color=BLUE, linewidth=1.2)
            drawing.loops(axes, map.domain.offset_cage.loops, color=INK, linestyle=":")
        for i, (x, y) in enumerate(pose.targets if numbers and pose is not None else ()):
            around = {"boxstyle": "circle", "facecolor": "white", "edgecolor": INK}
            axes.text(x, y, str(i), ha="center", va="center", fontsize=style.SMALL, bbox=around)
    figure.draw_without_rendering()  # as above
    return figure


def boundary(maps: Maps, *, titles: Sequence[str] = ()) -> NotebookFigure:
    """The image of the boundary under harmonic maps: the exterior solid, holes dashed."""
    figure, grid = _side_by_side(*(listed := _listed(maps, None)), None, titles, 0.05)
    for axes, sheet in zip(grid, listed[1], strict=True):
        drawing.loops(axes, sheet.outline[:1], color=BLUE)
        drawing.loops(axes, sheet.outline[1:], color=BLUE, linestyle="--")
    return figure


def draw_deformed(axes: Axes, image: ArrayLike | None, sheet: DrawnMap, pixels: float) -> None:
    """Draw a deformed picture in axes whose limits are set. Its longer side has ``pixels``."""
    view = np.transpose([axes.get_xlim(), axes.get_ylim()])
    sides = np.ptp(view, axis=0)
    width, height = (pixels * sides / sides.max()).round().astype(int).clip(1).tolist()
    frame = PixelFrame(width, height).showing(view)
    texture, places = _texture(image, sheet.mesh.vertices)
    positions, size = frame.to_pixel(sheet.mesh.images), (width, height)
    drawn = render_mesh(texture, places, positions, sheet.mesh.triangles, size, sheet.mesh.heights)
    drawing.picture(axes, drawn, frame)
    axes.set(xlim=view[:, 0], ylim=view[:, 1])


def basis(domain: Domain, j: int, part: Literal["re", "im", "abs"] = "re") -> NotebookFigure:
    """One basis function inside the offset cage, and the cage on which maps are certified.

    ``j`` is the column of the basis. The first columns are the Cauchy coordinates C_j (Equation
    (8)) of the offset cage's vertices, counted loop by loop from 0. Then follows ln|z - rho| of
    each hole. The part is "re", "im" or "abs". Dots mark the vertices, where the basis is singular,
    and crosses the hole points. The mark of j is green.
    """
    n, n_vertices = domain.n_coefficients, domain.n_coefficients - domain.n_holes
    if not 0 <= j < n:
        raise ValueError(f"j is {j}; the domain has {n} basis functions, from 0 to {n - 1}")
    mesh, unit = triangulate(domain.offset_cage, 2 * _VERTICES), np.eye(n)[j]
    points = mesh.vertices.copy()
    # Evaluate a little inside the offset cage, because the function is singular at its vertices.
    middles = np.repeat(mesh.vertices[mesh.triangles].mean(axis=1), 3, axis=0)
    points[mesh.triangles.ravel()] = 0.999 * mesh.vertices[mesh.triangles.ravel()] + 0.001 * middles
    is_log = j >= n_vertices  # phi and psi each have half of a logarithm's coefficient
    map = HarmonicMap(domain, unit / 2, unit / 2) if is_log else HarmonicMap(domain, unit, 0 * unit)
    re, im = map(points).T
    values = {"re": re, "im": im, "abs": np.hypot(re, im)}[part]
    least, most, signed = values.min(), values.max(), values.min() < 0
    size = max(-least, most) or 1.0
    figure, (axes,) = _shape_axes(1, drawing.box_around(domain.offset_cage.exterior, 0.04))
    shape: Any = Triangles(*mesh.vertices.T, triangles=mesh.triangles)
    norm = Normalize(-size, size) if signed else Normalize(least, most)
    look: Any = {"cmap": "PuOr_r" if signed else distortion_colors(), "norm": norm, "zorder": 0}
    drawn = axes.tripcolor(shape, values, shading="gouraud", rasterized=True, **look)
    lines = axes.tricontour(shape, values, 14, colors=INK, linewidths=0.4)
    drawing.label_levels(axes, lines, {level: f"{level:g}" for level in [*lines.levels][::2]})
    drawing.loops(axes, domain.offset_cage.loops, color=GREY, linewidth=0.7, label="offset cage")
    drawing.loops(axes, domain.cage.loops, color=BLUE, linewidth=1.0, label="cage")
    singular = np.concatenate([*domain.offset_cage.loops, domain.hole_points])
    drawing.dots(axes, singular[:n_vertices], GREY, 3.2, edge=0.4, label="singularities")
    axes.plot(*singular[n_vertices:].T, "x", color=INK, markersize=4, zorder=4)
    axes.plot(*singular[j], "X" if is_log else "o", color=GREEN, markersize=7, zorder=5)
    figure.legend(loc="outside lower center", ncols=3, **style.LEGEND)
    name = "ln|z − ρ|" if is_log else f"$C_{{{j}}}(z)$"
    parts = {"re": "" if is_log else "Re ", "im": "Im ", "abs": "modulus of "}
    label = parts[part] + name
    drawing.color_bar(axes, drawn, label).set_xlim(least, most)
    return figure


def panels(certificate: Certificate) -> NotebookFigure:
    """The boundary's panels with the proved bound of each: on the shape, and along arc length.

    A panel is dark if the certified lower bound of sigma_2 is small, and vermilion if nothing is
    proved. Up to 400 panels have dots at their ends. The plot shows the bounds and the sampled
    sigma_2.
    """
    proved, cage = certificate.panels, certificate.map.domain.cage
    bound = np.nan_to_num(proved.sigma2_lower, nan=-1.0)
    figure = NotebookFigure(_WIDTH, 3.4)
    axes, plot = figure.subplots(1, 2, width_ratios=[1, 1.15])
    figure.get_layout_engine().set(wspace=0.08)  # type: ignore[union-attr]
    hold(axes, drawing.box_around(cage.exterior, 0.04))
    start, end = as_points(proved.start), as_points(proved.end)
    colors = distortion_colors().reversed().with_extremes(under=VERMILION)
    look: Any = {"cmap": colors, "norm": Normalize(1e-300, style.FULL_MARGIN), "linewidths": 3}
    lines = LineCollection([*np.stack([start, end], axis=1)], array=bound, **look)
    axes.add_collection(lines)
    if len(bound) <= _MANY:
        axes.plot(*start.T, "o", color=INK, markersize=1.4, zorder=3)
    drawing.color_bar(axes, lines, "certified lower bound of σ₂", extend="max", format="{x:g}")
    title = f"{len(bound)} panels, {int((bound <= 0).sum())} of them not proved"
    axes.set_title(title, fontsize=style.FONT_SIZE, color=INK)
    plot.set_title(" \n ", fontsize=style.FONT_SIZE)  # room for the legend
    figure.draw_without_rendering()  # lays out the axes
    CertificatePlot(plot, cage).update(certificate, certificate.map)
    return figure


def _listed(maps: Any, pose: Pose | None) -> tuple[list[AnyMap], list[DrawnMap]]:
    found = [*maps] if isinstance(maps, Iterable) else [maps]
    for map in found:
        if not isinstance(map, HarmonicMap | MeshMap):
            raise TypeError(f"{type(map).__name__} is not a map; a result's map is result.map")
    if not found:
        raise ValueError("there is no map to draw")
    return found, [DrawnMap.of(map, pose) for map in found]


def _scale(quantity: Quantity | Energy, known: Floats) -> tuple[Any, Any]:
    """Norm and colours. 1 % of the triangles, at the cage's corners, may exceed the norm."""
    least, high, colors = float(known.min()), float(np.quantile(known, 0.99)), distortion_colors()
    linear = {"sigma1": (1.0, float(np.clip(high, 1.5, 6.0))), "sigma2": (0.0, 1.0)}
    linear["k"] = 0.0, float(np.clip(high, 0.1, 1.0))
    if isinstance(quantity, str) and quantity in linear:
        return Normalize(*linear[quantity]), colors.reversed() if quantity == "sigma2" else colors
    if quantity == "distortion":
        return LogNorm(1.0, float(np.clip(high, 1.25, 1e4))), colors
    isometric = isometry_energy(SymmetricDirichlet() if quantity == "energy" else quantity)
    low = max(isometric if 0 < isometric < least else least, 1e-3)
    return LogNorm(low, float(np.clip(high, 2 * low, 100 * low))), colors


def _side_by_side(
    maps: list[AnyMap], sheets: list[DrawnMap], pose: Pose | None, names: Sequence[str], room: float
) -> tuple[NotebookFigure, list[Axes]]:
    """Axes with one scale, titles, folds and targets, one for each map, with ``room`` below."""
    if len(names) not in (0, len(maps)):
        raise ValueError(f"there are {len(names)} titles for {len(maps)} maps")
    box = drawing.box_around(np.concatenate([sheet.mesh.images for sheet in sheets]))
    box = box if pose is None else drawing.enlarged(box, pose.targets)
    room += 0.25 * (pose is not None) + 0.15 * any(s.counted or s.folded.any() for s in sheets)
    figure, grid = _shape_axes(len(maps), box, room)
    for i, (axes, map, sheet) in enumerate(zip(grid, maps, sheets, strict=True)):
        count = int(sheet.folded.sum())
        folds = f"{count} triangle{'' if count == 1 else 's'} turned over"
        lines = [*names[i : i + 1], *([folds] if sheet.counted else ["folds"] * bool(count))]
        look: Any = {"fontsize": style.FONT_SIZE, "color": VERMILION if count else INK}
        axes.set_title("\n".join(lines or [" "]), **look)
        _mark_folds(axes, sheet.mesh.images[sheet.mesh.triangles[sheet.folded]])
        if pose is not None:
            drawing.targets(axes, map, pose)
    if pose is not None:
        marks = grid[0].get_legend_handles_labels()[0]
        figure.legend(handles=marks, loc="outside lower center", ncols=2, **style.LEGEND)
    return figure, grid


def _mark_folds(axes: Axes, corners: Floats) -> None:
    """Hatch triangles (f, 3, 2) in vermilion with dark and white edges. Rings mark a few."""
    for face, edge, width, hatch in _FOLDED:
        look: Any = {"facecolors": face, "edgecolors": edge, "linewidths": width, "hatch": hatch}
        axes.add_collection(PolyCollection([*corners], **look))
    few, size = len(corners) < _FEW, np.ptp([axes.get_xlim(), axes.get_ylim()], axis=1).max()
    if few or np.ptp(corners, axis=(0, 1)).max() < _SMALL * size:
        middles = corners.mean(axis=1) if few else corners.mean(axis=(0, 1))[None]
        look = {"markersize": 15, "fillstyle": "none", "color": INK, "clip_on": False}
        axes.plot(*middles.T, "o", path_effects=drawing.ON_WHITE, **look)[0].set_in_layout(False)


def _shape_axes(n: int, box: Floats, room: float = 0.8) -> tuple[NotebookFigure, list[Axes]]:
    columns = min(n, _ABREAST)
    rows, width = -(-n // columns), _WIDTH if n > 1 else _WIDTH_OF_ONE
    across, up = np.ptp(box, axis=0)
    tall = min((width / columns - 0.1) * up / across, _TALLEST)
    figure = NotebookFigure(width, rows * (tall + 0.3) + room)
    grid = [figure.add_subplot(rows, columns, i + 1) for i in range(n)]
    for axes in grid:
        hold(axes, box)
    return figure, grid


def hold(axes: Axes, box: Floats) -> None:
    axes.set_axis_off()
    axes.set(xlim=box[:, 0], ylim=box[:, 1], aspect="equal", autoscale_on=False)


def _texture(image: ArrayLike | None, rest: Floats) -> tuple[Texture, Floats]:
    """The picture, or a chequered one, and the places (v, 2), in pixels, of a shape's vertices in
    it."""
    if image is not None:
        texture = Texture.from_image(image)
        return texture, PixelFrame(*texture.size).to_pixel(rest)
    low, side, cell = rest.min(axis=0), float(np.ptp(rest, axis=0).max()), 16
    i, j = np.indices((_CHECKS * cell + 2 * cell, _CHECKS * cell + 2 * cell)) // cell
    colors = np.round(255 * to_rgba_array(["#f4ead2", "#7fa6c9"])).astype(np.uint8)
    texture = Texture.from_image(colors[(i + j) % 2])
    return texture, (rest - low) / side * _CHECKS * cell + cell
