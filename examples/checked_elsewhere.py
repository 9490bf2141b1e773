"""A proof that another program checks: `glid-check`, which shares no code with this package.

It is in the extra `check`.
"""

import subprocess
import sys

import glid_nb as glid

domain = glid.Domain.from_cage(glid.trace(glid.samples.image("bar")).cage)
pose = glid.io.load_pose(glid.samples.pose_path("bar", "extreme"))
result = glid.solve(domain, pose)

result.map.save("map.json")
result.certificate.save("proof.json")
check = [sys.executable, "-m", "glid_check", "map.json", "proof.json"]
raise SystemExit(subprocess.run(check, check=False).returncode)
