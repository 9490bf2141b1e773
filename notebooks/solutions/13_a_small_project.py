# Answers to the exercises of 13_a_small_project.ipynb, run by tests/notebooks.
import glid_nb as glid
import numpy as np


# %% exercise 1: solution
def my_pose():
    handles = np.array([[-1.4, -4.5], [1.4, -4.5], [-6.4, 2.35], [0.0, 4.35], [6.42, 0.0]])
    targets = handles.copy()
    targets[2] = -6.0, 5.5  # the spout looks up
    return glid.Pose(handles, targets)


# %% exercise 1: a typical wrong answer
# The lid is pulled far below the pot: certified, but squashed.
def my_pose():
    handles = np.array([[-1.4, -4.5], [1.4, -4.5], [-6.4, 2.35], [0.0, 4.35], [6.42, 0.0]])
    targets = handles.copy()
    targets[3] = 0.0, -30.0
    return glid.Pose(handles, targets)


# %% exercise 2: solution
def bounds_everywhere(f):
    proof = glid.certify(f)
    return proof.sigma2_lower, proof.sigma1_upper


# %% exercise 2: a typical wrong answer
# Samples bound nothing between them.
def bounds_everywhere(f):
    points = glid.triangulate(f.domain.cage, 500).vertices
    return f.sigma2(points).min(), f.sigma1(points).max()


# %% exercise 2: many samples and a margin
# A margin is a guess: the dent lies between two of the samples, and is deeper than the margin.
def bounds_everywhere(f):
    low, high = np.inf, 0.0
    for loop in f.domain.cage.loops:
        for a, b in zip(loop, np.roll(loop, -1, axis=0)):
            points = a + np.linspace(0, 1, 5_000)[:, None] * (b - a)
            low = min(low, f.sigma2(points).min())
            high = max(high, f.sigma1(points).max())
    return 0.98 * low, 1.02 * high


# %% exercise 3: solution
def hand_in(folder, image, result):
    result.map.save(folder / "map.json")
    result.certificate.save(folder / "proof.json")
    (folder / "picture.png").write_bytes(glid.export.picture_png(image, result.map))


# %% exercise 3: a typical wrong answer
# Two maps and no proof: the file has the right name and says nothing about folding.
def hand_in(folder, image, result):
    result.map.save(folder / "map.json")
    result.map.save(folder / "proof.json")
    (folder / "picture.png").write_bytes(glid.export.picture_png(image, result.map))
