"""The overview figure and its plots, on maps and histories made for these tests."""

from __future__ import annotations

import functools
import io
import itertools
from dataclasses import dataclass, replace
from types import SimpleNamespace
from typing import Any

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.collections import LineCollection
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from numpy.typing import NDArray
from PIL import Image
from skimage.color import rgb2lab

from glid_nb.certificate import Certificate, certify
from glid_nb.energies import SymmetricDirichlet
from glid_nb.figures import figure_png, overview
from glid_nb.figures.plots import CertificatePlot, EnergyPlot, StepPlot, TimePlot
from glid_nb.figures.style import CYAN, distortion_colors
from glid_nb.geometry import Cage, Domain
from glid_nb.harmonic import HarmonicMap
from glid_nb.pose import Pose

pytestmark = pytest.mark.slow  # most of the time is compiling


@dataclass(frozen=True)
class Record:
    iteration: int
    energy_distortion: float
    energy_p2p: float
    step: float = 1.0
    decrement: float = 1.0
    time: float = 0.02

    @property
    def energy(self) -> float:
        return self.energy_distortion + self.energy_p2p


HISTORY = tuple(
    Record(i, 2.5 - 0.05 * i, 1e5 * 10.0 ** (-2 * i), 0.5 if i < 3 else 1.0, 10.0 ** (3 - 2 * i))
    for i in range(1, 7)
)


@pytest.fixture(scope="module")
def domain() -> Domain:
    hole = 1.0 + 1.5 * np.array([[-1, -1], [-1, 1], [1, 1], [1, -1]])
    return Domain.from_cage(Cage([[-7, -4], [7, -4], [7, 4], [-7, 4]], [hole]), offset=0.4)


@pytest.fixture(scope="module")
def bent(domain: Domain) -> HarmonicMap:
    start = HarmonicMap.identity(domain)
    phi = np.where(start.phi != 0, start.phi + 0.02j * start.phi**2, 0)
    return HarmonicMap(domain, phi, start.psi)


@pytest.fixture(scope="module")
def certificate(bent: HarmonicMap) -> Certificate:
    return certify(bent)


@pytest.fixture(scope="module")
def pose(bent: HarmonicMap) -> Pose:
    handles = np.array([[-6.0, 0.0], [6.0, 3.0], [0.0, -3.0]])
    return Pose(handles, bent(handles) + np.array([[0, 0], [0, 0], [2.5, 0]]))


@pytest.fixture(scope="module")
def result(bent: HarmonicMap, certificate: Certificate, pose: Pose) -> Any:
    return SimpleNamespace(
        map=bent,
        certificate=certificate,
        history=HISTORY,
        pose=pose,
        initial=Record(0, 2.0, 38.0),
        energy_measure=SymmetricDirichlet(),
    )


@pytest.fixture(scope="module")
def image() -> NDArray[np.uint8]:
    picture = np.full((160, 200, 4), 255, np.uint8)
    picture[..., :3] = 90, 140, 60
    return picture


@pytest.fixture(scope="module")
def figure(image: NDArray[np.uint8], result: Any) -> Figure:
    return overview(image, result)


def new_axes() -> Any:
    return Figure().add_subplot()


@functools.cache
def pixels(figure: Figure) -> NDArray[np.uint8]:
    return np.array(Image.open(io.BytesIO(figure_png(figure))).convert("RGB"))


def pixel_at(figure: Figure, index: int, point: NDArray[np.float64]) -> NDArray[np.uint8]:
    """Colour of the drawn figure at a world point of one of its axes."""
    picture = pixels(figure)
    x, y = figure.axes[index].transData.transform(point)
    return picture[len(picture) - 1 - int(y), int(x)]


def test_the_figure_is_private_and_leaves_matplotlib_alone(image: NDArray[np.uint8], result: Any):
    before, open_before = dict(mpl.rcParams), plt.get_fignums()
    figure = overview(image, result)
    assert isinstance(figure, Figure)
    assert dict(mpl.rcParams) == before
    assert plt.get_fignums() == open_before


def test_the_figure_has_six_lettered_panels_and_a_colour_bar(figure: Figure):
    assert len(figure.axes) == 7
    texts = [text.get_text() for axes in figure.axes for text in axes.texts]
    assert [text for text in texts if len(text) == 1] == list("abcdef")
    assert {"Source", "Deformation", "Energy", "Newton steps", "Certificate"} < set(texts)
    assert "E − 2" in [axes.get_ylabel() for axes in figure.axes]
    keys = [axes.get_legend() for axes in figure.axes[:2]]
    legends = {text.get_text() for key in keys if key for text in key.get_texts()}
    assert legends == {"cage", "offset cage", "handles", "targets", "handles' images"}


def test_the_png_has_the_figures_size_and_stays_on_the_page(figure: Figure):
    picture = pixels(figure)
    width, height = figure.get_size_inches() * 300
    assert picture.shape[1] == round(width) == 2100
    assert abs(picture.shape[0] - height) <= 1
    border = np.concatenate([picture[:8].ravel(), picture[-8:].ravel(), picture[:, :8].ravel()])
    assert (border == 255).all()
    assert (picture[:, -8:] == 255).all()


def test_the_pictures_share_one_scale_and_are_not_stretched(figure: Figure):
    scales = []
    for axes in figure.axes[:3]:
        box = axes.get_window_extent()
        scales += [box.width / np.ptp(axes.get_xlim()), box.height / np.ptp(axes.get_ylim())]
    np.testing.assert_allclose(scales, scales[0], rtol=1e-9)


def test_the_deformed_picture_lies_where_the_map_takes_it(figure: Figure, bent: HarmonicMap):
    inside = bent(np.array([[-4.0, 2.0]]))[0]
    assert np.abs(pixel_at(figure, 1, inside).astype(int) - (90, 140, 60)).max() <= 2
    outside = bent(np.array([[-7.0, 2.0]]))[0] - [0.5, 0.0]
    assert (pixel_at(figure, 1, outside) == 255).all()
    hole = bent(np.array([[-0.5, 1.0]]))[0] + [0.6, 0.0]
    assert (pixel_at(figure, 1, hole) == 255).all()


def test_targets_are_cyan_and_joined_to_handles_that_miss_them(
    figure: Figure, bent: HarmonicMap, pose: Pose
):
    cyan = np.round(np.array(to_rgb(CYAN)) * 255)
    assert np.abs(pixel_at(figure, 1, pose.targets[2]) - cyan).max() <= 2
    assert pixel_at(figure, 1, pose.targets[0]).max() < 40  # the dot of the image lies on the disc
    (lines,) = [c for c in figure.axes[1].collections if isinstance(c, LineCollection)]
    segments = np.array(lines.get_segments())
    np.testing.assert_allclose(segments, [[bent(pose.handles[2:])[0], pose.targets[2]]])


def test_distortion_is_pale_where_there_is_none(image: NDArray[np.uint8], result: Any):
    still = HarmonicMap.identity(result.map.domain)
    calm: Any = SimpleNamespace(**(vars(result) | {"map": still, "certificate": certify(still)}))
    figure = overview(image, calm)
    palest = np.array(distortion_colors()(0.0)[:3]) * 255
    for point in ([-4.0, 2.0], [5.0, -2.0]):
        assert np.abs(pixel_at(figure, 2, np.array(point)) - palest).max() <= 3


def test_distortion_is_dark_where_the_map_stretches_most(figure: Figure, bent: HarmonicMap):
    points = np.array([[-4.0, 2.0], [0.0, -3.0], [6.5, 0.0], [-6.5, 3.5], [6.5, -3.5], [0.0, 3.5]])
    distortion = np.maximum(bent.sigma1(points), 1 / bent.sigma2(points))
    shades = [float(pixel_at(figure, 2, p).sum()) for p in bent(points)]
    assert (np.diff(np.array(shades)[np.argsort(distortion)]) <= 12).all()
    assert max(shades) - min(shades) > 150


def test_a_solve_without_iterations_or_handles(image: NDArray[np.uint8], result: Any):
    empty = Pose(np.zeros((0, 2)), np.zeros((0, 2)))
    bare: Any = SimpleNamespace(**(vars(result) | {"history": (), "pose": empty}))
    assert len(pixels(overview(image, bare, width=5.0))[0]) == 1500


def test_a_figure_that_is_too_narrow(image: NDArray[np.uint8], result: Any):
    with pytest.raises(ValueError, match="width is 2 inches; the text needs"):
        overview(image, result, width=2)


def test_far_targets_do_not_shrink_the_pictures(image: NDArray[np.uint8], result: Any, pose: Pose):
    figure = overview(image, result, Pose(pose.handles, pose.targets + 500))
    assert np.ptp(figure.axes[1].get_xlim()) < 2 * 14 * 1.3


def test_the_distortion_colours_darken_evenly():
    colors = distortion_colors()(np.linspace(0, 1, 64))[:, :3]
    lightness = rgb2lab(colors[None])[0, :, 0]
    steps = -np.diff(lightness)
    assert lightness[0] > 90
    assert (steps > 0).all()
    assert steps.max() < 2 * steps.mean()


def test_the_energy_is_drawn_above_its_minimum_on_a_logarithmic_axis():
    plot = EnergyPlot(new_axes())
    assert plot.update(HISTORY, minimum=2.0)
    assert plot.axes.get_yscale() == "log"
    low, high = plot.axes.get_ylim()
    # The targets' part leaves the plot; the total stays in it.
    assert 1e-2 < low < 0.2 < 1.3e3 < high
    p2p, iso, total, _, text = plot.artists
    np.testing.assert_allclose(p2p.get_ydata(), [r.energy_p2p for r in HISTORY])  # type: ignore[attr-defined]
    np.testing.assert_allclose(total.get_ydata(), [r.energy - 2 for r in HISTORY])  # type: ignore[attr-defined]
    np.testing.assert_allclose(iso.get_ydata(), [r.energy_distortion - 2 for r in HISTORY])  # type: ignore[attr-defined]
    assert text.get_text() == "E = 2 + 0.2"  # type: ignore[attr-defined]
    plot.update(HISTORY)
    assert text.get_text() == "E = 2.2"  # type: ignore[attr-defined]


@pytest.mark.parametrize("energy", [np.nan, np.inf, 1e300, 2.0, 1.9, 0.0])
def test_any_energy_is_drawn(energy: float):
    """Also for maps that fold, and for shapes that are not deformed."""
    for records in ([Record(1, energy, 0.0)], [*HISTORY, Record(7, energy, 0.0)]):
        plot = EnergyPlot(new_axes())
        plot.update(records, minimum=2.0)
        low, high = plot.axes.get_ylim()
        assert 0 < low < high < np.inf
        plot.axes.figure.canvas.draw()


@pytest.mark.parametrize("minimum", [0.0, 2.0, np.exp(2)])
def test_a_small_drag_is_seen_in_the_energy(minimum: float):
    """From 0.105 to 0.134 above the minimum, each target solved in three iterations."""
    ends = np.linspace(0.105, 0.134, 10)
    records = [Record(i, minimum + ends[i // 3], (10, 0.1, 1e-5)[i % 3]) for i in range(30)]
    plot = EnergyPlot(new_axes())
    plot.update(records, starts=range(3, 30, 3), minimum=minimum)
    _, iso, *_ = plot.artists
    places = plot.axes.transData.transform(np.column_stack(iso.get_data()))  # type: ignore[attr-defined]
    assert np.ptp(places[:, 1]) > 0.2 * plot.axes.bbox.height
    assert plot.axes.bbox.y0 < places[0, 1] < places[-1, 1] < plot.axes.bbox.y1
    assert len([t for t in plot.axes.get_yticks() if 0.1 <= t <= 0.2]) >= 2
    # Back to the undeformed shape: at the minimum, and within the axes.
    plot.update([*records, Record(30, minimum, 0.0)], minimum=minimum)
    low, high = plot.axes.get_ylim()
    assert low < plot.artists[1].get_ydata()[-1] < high  # type: ignore[attr-defined]


@pytest.mark.parametrize("kind", [EnergyPlot, StepPlot, TimePlot])
def test_updates_tell_whether_the_limits_changed(kind: Any):
    plot = kind(new_axes(), animated=True)
    assert all(artist.get_animated() for artist in plot.artists)
    plot.update(HISTORY[:4])
    assert not plot.update(HISTORY[:4])
    assert plot.update(HISTORY)
    plot.update(())  # a new solve starts


@pytest.mark.parametrize("kind", [EnergyPlot, StepPlot, TimePlot])
def test_limits_seldom_change_while_iterations_come(kind: Any):
    rng = np.random.default_rng(0)
    records = [
        Record(i, 2 + rng.random(), 0.1, time=0.02 + 0.01 * rng.random()) for i in range(400)
    ]
    plot = kind(new_axes())
    changes = sum(plot.update(records[max(n - 200, 0) : n]) for n in range(1, 400))
    assert changes < 40


@pytest.mark.parametrize("kind", [EnergyPlot, StepPlot])
def test_one_iteration_is_seen(kind: Any):
    plot = kind(new_axes())
    plot.update(HISTORY[:1])
    low, high = plot.axes.get_xlim()
    assert low < 0.5 < 1.5 < high
    lines = [artist for artist in plot.artists if hasattr(artist, "get_marker")]
    lines = [line for line in lines if line.get_linestyle() != "None"]
    assert {line.get_marker() for line in lines} == {"o"}
    plot.update([Record(i, 2.0, 1.0) for i in range(1, 200)])
    assert {line.get_marker() for line in lines} == {""}


def test_the_time_of_each_iteration_is_a_bar():
    plot = TimePlot(new_axes())
    plot.update(
        [*(Record(i, 2, 1, time=0.004 * i) for i in range(1, 6)), Record(6, 2, 1, time=9.0)]
    )
    bars, text = plot.artists
    corners = bars.get_xy()  # type: ignore[attr-defined]
    np.testing.assert_allclose(corners[:20].reshape(5, 4, 2)[:, 1, 1], [4, 8, 12, 16, 20])
    assert text.get_text() == "14 ms each"  # type: ignore[attr-defined]
    # One iteration that had to wait does not flatten the others.
    assert 20 < plot.axes.get_ylim()[1] < 100


@pytest.mark.parametrize("kind", [EnergyPlot, StepPlot])
def test_during_a_drag_lines_join_the_ends_of_the_solves(kind: Any):
    """Each moved target makes a saw-tooth of iterations, drawn as faint dots."""
    records = [Record(i, 2.0 + 10.0 ** (2 - 2 * (i % 3)), 2.0) for i in range(12)]
    plot = kind(new_axes())
    plot.update(records, starts=(3, 6, 9))
    line = plot.artists[-3 if kind is EnergyPlot else 0]
    within = plot.artists[-2 if kind is EnergyPlot else -1]  # the faint dots
    np.testing.assert_array_equal(line.get_xdata(), [2, 5, 8, 11])
    np.testing.assert_array_equal(within.get_xdata(), [0, 1, 3, 4, 6, 7, 9, 10])
    if kind is EnergyPlot:
        assert plot.axes.get_ylim()[1] < 10
    plot.update(records, starts=(3, 6, 9), solving=True)  # the last has not ended yet
    np.testing.assert_array_equal(line.get_xdata(), [2, 5, 8])
    plot.update(records, starts=(0,))  # one solve
    assert len(line.get_xdata()) == 12
    assert len(within.get_xdata()) == 0


def test_the_step_plot_leaves_out_what_a_logarithm_cannot_show():
    plot = StepPlot(new_axes())
    plot.update([*HISTORY, replace(HISTORY[-1], iteration=7, step=0.0, decrement=float("nan"))])
    decrement, step, _ = plot.artists
    for line, name in ((decrement, "decrement"), (step, "step")):
        values = line.get_ydata()  # type: ignore[attr-defined]
        np.testing.assert_allclose(values[:-1], [getattr(r, name) for r in HISTORY])
        assert np.isnan(values[-1])
    low, high = plot.axes.get_ylim()
    assert low <= 1e-9
    assert high >= 10


def test_the_certificate_plot_puts_the_loops_side_by_side(
    bent: HarmonicMap, certificate: Certificate
):
    cage = bent.domain.cage
    plot = CertificatePlot(new_axes(), cage)
    assert plot.update(certificate, bent)
    _, bound, truth, least, text = plot.artists
    x, y = bound.get_data()  # type: ignore[attr-defined]
    (gap,) = np.flatnonzero(np.isnan(y))
    np.testing.assert_allclose([x[0], x[gap - 1]], [0, 44], atol=1e-9)
    np.testing.assert_allclose([x[gap + 1], x[-1]], [44, 56], atol=1e-9)
    assert np.nanmin(y) == certificate.sigma2_lower
    np.testing.assert_allclose(least.get_ydata(), [certificate.sigma2_lower])  # type: ignore[attr-defined]
    # The sampled sigma_2 lies above the bound of its panel.
    s, t = truth.get_data()  # type: ignore[attr-defined]
    samples = t[~np.isnan(t)].reshape(-1, 5)
    assert (samples >= certificate.panels.sigma2_lower[:, None]).all()
    assert s[~np.isnan(t)].reshape(-1, 5)[0, 0] == 0
    shown = float(text.get_text().split()[2].strip(","))  # type: ignore[attr-defined]
    assert 0.99 * certificate.sigma2_lower < shown <= certificate.sigma2_lower
    assert text.get_text().endswith(", winding number 0")  # type: ignore[attr-defined]
    names = [label.get_text() for label in plot.axes.get_xticklabels()]
    assert names == ["exterior", "hole 1"]
    np.testing.assert_allclose(plot.axes.get_xticks(), [22, 50])
    assert "threshold 0" in {child.get_text() for child in plot.axes.texts}
    assert not plot.update(certificate, bent)


def test_the_certificate_plot_says_when_nothing_is_proved(
    bent: HarmonicMap, certificate: Certificate
):
    plot = CertificatePlot(new_axes(), bent.domain.cage)
    panels = replace(certificate.panels, sigma2_lower=certificate.panels.sigma2_lower - 1.2)
    failed = replace(certificate, certified=False, panels=panels)
    plot.update(failed)
    fill, _, truth, _, text = plot.artists
    assert text.get_text() == "not certified, winding number 0"  # type: ignore[attr-defined]
    assert len(truth.get_xdata()) == 0  # type: ignore[attr-defined]
    assert plot.axes.get_ylim()[0] < panels.sigma2_lower.min() < 0
    assert fill.get_xy()[:, 1].min() == 0  # type: ignore[attr-defined]


def test_the_certificate_plot_says_how_f_z_winds(bent: HarmonicMap, certificate: Certificate):
    plot = CertificatePlot(new_axes(), bent.domain.cage)
    text: Any = plot.artists[-1]
    turned = replace(certificate, windings=(1, -1))
    vars(turned)["certified"] = True
    plot.update(turned)
    assert text.get_text().endswith("winding number 0 (exterior 1, hole 1 \N{MINUS SIGN}1)")
    plot.update(replace(certificate, certified=False, windings=(2, 0)))
    assert "not certified, winding number 2" in text.get_text()


def test_every_loop_is_named_or_numbered():
    """If not even numbers fit, neighbours share their room."""
    squares = [
        [[x, y], [x, y + s], [x + s, y + s], [x + s, y]]
        for x, y, s in (
            *((x, 2.0, 0.9) for x in range(1, 6)),
            *((x, 4.0, 0.1) for x in range(1, 9)),
            (7.0, 1.0, 2.9),
        )
    ]
    plot = CertificatePlot(new_axes(), Cage([[0, 0], [12, 0], [12, 6], [0, 6]], squares))
    names = [label.get_text() for label in plot.axes.get_xticklabels()]
    assert names[0] == "exterior"
    assert names[-1] == "hole 14"
    numbers: list[int] = []
    for name in names[1:-1]:
        first, _, last = name.removeprefix("hole ").partition("\N{EN DASH}")
        numbers += range(int(first), int(last or first) + 1)
    assert numbers == [*range(1, 14)]
    # Texts do not overlap.
    plot.axes.figure.canvas.draw()
    boxes = [label.get_window_extent() for label in plot.axes.get_xticklabels()]
    assert all(left.x1 < right.x0 for left, right in itertools.pairwise(boxes))
