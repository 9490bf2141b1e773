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


# %% exercise 1: right: the lid in two steps
def lift_lid(deformation):
    for foot in ((1.4, -4.5), (-1.4, -4.5)):
        deformation.add_handle(foot)
    lid = deformation.add_handle((0.0, 4.35))
    for height in (5.0, 6.4):
        deformation.drag(lid, to=(0.0, height))


# %% exercise 1: nothing is dragged
def lift_lid(deformation):
    for point in ((-1.4, -4.5), (1.4, -4.5), (0.0, 4.35)):
        deformation.add_handle(point)


# %% exercise 1: one foot is not held
def lift_lid(deformation):
    deformation.add_handle((-1.4, -4.5))
    lid = deformation.add_handle((0.0, 4.35))
    deformation.drag(lid, to=(3.0, 6.35))


# %% exercise 1: too little
def lift_lid(deformation):
    for foot in ((-1.4, -4.5), (1.4, -4.5)):
        deformation.add_handle(foot)
    deformation.drag(deformation.add_handle((0.0, 4.35)), to=(0.0, 5.35))


# %% exercise 2: right: on the boundary, as a list
def most_stretched(f, cage):
    from glid_nb.geometry import uniform_panels

    points = np.array([[z.real, z.imag] for z in uniform_panels(cage, 2000).start])
    return points[np.argmax(f.sigma1(points))].tolist()


# %% exercise 2: right: finer, and by a loop
def most_stretched(f, cage):
    points = glid.triangulate(cage, 3000).vertices
    return max(points, key=lambda point: f.sigma1(point[None])[0])


# %% exercise 2: the value instead of the place
def most_stretched(f, cage):
    largest = f.sigma1(glid.triangulate(cage, 2000).vertices).max()
    return 10 * largest, 10 * largest


# %% exercise 2: the least stretched
def most_stretched(f, cage):
    points = glid.triangulate(cage, 2000).vertices
    return points[np.argmin(f.sigma1(points))]


# %% exercise 2: the middle
def most_stretched(f, cage):
    return cage.exterior.mean(axis=0)


# %% exercise 2: a place far outside
def most_stretched(f, cage):
    return 30.0, 30.0
