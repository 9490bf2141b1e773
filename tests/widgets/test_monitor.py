"""The monitor: its parts belong together, and at rest it shows the final certificate."""

from __future__ import annotations

import itertools
import re
import threading
import time
from collections.abc import Iterator
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import pytest
from matplotlib.lines import Line2D
from matplotlib.text import Text

from glid_nb.certificate import certificate_of, certify
from glid_nb.geometry import Cage, Domain
from glid_nb.harmonic import HarmonicMap
from glid_nb.session.deformation import Deformation
from glid_nb.session.status_line import rounded_down
from glid_nb.solvers import Iteration
from glid_nb.widgets import SolverMonitor
from glid_nb.widgets.live_plots import SCALE, LivePlots
from glid_nb.widgets.monitor import guide, places
from glid_nb.widgets.solver_panel import SolverPanel, step_in_words

from ..support.domains import domain
from ..support.threads import NewThreads

TIMEOUT = 120.0


@pytest.fixture
def model() -> Iterator[Deformation]:
    with Deformation(domain("ring")) as model:
        yield model


@pytest.fixture
def monitor(model: Deformation) -> Iterator[SolverMonitor]:
    monitor = SolverMonitor(model, 400, 300)
    yield monitor
    monitor.close()


def bent(model: Deformation) -> None:
    model.add_handles([(2, 0), (-2, 0)])
    model.drag(0, to=(3.0, 1.0))
    assert model.solve(TIMEOUT)


@pytest.fixture
def drawn(monkeypatch: pytest.MonkeyPatch) -> list[LivePlots]:
    """The plots that monitors make, the last one at the end."""
    made: list[LivePlots] = []

    class Noted(LivePlots):
        def __init__(self, *arguments: Any) -> None:
            super().__init__(*arguments)
            made.append(self)

    monkeypatch.setattr("glid_nb.widgets.live_plots.LivePlots", Noted)
    return made


def shown_bound(plots: LivePlots) -> str:
    """What the plot of the certificate says."""
    *_, text = plots.certificate.artists
    assert isinstance(text, Text)
    return text.get_text().split(",", maxsplit=1)[0]


@pytest.mark.slow
def test_closing_does_not_wait_for_plots_and_they_do_not_come_late(
    model: Deformation, monkeypatch: pytest.MonkeyPatch
) -> None:
    drawing, closed = threading.Event(), threading.Event()

    def draw(*_: object) -> bytes:
        drawing.set()
        assert closed.wait(TIMEOUT)
        return b"late"

    monkeypatch.setattr(LivePlots, "draw", draw)
    threads = NewThreads()
    monitor = SolverMonitor(model, 400, 300)
    assert drawing.wait(TIMEOUT)
    threading.Timer(TIMEOUT / 10, closed.set).start()  # so a close that waits returns at last
    thread = threads.named("monitor")
    monitor.close()
    assert not closed.is_set()
    closed.set()
    assert thread is not None
    thread.join(TIMEOUT)
    assert not thread.is_alive()
    assert monitor.image.value != b"late"


@pytest.mark.slow
def test_what_is_drawn_belongs_together(
    model: Deformation, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Holes come and go in one thread while the monitor draws in another."""
    monkeypatch.setattr("glid_nb.widgets.monitor.INTERVAL", 0.0)
    monitor = SolverMonitor(model, 400, 300)
    square = Cage([[-6, -6], [6, -6], [6, 6], [-6, 6]])
    holes = [[[x, y], [x, y + 1], [x + 1, y + 1], [x + 1, y]] for x in (-3, 2) for y in (-3, 2)]
    without, with_holes = (Domain.from_cage(Cage(square.exterior, h)) for h in ([], holes))
    caught: list[Any] = []
    monkeypatch.setattr(threading, "excepthook", caught.append)
    model.paused = True
    model.begin()
    for domain_ in (with_holes, without):  # compiled before the time counts
        model.set_domain(domain_)
        assert monitor.refresh(TIMEOUT)
    drawing = [True]

    def draw() -> None:
        while drawing:
            monitor.refresh(TIMEOUT)

    other = threading.Thread(target=draw)
    other.start()
    end = time.monotonic() + 4.0
    while time.monotonic() < end and not caught:
        model.set_domain(with_holes)
        time.sleep(0.03)
        model.undo()
        time.sleep(0.03)
    drawing.clear()
    other.join()
    monitor.close()
    assert not caught


@pytest.mark.slow
def test_at_rest_all_say_what_the_final_certificate_proves(
    model: Deformation, drawn: list[LivePlots], monitor: SolverMonitor
) -> None:
    bent(model)
    lower = rounded_down(certify(model.map).sigma2_lower)
    words = f"Converged · certified σ₂ ≥ {lower}, σ₁ ≤ "
    assert model.status.text.startswith(words)
    assert monitor.text == model.status.text
    assert monitor.refresh(TIMEOUT)
    assert monitor.text in monitor.line.said.value
    assert shown_bound(drawn[-1]) == f"σ₂ ≥ {lower}"
    # Also without a frame of the solver.
    model.drag(1, to=(-3.0, 1.0))
    assert model.solve(TIMEOUT)
    model.undo()
    assert model.moment.frame is None
    assert model.solve(TIMEOUT)
    assert model.status.text.startswith(words)
    assert monitor.refresh(TIMEOUT)
    assert shown_bound(drawn[-1]) == f"σ₂ ≥ {lower}"


@pytest.mark.slow
def test_the_last_drawing_is_that_at_rest(
    model: Deformation,
    drawn: list[LivePlots],
    monitor: SolverMonitor,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The solver comes to rest after it reported its last frame, without another report."""
    bent(model)
    assert monitor.refresh(TIMEOUT)
    model.drag(0, to=(3.5, 1.0))
    assert model.solve(TIMEOUT)
    rest = model.moment
    working = type(rest)(rest.state, rest.frame, True, False)
    moments = [working, rest, rest]
    monkeypatch.setattr(Deformation, "moment", property(lambda _: moments.pop(0)))
    assert monitor.refresh(TIMEOUT)
    assert len(moments) == 1
    assert "Converged" in monitor.line.said.value
    assert shown_bound(drawn[-1]) == f"σ₂ ≥ {rounded_down(certificate_of(rest.map).sigma2_lower)}"


@pytest.mark.slow
def test_the_history_stays_while_the_next_targets_are_not_solved(
    model: Deformation, drawn: list[LivePlots], monitor: SolverMonitor
) -> None:
    bent(model)
    model.paused = True
    model.drag(0, to=(3.5, 1.0))
    assert monitor.refresh(TIMEOUT)
    *_, total, _, _ = drawn[-1].energy.artists
    assert isinstance(total, Line2D)
    assert len(total.get_xdata())


def _legend_texts(axes: Any) -> list[Any]:
    legend = axes.get_legend()
    return [] if legend is None else legend.get_texts()


def _tick_boxes(axis: Any) -> list[Any]:
    low, high = sorted(axis.get_view_interval())
    labels = [t.label1 for t in axis.get_major_ticks() if low <= t.get_loc() <= high]
    return [text.get_window_extent() for text in labels if text.get_visible() and text.get_text()]


@pytest.mark.slow
@pytest.mark.parametrize("width", [500, 460, 320])
@pytest.mark.parametrize("n_holes", [0, 1, 8])
def test_no_text_lies_over_data_or_other_text(n_holes: int, width: int):
    holes = [[[x, 2], [x, 3], [x + 0.5, 3], [x + 0.5, 2]] for x in range(1, n_holes + 1)]
    cage = Cage([[0, 0], [12, 0], [12, 6], [0, 6]], holes)
    map_ = HarmonicMap.identity(Domain.from_cage(cage))
    plots = LivePlots(cage, width, 370, places(width, 370))
    records = [
        SimpleNamespace(
            iteration=i,
            energy=2.1,
            energy_distortion=2.0,
            energy_p2p=0.1,
            step=1.0,
            decrement=10.0 ** -(i % 12),
            time=0.02,
        )
        for i in range(1, 60)
    ]
    plots.draw(records, certify(map_))
    everything: list[Any] = []
    for plot in plots.plots:
        axes = plot.axes
        texts: list[Any] = [*axes.texts, axes.xaxis.label, *_legend_texts(axes)]
        boxes = [t.get_window_extent() for t in texts if t.get_text() and t.get_visible()]
        inside = axes.get_window_extent()
        assert not any(box.overlaps(inside) for box in boxes)
        assert not any(a.overlaps(b) for a, b in itertools.combinations(boxes, 2))
        assert all(b.y0 >= 0 and b.y1 <= axes.figure.bbox.y1 for b in boxes)
        everything += [*boxes, *_tick_boxes(axes.xaxis), *_tick_boxes(axes.yaxis)]
    if width < 460:  # no editor is that narrow: legends are wider than their plots
        return
    assert not any(a.overlaps(b) for a, b in itertools.combinations(everything, 2))
    whole = plots.plots[0].axes.figure.bbox
    assert all(whole.contains(*corner) for box in everything for corner in (box.p0, box.p1))
    titles = [plot.axes.texts[-1].get_window_extent() for plot in plots.plots]
    marks = re.findall(r"<details .*?left:(\d+)px", guide(width, 370).value)
    assert all(t.x1 / SCALE < float(x) for t, x in zip(titles, marks, strict=True))


@pytest.mark.slow
def test_a_frame_says_where_its_solves_began(model: Deformation) -> None:
    model.add_handles([(2, 0), (-2, 0)])
    assert model.solve(TIMEOUT)
    model.begin_drag([0])
    for x in (2.5, 3.0, 3.5):
        model.drag_to([(x, 1.0)])
        assert model.solve(TIMEOUT)
    model.end_drag()
    frame, solution = model.moment.frame, model.moment.solution
    assert frame is not None
    assert solution is not None
    assert solution.starts == frame.starts
    energies = {i.iteration: i.energy for i in frame.history}
    assert set(frame.starts) <= set(energies)
    moved = [i for i in frame.starts if i - 1 in energies]
    assert len(moved) >= 2
    assert all(energies[i] > energies[i - 1] for i in moved)


@pytest.mark.slow
def test_a_single_step_says_what_it_did(model: Deformation) -> None:
    model.paused = True
    panel = SolverPanel(model)
    assert "Step shows its numbers here" in panel.steps.value
    model.add_handles([(2, 0), (-2, 0)])
    model.drag(0, to=(3.0, 1.0))
    for count in (1, 2):
        panel.step.click()
        assert model.solve(TIMEOUT)
        frame = model.moment.frame
        assert frame is not None
        assert len(frame.history) == count
        last = frame.history[-1]
        told = f"Hessian {'projected' if last.hessian_modified else 'exact'} · step length "
        assert f"Iteration {count} · {told}{last.step:.3g}" in panel.steps.value
        assert f"of {last.panels} panels split" in panel.steps.value
    assert panel.steps.layout.display is panel.step.layout.display is None
    model.paused = False
    assert panel.steps.layout.display == panel.step.layout.display == "none"
    panel.close()


def test_a_step_in_words() -> None:
    step = Iteration(iteration=7, energy_distortion=2.125, energy_p2p=0.0, step=0.5, panels=212)
    step = replace(step, hessian_modified=True, panels_split=3)
    words = "Iteration 7 · Hessian projected · step length 0.5 · 3 of 212 panels split · E = 2.125"
    assert step_in_words(step) == words
    other = replace(step, hessian_modified=None, panels_split=None, step=None)
    assert step_in_words(other) == "Iteration 7 · E = 2.125"
