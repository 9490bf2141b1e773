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


# %% exercise 1: the suggested pose
def my_pose():
    return first


# %% exercise 1: the suggested pose in another order, a little moved
def my_pose():
    return glid.Pose(first.handles[::-1], first.targets[::-1] + 0.05)


# %% exercise 1: the suggested pose, moved as a whole
def my_pose():
    return glid.Pose(first.handles, first.targets + [4.0, 0.0])


# %% exercise 1: everything is moved
def my_pose():
    handles = np.array([[-1.4, -4.5], [1.4, -4.5], [-6.4, 2.35], [0.0, 4.35], [6.42, 0.0]])
    return glid.Pose(handles, handles + 3)


# %% exercise 1: everything is turned
def my_pose():
    handles = np.array([[-1.4, -4.5], [1.4, -4.5], [-6.4, 2.35], [0.0, 4.35], [6.42, 0.0]])
    return glid.Pose(handles, handles[:, ::-1] * [1, -1])


# %% exercise 1: right: the suggested handles with a target of one's own
def my_pose():
    targets = first.handles.copy()
    farthest = np.argmax(np.linalg.norm(targets - targets.mean(axis=0), axis=1))
    targets[farthest] += [0.0, 3.5]
    return first.with_targets(targets)


# %% exercise 1: right: by hand in an editing session
def my_pose():
    from contextlib import closing

    with closing(glid.session.Deformation(domain)) as editing:
        for foot in ((-1.4, -4.5), (1.4, -4.5)):
            editing.add_handle(foot)
        editing.add_handle((6.42, 0.0))
        spout = editing.add_handle((-6.4, 2.35))
        editing.drag(spout, to=(-6.0, 5.5))
        return editing.pose


# %% exercise 2: solution
def promises(f):
    proof = glid.certify(f)
    # Directions at the angles a and -a to the long axis turn towards it by arcsin(k) each, if
    # tan(a) is the square root of sigma_1 / sigma_2.
    turn = np.degrees(2 * np.arcsin(proof.k_upper))
    return proof.sigma2_lower, proof.sigma1_upper, turn


# %% exercise 2: right: from the ratio of the axes, by the tangent
def promises(f):
    proof = glid.certify(f)
    ratio = (1 + proof.k_upper) / (1 - proof.k_upper)
    before, after = np.arctan(ratio**-0.5), np.arctan(ratio**0.5)
    return proof.sigma2_lower, proof.sigma1_upper, 2 * np.degrees(after - before)


# %% exercise 2: right: by trying directions on the ellipse
def promises(f):
    proof = glid.certify(f)
    ratio = (1 + proof.k_upper) / (1 - proof.k_upper)
    angle = np.linspace(0, np.pi / 2, 100_001)
    turned = np.arctan2(np.sin(angle) * ratio, np.cos(angle)) - angle
    turn = 2 * np.degrees(turned.max()) + 0.001
    return [proof.sigma2_lower, proof.sigma1_upper, turn]


# %% exercise 2: one call
# The certificate has no bound on angles: 1 is the whole range of k.
def promises(f):
    proof = glid.certify(f)
    return proof.sigma2_lower, proof.sigma1_upper, proof.k_upper


# %% exercise 2: only one direction turns
def promises(f):
    proof = glid.certify(f)
    turn = np.degrees(np.arcsin(proof.k_upper))
    return proof.sigma2_lower, proof.sigma1_upper, turn


# %% exercise 2: radians
def promises(f):
    proof = glid.certify(f)
    return proof.sigma2_lower, proof.sigma1_upper, 2 * np.arcsin(proof.k_upper)


# %% exercise 2: the worst axes of different points
# The longest and the shortest axis belong to different points: true, but careless.
def promises(f):
    low, high = glid.certify(f).sigma2_lower, glid.certify(f).sigma1_upper
    return low, high, np.degrees(2 * np.arcsin((high - low) / (high + low)))


# %% exercise 2: a typical wrong answer
# Samples bound nothing between them.
def promises(f):
    points = glid.triangulate(f.domain.cage, 500).vertices
    low, high = f.sigma2(points).min(), f.sigma1(points).max()
    k = (f.sigma1(points) - f.sigma2(points)) / (f.sigma1(points) + f.sigma2(points))
    return low, high, np.degrees(2 * np.arcsin(k.max()))


# %% exercise 2: many samples and a margin
# A margin is a guess: the dent lies between two of the samples, and is deeper than the margin.
def promises(f):
    low, high, k = np.inf, 0.0, 0.0
    for loop in f.domain.cage.loops:
        for a, b in zip(loop, np.roll(loop, -1, axis=0)):
            points = a + np.linspace(0, 1, 5_000)[:, None] * (b - a)
            small, large = f.sigma2(points), f.sigma1(points)
            low, high = min(low, small.min()), max(high, large.max())
            k = max(k, ((large - small) / (large + small)).max())
    return 0.98 * low, 1.02 * high, 1.02 * np.degrees(2 * np.arcsin(k))


# %% exercise 3: solution
def hand_in(folder, image, result):
    result.map.save(folder / "map.json")
    result.certificate.save(folder / "proof.json")
    (folder / "picture.png").write_bytes(glid.export.picture_png(image, result.map))


# %% exercise 3: right: a larger picture, and the proof made anew
def hand_in(folder, image, result):
    f = result.map
    f.save(folder / "map.json")
    glid.certify(f).save(folder / "proof.json")
    picture = glid.render(image, f, size=(700, 700))
    from PIL import Image

    Image.fromarray(picture).save(folder / "picture.png")


# %% exercise 3: right: other files beside them, and paths as text
def hand_in(folder, image, result):
    result.map.save(f"{folder}/map.json")
    result.certificate.save(f"{folder}/proof.json")
    with open(f"{folder}/picture.png", "wb") as file:
        file.write(glid.export.picture_png(image, result.map))
    with open(f"{folder}/report.md", "w") as file:
        file.write("The spout looks up.")


# %% exercise 3: the proof of another map
def hand_in(folder, image, result):
    result.map.save(folder / "map.json")
    glid.certify(rest).save(folder / "proof.json")
    (folder / "picture.png").write_bytes(glid.export.picture_png(image, result.map))


# %% exercise 3: a typical wrong answer
# Two maps and no proof: the file has the right name and says nothing about folding.
def hand_in(folder, image, result):
    result.map.save(folder / "map.json")
    result.map.save(folder / "proof.json")
    (folder / "picture.png").write_bytes(glid.export.picture_png(image, result.map))


# %% exercise 3: a blank picture
def hand_in(folder, image, result):
    from PIL import Image

    result.map.save(folder / "map.json")
    result.certificate.save(folder / "proof.json")
    blank = np.full((300, 300, 4), 255, np.uint8)
    Image.fromarray(blank).save(folder / "picture.png")


# %% exercise 3: the picture at rest
def hand_in(folder, image, result):
    result.map.save(folder / "map.json")
    result.certificate.save(folder / "proof.json")
    (folder / "picture.png").write_bytes(glid.export.picture_png(image, rest))


# %% exercise 3: the suggested map
def hand_in(folder, image, result):
    suggested.save(folder / "map.json")
    glid.certify(suggested).save(folder / "proof.json")
    (folder / "picture.png").write_bytes(glid.export.picture_png(image, suggested))
