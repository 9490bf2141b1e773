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


# %% exercise 1: right: by the area formula over the corners' coordinates
def turned_over(images, triangles):
    x, y = images[triangles].transpose(2, 0, 1)
    twice = (x * np.roll(y, -1, axis=1) - np.roll(x, -1, axis=1) * y).sum(axis=1)
    return (twice <= 0).sum()


# %% exercise 1: right: a loop with determinants
def turned_over(images, triangles):
    count = 0
    for a, b, c in images[triangles]:
        count += not np.linalg.det(np.stack([b - a, c - a])) > 0
    return count


# %% exercise 1: without the flat ones
def turned_over(images, triangles):
    a, b, c = (images[triangles[:, i]] for i in range(3))
    u, v = b - a, c - a
    return int((u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0] < 0).sum())


# %% exercise 1: those that are not turned over
def turned_over(images, triangles):
    a, b, c = (images[triangles[:, i]] for i in range(3))
    u, v = b - a, c - a
    return int((u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0] > 0).sum())


# %% exercise 1: always none
def turned_over(images, triangles):
    return 0


# %% exercise 1: the first vertices instead of the triangles' corners
def turned_over(images, triangles):
    corners = images[: 3 * (len(images) // 3)].reshape(-1, 3, 2)
    u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    return int((u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0] <= 0).sum())


# %% exercise 2: right: by the trace of J^T J
def singular_values(J):
    determinant = np.linalg.det(J)
    half = np.trace(J.T @ J) / 2
    largest = np.sqrt(half + np.sqrt(max(half**2 - determinant**2, 0)))
    return largest, determinant / largest


# %% exercise 2: right: with the sign of the determinant
def singular_values(J):
    largest, smallest = np.linalg.svd(J, compute_uv=False)
    return np.array([largest, np.sign(np.linalg.det(J)) * smallest])


# %% exercise 2: solution
def singular_values(J):
    fx, fy = J[0, 0] + 1j * J[1, 0], J[0, 1] + 1j * J[1, 1]
    fz, fzbar = (fx - 1j * fy) / 2, (fx + 1j * fy) / 2
    return abs(fz) + abs(fzbar), abs(fz) - abs(fzbar)


# %% exercise 2: a typical wrong answer
# The usual decomposition loses the sign that tells whether the map folds.
def singular_values(J):
    return tuple(np.linalg.svd(J, compute_uv=False))


# %% exercise 2: without a sign
def singular_values(J):
    fx, fy = J[0, 0] + 1j * J[1, 0], J[0, 1] + 1j * J[1, 1]
    fz, fzbar = (fx - 1j * fy) / 2, (fx + 1j * fy) / 2
    return abs(fz) + abs(fzbar), abs(abs(fz) - abs(fzbar))


# %% exercise 2: the signs of i are swapped
def singular_values(J):
    fx, fy = J[0, 0] + 1j * J[1, 0], J[0, 1] + 1j * J[1, 1]
    fz, fzbar = (fx + 1j * fy) / 2, (fx - 1j * fy) / 2
    return abs(fz) + abs(fzbar), abs(fz) - abs(fzbar)


# %% exercise 2: the halves are forgotten
def singular_values(J):
    fx, fy = J[0, 0] + 1j * J[1, 0], J[0, 1] + 1j * J[1, 1]
    return abs(fx - 1j * fy) + abs(fx + 1j * fy), abs(fx - 1j * fy) - abs(fx + 1j * fy)


# %% exercise 2: the other order
def singular_values(J):
    fx, fy = J[0, 0] + 1j * J[1, 0], J[0, 1] + 1j * J[1, 1]
    fz, fzbar = (fx - 1j * fy) / 2, (fx + 1j * fy) / 2
    return abs(fz) - abs(fzbar), abs(fz) + abs(fzbar)


# %% exercise 2: eigenvalues
def singular_values(J):
    small, large = sorted(abs(np.linalg.eigvals(J)))
    return large, np.sign(np.linalg.det(J)) * small


# %% exercise 3: right: the right foot
def breaking_pose():
    targets = start.handles.copy()
    targets[1] = 3.0, -1.0
    return start.with_targets(targets)


# %% exercise 3: the hand of the chapter
def breaking_pose():
    return pose(1.0)


# %% exercise 3: two targets
def breaking_pose():
    targets = start.handles.copy()
    targets[0], targets[1] = (-3.0, -1.0), (3.0, -1.0)
    return glid.Pose(start.handles, targets)


# %% exercise 3: the handle goes along
def breaking_pose():
    moved = start.handles.copy()
    moved[0] += 0.5
    return glid.Pose(moved, moved)


# %% exercise 3: too far
def breaking_pose():
    targets = start.handles.copy()
    targets[0] = 200.0, 300.0
    return glid.Pose(start.handles, targets)


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
