# Answers to the exercises of 05_holes.ipynb, run by tests/notebooks.

# %% exercise 1: solution
def count(vertices_of_loops):
    """Real unknowns of the harmonic maps on a domain whose offset cage has such loops."""
    holes = len(vertices_of_loops) - 1
    n = sum(vertices_of_loops) + holes
    return 4 * n - 10 * holes - 2


# %% exercise 1: a typical wrong answer
# Forgets that the two halves of each logarithm's coefficient are tied.
def count(vertices_of_loops):
    """Real unknowns of the harmonic maps on a domain whose offset cage has such loops."""
    holes = len(vertices_of_loops) - 1
    n = sum(vertices_of_loops) + holes
    return 4 * n - 8 * holes - 2


# %% exercise 2: solution
def find_omega(f, radius=6.0):
    """The coefficient omega of ln|z| in (3), from f_z on a circle."""
    points = circle(radius, 400)
    fz, _ = f.wirtinger(points)
    z = points @ [1, 1j]
    # On the circle dz = i z dtheta, and f_z has the term (omega / 2) / z.
    integral = (fz * 1j * z).mean() * 2 * np.pi
    return integral / (np.pi * 1j)


# %% exercise 2: a typical wrong answer
# Divides by 2 pi i, as for a residue: that is phi, half of omega.
def find_omega(f, radius=6.0):
    """The coefficient omega of ln|z| in (3), from f_z on a circle."""
    points = circle(radius, 400)
    fz, _ = f.wirtinger(points)
    z = points @ [1, 1j]
    integral = (fz * 1j * z).mean() * 2 * np.pi
    return integral / (2j * np.pi)


# %% exercise 3: solution
def largest_shift(r, R):
    """Length of the largest shift of the hole by a logarithm alone."""
    # sigma_2 = 1 - omega / |z| at the worst point, which lies at |z| = r.
    return r * np.log(R / r)


# %% exercise 3: a typical wrong answer
# Takes f_z alone, which vanishes at z = -omega / 2, and forgets f_zbar.
def largest_shift(r, R):
    """Length of the largest shift of the hole by a logarithm alone."""
    return 2 * r * np.log(R / r)


# %% exercise 3: another wrong answer
# Right for the ring of this chapter alone.
def largest_shift(r, R):
    """Length of the largest shift of the hole by a logarithm alone."""
    return 4 * np.log(2.5)


# %% exercise 1: right: loop by loop
def count(vertices_of_loops):
    outer, *holes = vertices_of_loops
    return 4 * outer - 2 + sum(4 * (m + 1) - 10 for m in holes)


# %% exercise 1: right: as a whole number of numpy
def count(vertices_of_loops):
    sizes = np.asarray(vertices_of_loops)
    return 4 * sizes.sum() - 6 * (len(sizes) - 1) - 2


# %% exercise 1: all of them
def count(vertices_of_loops):
    return 4 * (sum(vertices_of_loops) + len(vertices_of_loops) - 1)


# %% exercise 1: without the logarithms
def count(vertices_of_loops):
    return 4 * sum(vertices_of_loops) - 10 * (len(vertices_of_loops) - 1) - 2


# %% exercise 1: complex numbers
def count(vertices_of_loops):
    holes = len(vertices_of_loops) - 1
    return 2 * (sum(vertices_of_loops) + holes) - 5 * holes - 1


# %% exercise 1: right: a whole number as a float
def count(vertices_of_loops):
    holes = len(vertices_of_loops) - 1
    return 4.0 * (sum(vertices_of_loops) + holes) - 10 * holes - 2


# %% exercise 1: no whole number
def count(vertices_of_loops):
    holes = len(vertices_of_loops) - 1
    return 4 * (sum(vertices_of_loops) + holes) - 10 * holes - 2.5


# %% exercise 2: right: the mean of z f_z
def find_omega(f, radius=6.0):
    points = circle(radius, 200)
    return 2 * np.mean(f.wirtinger(points)[0] * (points @ [1, 1j]))


# %% exercise 2: right: a sum over chords
def find_omega(f, radius=6.0):
    turn = np.exp(2j * np.pi * np.arange(4001) / 4000)
    z = radius * turn
    middle = radius * np.sqrt(turn[1:] * turn[:-1])
    middle *= np.sign((middle / z[:-1]).real)
    fz, _ = f.wirtinger(np.stack([middle.real, middle.imag], axis=1))
    return (fz * np.diff(z)).sum() / (1j * np.pi)


# %% exercise 2: the mean of f_z
def find_omega(f, radius=6.0):
    return f.wirtinger(circle(radius, 400))[0].mean()


# %% exercise 2: f_zbar, without conjugation
def find_omega(f, radius=6.0):
    points = circle(radius, 400)
    return 2 * np.mean(f.wirtinger(points)[1] * (points @ [1, 1j]))


# %% exercise 2: once more the radius
def find_omega(f, radius=6.0):
    points = circle(radius, 400)
    return 2 * radius * np.mean(f.wirtinger(points)[0] * (points @ [1, 1j]))


# %% exercise 2: clockwise
def find_omega(f, radius=6.0):
    points = circle(radius, 400)
    return -2 * np.mean(f.wirtinger(points)[0] * (points @ [1, 1j]))


# %% exercise 3: right: by bisection on the fold
def largest_shift(r, R):
    low, high = 0.0, 2 * r
    for _ in range(60):
        omega = (low + high) / 2
        low, high = (omega, high) if abs(1 - omega / (2 * r)) > omega / (2 * r) else (low, omega)
    return low * np.log(R / r)


# %% exercise 3: right: as numbers of numpy
def largest_shift(r, R):
    return -r * np.log(np.float64(r) / R)


# %% exercise 3: the width of the ring
def largest_shift(r, R):
    return R - r


# %% exercise 3: the outer radius
def largest_shift(r, R):
    return R * np.log(R / r)


# %% exercise 3: omega itself
def largest_shift(r, R):
    return r


# %% exercise 3: negative, so it is no length
def largest_shift(r, R):
    return r * np.log(r / R)
