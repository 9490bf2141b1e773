"""The figure of the page of benchmarks."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from glid_nb.imaging.style import BLUE, SMALL, VERMILION, tidy

_SERIES = (
    ("vertices", "vertices", "cage vertices", "per_iteration", "ms per iteration", 1e3),
    ("holes", "holes", "holes (40 exterior vertices)", "per_iteration", "ms per iteration", 1e3),
    ("handles", "handles", "handles (100 vertices)", "per_iteration", "ms per iteration", 1e3),
    ("vertices", "vertices", "cage vertices", "memory", "peak memory, GiB", 2.0**-30),
    ("mesh", "mesh_vertices", "display vertices", "evaluate", "mesh and map, s", 1.0),
)


def draw(results: dict[str, Any], folder: Path) -> None:
    """Write ``scaling.png`` into ``folder``."""
    figure = Figure(figsize=(11, 6), dpi=130, layout="constrained")
    axes: Any = figure.subplots(2, 3)
    for ax, (series, x, x_label, y, y_label, factor) in zip(axes.flat, _SERIES, strict=False):
        tidy(ax)
        rows = results["scaling"][series]
        ax.plot([r[x] for r in rows], [r[y] * factor for r in rows], "o-", color=BLUE, ms=4)
        ax.set_xlabel(x_label, fontsize=SMALL)
        ax.set_ylabel(y_label, fontsize=SMALL)
        if x != "holes":
            ax.set_xscale("log")
            ax.set_yscale("log")
    ax = axes.flat[-1]
    tidy(ax)
    rows = results["batches"]["rows"]
    sizes = [r["poses"] for r in rows]
    ax.plot(sizes, [r["per_second"] for r in rows], "o-", color=BLUE, ms=4, label="in a batch")
    ax.plot(
        sizes, [r["one_by_one"] for r in rows], "s--", color=VERMILION, ms=4, label="one by one"
    )
    ax.set_xscale("log")
    ax.set_ylim(bottom=0)
    ax.set_xlabel("poses", fontsize=SMALL)
    ax.set_ylabel("poses per second", fontsize=SMALL)
    ax.legend(fontsize=SMALL, frameon=False)
    figure.savefig(folder / "scaling.png")
