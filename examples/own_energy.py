"""An energy of one's own: its derivatives come from automatic differentiation."""

from pathlib import Path

import glid_nb as glid


def shape_and_area(x, y):
    """A function of x = |f_z|^2 and y = |f_zbar|^2: MIPS, and a price for changed areas."""
    area = x - y  # sigma_1 sigma_2
    return (x + y) / area + 4 * (area + 1 / area)


energy = glid.energies.CustomEnergy(shape_and_area)
domain = glid.Domain.from_cage(glid.trace(glid.samples.image("bar")).cage)
pose = glid.io.load_pose(glid.samples.pose_path("bar", "gentle"))
maps = [glid.solve(domain, pose).map, glid.solve(domain, pose, energy).map]

figure = glid.figures.distortion(maps, titles=["symmetric Dirichlet", "shape and area"])
figure.savefig(Path("energies.png"))
