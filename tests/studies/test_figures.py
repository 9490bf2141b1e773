"""Pieces of figures."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

from glid_nb.geometry import triangulate
from studies import figures

from ..support.problems import problem

MESH = triangulate(problem("ell")[0].cage, 60)


@pytest.mark.parametrize(("stretch", "extended"), [(1.2, "neither"), (3.0, "max")])
def test_a_bar_says_where_colours_end(stretch: float, extended: str) -> None:
    figure = figures.figure(4, 2)
    axes = figure.subplots(1, 2)
    # The map that exceeds the range need not be the one from which the bar is made.
    figures.draw_map(axes[0], MESH, MESH.vertices * [stretch, 1], most=4)
    last = figures.draw_map(axes[1], MESH, MESH.vertices, most=4)
    before = set(figure.axes)
    figures.color_bar(figure, last, axes, "density")
    (bar,) = set(figure.axes) - before
    assert bar._colorbar.extend == extended  # type: ignore[attr-defined]


def test_a_map_is_in_the_picture_with_its_targets(tmp_path: Path) -> None:
    figure = figures.figure(4, 2)
    axes = figure.subplots()
    pose = np.array([[9.0, 0.0, 1.0, 0.0]])
    figures.draw_map(axes, MESH, MESH.vertices, pose)
    figures.save(figure, tmp_path / "map.webp")
    low, high = np.array([axes.get_xlim(), axes.get_ylim()]).T
    assert (low < MESH.vertices.min(axis=0)).all()
    assert (high > np.vstack([MESH.vertices, pose[:, :2]]).max(axis=0)).all()


def test_a_picture_is_whole_or_the_one_before(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "new" / "figure.webp"
    figures.save(figures.figure(1, 1), path)
    whole = path.read_bytes()
    with Image.open(path) as picture:
        picture.load()
        assert picture.format == "WEBP"

    def interrupted(_: Figure, target: object, **__: object) -> None:
        # Half of the picture is written, whether a path or a file is given.
        if isinstance(target, str | Path):
            Path(target).write_bytes(whole[:20])
        raise KeyboardInterrupt

    monkeypatch.setattr(Figure, "savefig", interrupted)
    with pytest.raises(KeyboardInterrupt):
        figures.save(figures.figure(1, 1), path)
    assert path.read_bytes() == whole
    assert list(path.parent.iterdir()) == [path]
