"""Draws docs/drag.gif: a bundled picture pulled to its extreme pose and back.

Usage: python -m studies.draw_drag
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

import glid_nb

SAMPLE, FRAMES, SIZE = "gecko", 14, 360


def main() -> None:
    """Solve the poses on the way and write the animation."""
    glid_nb.enable_compilation_cache()
    image = glid_nb.samples.image(SAMPLE)
    domain = glid_nb.Domain.from_cage(glid_nb.trace(image).cage)
    end = glid_nb.load_pose(glid_nb.samples.pose_path(SAMPLE, "extreme"))
    maps, poses = [], []
    # Slow at both ends, as a hand is.
    for share in 0.5 - 0.5 * np.cos(np.linspace(0, np.pi, FRAMES)):
        pose = end.with_targets(end.handles + share * (end.targets - end.handles))
        # From the map before, as the editor does.
        result = glid_nb.solve(domain, pose, start=maps[-1] if maps else None)
        maps.append(result.map)
        poses.append(pose)
    data = glid_nb.export.animation_bytes(
        image, maps, poses, size=SIZE, frames_per_second=14, there_and_back=True
    )
    path = Path(__file__).parent.parent / "docs" / "drag.gif"
    path.write_bytes(data)
    print(f"{path}: {len(maps)} maps, {len(data):,} bytes")


if __name__ == "__main__":
    main()
