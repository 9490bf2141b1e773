"""Draws docs/walk.gif: a bundled picture walks, by five keyframes; proved at every instant.

Usage: python -m studies.draw_walk [OUT ...]    other names, such as walk.mp4 or walk.html, too
"""

import sys
from pathlib import Path

import numpy as np

import glid_nb

SAMPLE, SECONDS, SIZE, FPS = "gecko", 1.2, 400, 20
# For each pin that swings: how far to the side and along, and its phase in the step.
_SWING = {
    0: ((-0.6, 0.1), 0.0),  # head
    1: ((0.1, 1.0), 0.0),  # right hand
    2: ((-0.4, 1.3), 0.5),  # left hand
    3: ((0.3, 1.4), 0.5),  # right foot
    4: ((-0.3, 1.1), 0.0),  # left foot
    5: ((0.35, 0.0), 0.5),  # chest
    6: ((0.45, 0.0), 0.0),  # hip
    7: ((1.1, 0.1), 0.5),  # tail
    8: ((1.3, 0.4), 0.5),
}


def walk() -> tuple[glid_nb.Motion, list[glid_nb.Pose]]:
    """Five poses of a repeated step, and the motion through them."""
    image = glid_nb.samples.image(SAMPLE)
    domain = glid_nb.Domain.from_cage(glid_nb.trace(image).cage)
    rest = glid_nb.io.load_pose(glid_nb.samples.pose_path(SAMPLE, "gentle"))
    results = []
    for phase in np.arange(5) / 5:
        targets = rest.handles.copy()
        for pin, ((side, along), late) in _SWING.items():
            turn = 2 * np.pi * (phase + late)
            # A limb swings forward close to the body, and back on the ground, further out.
            targets[pin] += [side * np.cos(turn), along * np.sin(turn)]
        results.append(glid_nb.solve(domain, rest.with_targets(targets)))
    times = np.linspace(0, SECONDS, 6).tolist()
    return glid_nb.Motion(results, times, repeat="loop"), [result.pose for result in results]


def main(others: list[str]) -> None:
    """Solve the poses and write the animation."""
    glid_nb.enable_compilation_cache()
    motion, poses = walk()
    print(motion.certificate.reason, f"sigma_2 >= {motion.certificate.sigma2_lower:.3f}")
    image = glid_nb.samples.image(SAMPLE)
    docs = Path(__file__).parent.parent / "docs" / "walk.gif"
    for path in [docs, *map(Path, others)]:
        settings = {"size": SIZE, "frames_per_second": FPS}
        for file in glid_nb.export.animate(path, image, motion, poses, **settings):
            print(f"{file}: {file.stat().st_size:,} bytes")


if __name__ == "__main__":
    main(sys.argv[1:])
