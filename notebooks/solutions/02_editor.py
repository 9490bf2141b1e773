# Answers to the exercises of 02_editor.ipynb, run by tests/notebooks.

# %% exercise 1: solution
def lift_lid(deformation):
    for foot in ((-1.4, -4.5), (1.4, -4.5)):
        deformation.add_handle(foot)
    lid = deformation.add_handle((0.0, 4.35))
    deformation.drag(lid, to=(0.0, 6.35))


# %% exercise 1: a typical wrong answer
# One handle alone takes the whole teapot with it.
def lift_lid(deformation):
    lid = deformation.add_handle((0.0, 4.35))
    deformation.drag(lid, to=(0.0, 6.35))


# %% exercise 2: solution
def most_stretched(f, cage):
    points = glid.triangulate(cage, 2000).vertices
    return points[np.argmax(f.sigma1(points))]


# %% exercise 2: a typical wrong answer
# Looks at the handles alone.
def most_stretched(f, cage):
    points = editor.pose.handles
    return points[np.argmax(f.sigma1(points))]
