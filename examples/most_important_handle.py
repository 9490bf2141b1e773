"""Find the handle whose place in the shape matters most, and how far it may move safely."""

from pathlib import Path

import numpy as np

import glid_nb as glid

domain = glid.Domain.from_cage(glid.trace(glid.samples.image("bar")).cage)
pose = glid.io.load_pose(glid.samples.pose_path("bar", "gentle"))
result = glid.solve(domain, pose)
points = glid.triangulate(domain.cage, 300).vertices

moves = [result.sensitivity(i, "handles") for i in range(len(pose))]
means = [float(np.mean(one.speed(points))) for one in moves]
for i, mean in enumerate(means):
    radius = min(glid.safe_radius(result.map, field) for field in moves[i].fields)
    print(f"handle {i}: moves the shape by {mean:.3f} a unit, no fold within {radius:.2f} units")
most = int(np.argmax(means))
print(f"handle {most} matters most")
Path("sensitivity.png").write_bytes(glid.figures.figure_png(glid.figures.sensitivity(moves[most])))
