# %% exercise 1: solution
def sigma2_bound(fz, fzb, lipschitz_fz, lipschitz_fzb, length):
    """A lower bound on |f_z| - |f_zbar| on a whole segment.

    fz and fzb hold the two values at the segment's ends.
    """
    fz_min = (abs(fz[0]) + abs(fz[1])) / 2 - lipschitz_fz * length / 2
    fzb_max = (abs(fzb[0]) + abs(fzb[1])) / 2 + lipschitz_fzb * length / 2
    return fz_min - fzb_max


# %% exercise 1: a typical wrong answer
# It takes the smaller of the two ends and forgets what happens between them.
def sigma2_bound(fz, fzb, lipschitz_fz, lipschitz_fzb, length):
    return min(abs(fz[0]) - abs(fzb[0]), abs(fz[1]) - abs(fzb[1]))


# %% exercise 2: solution
def zeros_inside(f, n):
    """The number of zeros of f_z, a whole number: (30) over 2 pi, from about n panels."""
    panels = uniform_panels(f.domain.cage, n)
    at_start, at_end = f.wirtinger(panels.start)[0], f.wirtinger(panels.end)[0]
    return round(np.angle(at_end / at_start).sum() / (2 * np.pi))


# %% exercise 2: a typical wrong answer
# It walks around the exterior only, and leaves the holes out.
def zeros_inside(f, n):
    panels = uniform_panels(f.domain.cage, n)
    outer = panels.loop == 0
    at_start, at_end = f.wirtinger(panels.start[outer])[0], f.wirtinger(panels.end[outer])[0]
    return round(np.angle(at_end / at_start).sum() / (2 * np.pi))


# %% exercise 3: solution
def halved_bound(coefficients):
    """A lower bound on [0, 1] from Bernstein coefficients, after one halving."""
    row = np.asarray(coefficients, dtype=float)
    least = min(row[0], row[-1])
    while len(row) > 1:
        row = (row[:-1] + row[1:]) / 2
        least = min(least, row[0], row[-1])
    return least


# %% exercise 3: a typical wrong answer
# The smallest of many values is an estimate from above; the polynomial may be smaller between them.
def halved_bound(coefficients):
    return bernstein(coefficients, np.linspace(0, 1, 101)).min()
