"""Many poses of one shape in one call, on all devices that JAX finds."""

import numpy as np

import glid_nb as glid

domain = glid.Domain.from_cage(glid.trace(glid.samples.image("bar")).cage)
pose = glid.io.load_pose(glid.samples.pose_path("bar", "gentle"))

shares = np.linspace(0, 1, 16)[:, None, None]
targets = pose.handles + shares * (pose.targets - pose.handles)  # (16, h, 2)
results = glid.solve_batch(domain, [pose.with_targets(one) for one in targets])

for share, result in zip(shares.ravel(), results, strict=True):
    bound = result.certificate.sigma2_lower
    print(f"{share:4.2f}  {result.status.value}  E = {result.energy:.4f}  sigma_2 >= {bound:.3f}")
