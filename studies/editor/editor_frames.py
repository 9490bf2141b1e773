"""How fast the editor follows a pointer: from a pointer's move to the new coefficients being sent.

    python -m studies.editor.editor_frames [SAMPLE or PROBLEM.json] [--moves N] [--plots]

A handle is dragged on a circle; each move waits for the frame that it leads to, as the page's
acknowledged batches do. Prints milliseconds (median and 95th percentile), the solver's share, and
the bytes of a frame.
"""

import argparse
import json
import threading
import time
from pathlib import Path

import ipywidgets
import numpy as np

import glid_nb as glid
from studies.editor.frame_log import FrameLog


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("shape", nargs="?", default="gecko")
    parser.add_argument("--moves", type=int, default=150)
    parser.add_argument("--plots", action="store_true", help="with the monitor's plots beside it")
    chosen = parser.parse_args()
    glid.enable_compilation_cache()
    image, domain, pose = load(chosen.shape)
    canvas = glid.DeformCanvas(image, domain)
    model = canvas.deformation
    monitor = glid.SolverMonitor(model) if chosen.plots else None
    model.set_pose(pose.with_targets(pose.handles))
    model.solve()

    log, sent, arrived = FrameLog(canvas), [0], threading.Event()

    def send(_: ipywidgets.Widget, message: object, buffers: list[bytes] | None = None) -> None:
        attached = sum(memoryview(b).nbytes for b in buffers or [])
        sent.append(len(json.dumps(message, default=str)) + attached)

    setattr(ipywidgets.Widget, "_send", send)  # noqa: B010
    model.observe(lambda what: arrived.set() if what == "frame" else None)
    radius = 0.1 * domain.cage.longer_side
    model.begin_drag([len(pose) - 1])
    times = []
    for angle in 2 * np.pi * np.arange(1, chosen.moves + 1) / 60:
        arrived.clear()
        start = time.perf_counter()
        model.drag_to([pose.handles[-1] + radius * np.array([np.cos(angle) - 1, np.sin(angle)])])
        if not arrived.wait(30):
            raise TimeoutError("no frame came within 30 s")
        times.append(1e3 * (time.perf_counter() - start))
    model.end_drag()
    model.solve()
    for widget in (monitor, canvas):
        if widget is not None:
            widget.close()

    median, late = np.percentile(times, [50, 95])
    share = min(1e3 * float(np.median(log.solving)) / median, 1)
    print(f"{chosen.shape}: {domain.n_coefficients} coefficients, {len(pose)} handles")
    print(f"move to frame sent: median {median:.1f} ms, 95th percentile {late:.1f} ms")
    print(f"solver's share of the median: {share:.0%}")
    print(f"largest message while dragging: {max(sent)} bytes")


def load(shape: str) -> tuple[np.ndarray, glid.Domain, glid.Pose]:
    """A bundled sample with its gentle pose, or a problem file under a blank picture."""
    if shape.endswith(".json"):
        data = json.loads(Path(shape).read_text(encoding="utf-8"))
        image = np.full((200, 200, 4), 255, np.uint8)
        return image, glid.Domain.from_dict(data), glid.Pose.from_dict(data)
    image = glid.samples.image(shape)
    domain = glid.Domain.from_cage(glid.trace(image).cage)
    return image, domain, glid.load_pose(glid.samples.pose_path(shape, "gentle"))


if __name__ == "__main__":
    main()
