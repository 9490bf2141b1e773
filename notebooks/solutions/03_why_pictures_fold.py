# Answers to the exercises of 03_why_pictures_fold.ipynb, run by tests/notebooks.
import glid_nb as glid
import numpy as np


# %% exercise 1: solution
def turned_over(images, triangles):
    a, b, c = (images[triangles[:, i]] for i in range(3))
    u, v = b - a, c - a
    area = 0.5 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    return int((area <= 0).sum())


# %% exercise 1: a typical wrong answer
# The length of a cross product has no sign: no triangle ever seems to be turned over.
def turned_over(images, triangles):
    a, b, c = (images[triangles[:, i]] for i in range(3))
    u, v = b - a, c - a
    area = 0.5 * abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    return int((area <= 0).sum())


# %% exercise 2: solution
def singular_values(J):
    fx, fy = J[0, 0] + 1j * J[1, 0], J[0, 1] + 1j * J[1, 1]
    fz, fzbar = (fx - 1j * fy) / 2, (fx + 1j * fy) / 2
    return abs(fz) + abs(fzbar), abs(fz) - abs(fzbar)


# %% exercise 2: a typical wrong answer
# The usual decomposition loses the sign that tells whether the map folds.
def singular_values(J):
    return tuple(np.linalg.svd(J, compute_uv=False))


# %% exercise 3: solution
def breaking_pose():
    targets = start.handles.copy()
    targets[0] = -3.0, -1.0  # the left foot, across the other leg and up
    return glid.Pose(start.handles, targets)


# %% exercise 3: a typical wrong answer
# A small motion breaks no method.
def breaking_pose():
    targets = start.handles.copy()
    targets[0] += 0.5
    return glid.Pose(start.handles, targets)
