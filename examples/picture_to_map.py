"""From a picture to a map that is proved not to fold.

python examples/picture_to_map.py my-character.png
"""

import sys
from pathlib import Path

import glid_nb as glid

image = glid.read_image(sys.argv[1]) if sys.argv[1:] else glid.samples.image("bar")
domain = glid.Domain.from_cage(glid.trace(image).cage)
pose = glid.suggest_pose(domain)  # or glid.Pose([[x, y], ...], [[x, y], ...])

result = glid.solve(domain, pose)
print(result.message)
print(f"sigma_2 >= {result.certificate.sigma2_lower:.3f} on the whole shape")

result.map.save("map.json")
Path("deformed.png").write_bytes(glid.export.picture_png(image, result.map, size=(800, 800)))
