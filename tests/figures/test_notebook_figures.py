"""The figures of the course, on small domains that other tests use, too."""

from __future__ import annotations

import io
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest
from IPython.core.interactiveshell import InteractiveShell
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgba
from matplotlib.lines import Line2D
from matplotlib.text import Text
from matplotlib_inline.backend_inline import configure_inline_support
from PIL import Image

from glid_nb import figures
from glid_nb.certificate import certify
from glid_nb.energies import AMIPS
from glid_nb.figures.style import VERMILION
from glid_nb.geometry import MeshMap, as_points, triangulate
from glid_nb.harmonic import HarmonicMap
from glid_nb.minima import solve
from glid_nb.pose import Pose
from glid_nb.solvers import Iteration, Options

from ..support.domains import domain

pytestmark = pytest.mark.slow

RING = HarmonicMap.identity(domain("ring"))
POSE = Pose([[2.2, 0.1], [-2.2, 0.0]], [[2.2, 0.1], [-2.2, 1.0]])


def mirrored() -> MeshMap:
    mesh = triangulate(domain("ring").cage, 100)
    return MeshMap(mesh, mesh.vertices * np.where(mesh.vertices[:, :1] > 2.0, [-1, 1], [1, 1]))


def texts(figure: Any) -> str:
    figure.draw_without_rendering()
    return "\n".join(t.get_text() for t in figure.findobj(Text))


def test_a_figure_shows_itself_as_a_picture_and_pyplot_does_not_know_it() -> None:
    figure = figures.function([0, 1], {"line": [0, 1]})
    png, size = figure._repr_png_()
    with Image.open(io.BytesIO(png)) as picture:
        assert abs(picture.width / picture.height - size["width"] / size["height"]) < 0.02
    assert plt.get_fignums() == []


def test_sliders_in_a_notebook_do_not_change_how_figures_are_shown(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    shown: list[Any] = []
    monkeypatch.setattr("IPython.display.publish_display_data", lambda *data: shown.append(data))
    shell = InteractiveShell()
    configure_inline_support(shell, "inline")  # like ipywidgets' interact
    figure = figures.function([0, 1], {"line": [0, 1]})
    assert shell.display_formatter.format(figure) == ({}, {})
    ((data, size),) = shown
    assert data["text/plain"] == "<NotebookFigure>"
    assert (data["image/png"], size["image/png"]) == figure._repr_png_()


@pytest.mark.parametrize("quantity", ["sigma1", "sigma2", "k", "energy", AMIPS()])
def test_distortion_draws_maps_side_by_side_and_counts_what_is_turned_over(quantity: Any) -> None:
    folded = mirrored()
    count = int(folded.flipped.sum())
    figure = figures.distortion([RING, folded], quantity, POSE, titles=["ours", "theirs"])
    assert f"theirs\n{count} triangles turned over" in texts(figure)
    vermilion = [
        len(shapes.get_paths())
        for shapes in figure.findobj(PolyCollection)
        if tuple(np.ravel(shapes.get_facecolor())) == to_rgba(VERMILION)
    ]
    assert vermilion == [0, count]
    assert count > 0


def rings(figure: Any) -> int:
    lines = [line for line in figure.findobj(Line2D) if line.get_fillstyle() == "none"]
    return sum(len(np.ravel(line.get_xdata())) for line in lines)


def test_a_fold_is_marked_by_more_than_its_hue() -> None:
    figure = figures.distortion(mirrored())
    assert any(shapes.get_hatch() for shapes in figure.findobj(PolyCollection))
    assert rings(figure) == 0
    mesh = triangulate(domain("ring").cage, 100)
    images = mesh.vertices.copy()
    a, b, c = mesh.triangles[0]
    images[a] = 1.1 * (images[b] + images[c]) / 2 - 0.1 * images[a]
    turned = MeshMap(mesh, images)
    assert rings(figures.picture(None, [turned, RING])) == turned.flipped.sum() in (1, 2, 3)


def test_a_harmonic_map_that_folds_says_so() -> None:
    folding = HarmonicMap(RING.domain, 0 * RING.phi, np.conj(RING.phi))
    assert "mirrored\nfolds" in texts(figures.picture(None, [folding], titles=["mirrored"]))


def test_handles_are_numbered_and_cages_drawn_and_a_boundary_stands_alone() -> None:
    figure = figures.picture(None, RING, POSE, numbers=True, cages=True)
    assert {"0", "1"} <= set(texts(figure).split("\n"))
    # Outline, cage and offset cage, and the lines between handles and targets.
    assert len(figure.axes[0].lines) == 3 * len(RING.domain.cage.loops) + 1
    (axes,) = figures.boundary(RING).axes
    assert [line.get_linestyle() for line in axes.lines if line.get_fillstyle() != "none"] == [
        "-",
        "--",
    ]


def test_a_shape_has_an_outline_also_on_a_mesh() -> None:
    """Pale checks and pale colours would not show where it ends."""
    mesh = triangulate(RING.domain.cage, 500)
    moved = MeshMap(mesh, RING(mesh.vertices))
    for figure in (figures.picture(None, moved), figures.distortion(moved)):
        outline = [line for line in figure.axes[0].lines if line.get_marker() == "None"]
        assert len(outline) == len(RING.domain.cage.loops)
        ends = np.concatenate([line.get_xydata() for line in outline])
        assert np.isin(ends, moved.images).all()


def test_unknown_quantities_and_things_that_are_no_maps_are_refused() -> None:
    with pytest.raises(ValueError, match="unknown quantity 'sigma3'"):
        figures.distortion(RING, "sigma3")  # type: ignore[arg-type]
    with pytest.raises(TypeError, match=r"result\.map"):
        figures.distortion(SimpleNamespace(map=RING))  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="1 titles for 2 maps"):
        figures.distortion([RING, RING], titles=["one"])


def test_without_a_picture_the_shape_is_chequered() -> None:
    figure = figures.picture(None, [RING, mirrored()], POSE)
    pixels = np.asarray(figure.axes[0].images[0].get_array())
    assert len(np.unique(pixels[200:-200, 60:90, :3].reshape(-1, 3), axis=0)) >= 2
    middle = pixels[len(pixels) // 2, pixels.shape[1] // 2]
    assert (middle[:3] == 255).all()  # the hole


def test_a_basis_function_is_what_the_map_with_this_one_coefficient_is() -> None:
    shape = domain("ring")
    n = shape.n_coefficients
    for j in (2, n - 1):
        assert figures.basis(shape, j, "abs").axes
    with pytest.raises(ValueError, match=f"from 0 to {n - 1}"):
        figures.basis(shape, n)


def test_the_curve_of_fz_tells_each_loops_winding() -> None:
    # f = z^2 / 2 has the zero of f_z in the hole: seen from the hole's clockwise loop, -1 turn.
    shape = domain("ring")
    vertices = np.concatenate(shape.offset_cage.loops_complex)
    phi = np.append(vertices**2 / 2, 0)
    text = texts(figures.derivative_curve(HarmonicMap(shape, phi, 0 * phi)))
    assert "exterior loop: 1 turn" in text
    assert "hole 1: -1 turn" in text


def test_panels_are_counted_and_the_unproved_ones_too() -> None:
    assert "of them not proved" in texts(figures.panels(certify(RING)))
    psi = np.zeros_like(RING.phi)
    psi[1:4] = 40
    failed = certify(HarmonicMap(RING.domain, RING.phi, psi))
    assert not failed.certified
    assert " 0 of them" not in texts(figures.panels(failed))


def test_a_bar_of_energies_begins_at_the_isometrys() -> None:
    scale = HarmonicMap(RING.domain, 1.5 * RING.phi, RING.psi)
    *_, bar = figures.distortion(scale, "energy").axes
    assert bar.get_xticklabels()[0].get_text() == "2"
    assert bar.get_xlim()[0] == 2.0


def test_a_short_logarithmic_axis_has_more_labels_than_its_powers_of_ten() -> None:
    (axes,) = figures.function([0, 1], {"line": [0.3, 60.0]}, log="y").axes
    assert len(axes.get_yticks()) >= 5


def test_level_sets_and_convergence_are_labelled() -> None:
    labels = set(texts(figures.energy_levels("iso", AMIPS())).split("\n"))
    assert {"Symmetric Dirichlet", "2.2", "4", "20"} <= labels
    steps = [
        Iteration(iteration=i, energy_distortion=2 + 0.1**i, energy_p2p=0.0, time=0.1)
        for i in range(4)
    ]
    solved = solve(domain("ring"), POSE, options=Options(max_iterations=0, restarts=0))
    result = replace(solved, initial=steps[0], history=tuple(steps[1:]))
    for against in ("iterations", "seconds"):
        figure = figures.convergence({"ours": result}, against, gap_to=2.0)
        assert {"ours", against} <= set(texts(figure).split("\n"))
        curve, ring = figure.axes[0].lines
        assert ring.get_fillstyle() == "none"  # marks the last iteration
        assert np.array_equal(np.array(ring.get_xydata())[0], np.array(curve.get_xydata())[-1])


def test_planes_join_the_points_of_a_name_and_draw_a_single_number_as_a_dot() -> None:
    square = np.array([0, 2, 2 + 1j, 1j, 0])
    figure = figures.planes(
        {"square": square, "a": 1 + 2j}, {"image": 1j * square}, titles=["z", "w"]
    )
    left, right = figure.axes
    assert [axes.get_title() for axes in figure.axes] == ["z", "w"]
    line, dot = left.lines[2:]
    np.testing.assert_array_equal(line.get_xydata(), as_points(square))
    assert (line.get_linestyle(), line.get_marker()) == ("-", "None")
    assert (dot.get_xydata().tolist(), dot.get_marker()) == ([[1.0, 2.0]], "o")
    assert {text.get_text() for text in left.get_legend().get_texts()} == {"square", "a"}
    assert right.get_legend() is None
    assert left.get_aspect() == right.get_aspect() == 1.0


def test_a_long_title_breaks_inside_the_figure() -> None:
    title = "gradient 2.84 ms, Hessian 9.87 ms, factor 0.76 ms, search 0.12 ms, and other stages"
    figure = figures.function([0, 1], {"line": [0, 1]}, "x", "y", title=title)
    figure.draw_without_rendering()
    drawn = figure.axes[0].title.get_window_extent()
    assert figure.bbox.x0 <= drawn.x0
    assert drawn.x1 <= figure.bbox.x1
    assert drawn.y1 <= figure.bbox.y1
