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
