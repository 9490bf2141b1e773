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
