# Answers to the exercises of 01_quickstart.ipynb, run by tests/notebooks.

# %% exercise 1: solution
def another_pose():
    targets = pose.targets.copy()
    targets[0] += [0.8, 0.8]
    return glid.Pose(pose.handles, targets)


# %% exercise 1: a typical wrong answer
# Moves the handle along with its target: another point of the frog is held.
def another_pose():
    handles, targets = pose.handles.copy(), pose.targets.copy()
    handles[0] += [0.8, 0.8]
    targets[0] += [0.8, 0.8]
    return glid.Pose(handles, targets)


# %% exercise 2: solution
def length_after(result, length):
    bounds = result.certificate
    return bounds.sigma2_lower * length, bounds.sigma1_upper * length


# %% exercise 2: a typical wrong answer
# Asks the handles, and not every point.
def length_after(result, length):
    at = pose.handles
    return result.map.sigma2(at).min() * length, result.map.sigma1(at).max() * length


# %% exercise 1: right: with_targets, another handle
def another_pose():
    targets = np.array(pose.targets)
    targets[-1, 1] += 1.0
    return pose.with_targets(targets)


# %% exercise 1: right: as lists
def another_pose():
    targets = [list(target) for target in pose.targets]
    targets[1] = [targets[1][0] - 1.0, targets[1][1]]
    return glid.Pose(pose.handles.tolist(), targets)


# %% exercise 1: two targets
def another_pose():
    targets = pose.targets.copy()
    targets[:2] += 1.0
    return pose.with_targets(targets)


# %% exercise 1: too little
def another_pose():
    targets = pose.targets.copy()
    targets[0] += 0.3
    return pose.with_targets(targets)


# %% exercise 1: all targets
def another_pose():
    return pose.with_targets(pose.targets + 1.0)


# %% exercise 1: too far
def another_pose():
    targets = pose.targets.copy()
    targets[0] += 12.0
    return pose.with_targets(targets)


# %% exercise 2: right: from the map's own proof
def length_after(result, length):
    proof = glid.certify(result.map)
    return [length * proof.sigma2_lower, length * proof.sigma1_upper]


# %% exercise 2: right: as an array
def length_after(result, length):
    bounds = result.certificate
    return length * np.array([bounds.sigma2_lower, bounds.sigma1_upper])


# %% exercise 2: samples inside
def length_after(result, length):
    points = glid.triangulate(cage, 300).vertices
    return result.map.sigma2(points).min() * length, result.map.sigma1(points).max() * length


# %% exercise 2: the length stays
def length_after(result, length):
    return length, length


# %% exercise 2: the factors without the length
def length_after(result, length):
    return result.certificate.sigma2_lower, result.certificate.sigma1_upper


# %% exercise 2: half and twice
def length_after(result, length):
    return 0.5 * length, 2.0 * length
