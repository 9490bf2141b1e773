"""A motion through two poses, proved at every instant, as a video.

MP4 needs the extra `video`; other suffixes, such as .gif, .apng and .html, need nothing more.

    python examples/motion_to_video.py wave.mp4
"""

import sys

import glid_nb as glid

image = glid.samples.image("bar")
domain = glid.Domain.from_cage(glid.trace(image).cage)
pose = glid.io.load_pose(glid.samples.pose_path("bar", "gentle"))
keyframes = [glid.HarmonicMap.identity(domain), glid.solve(domain, pose).map]

motion = glid.Motion(keyframes, times=[0, 1.5], repeat="ping-pong")
assert motion.certificate.certified
print(f"sigma_2 >= {motion.certificate.sigma2_lower:.3f} at every instant")

path = sys.argv[1] if sys.argv[1:] else "wave.mp4"
print(*glid.export.animate(path, image, motion, size=480))
