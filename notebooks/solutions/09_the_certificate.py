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


# %% exercise 1: right: in one line each, with numpy's absolute value
def sigma2_bound(fz, fzb, lipschitz_fz, lipschitz_fzb, length):
    sums = np.abs(fz).sum() - np.abs(fzb).sum()
    return 0.5 * (sums - length * (lipschitz_fz + lipschitz_fzb))


# %% exercise 1: right: by two cones from the ends
def sigma2_bound(fz, fzb, lipschitz_fz, lipschitz_fzb, length):
    def meet(first, last, slope):  # where two lines from the ends with this slope meet
        return (first + last + slope * length) / 2

    return meet(*map(abs, fz), -lipschitz_fz) - meet(*map(abs, fzb), lipschitz_fzb)


# %% exercise 1: the worse end, and a whole length
def sigma2_bound(fz, fzb, lipschitz_fz, lipschitz_fzb, length):
    least = min(abs(fz[0]), abs(fz[1])) - lipschitz_fz * length
    return least - max(abs(fzb[0]), abs(fzb[1])) - lipschitz_fzb * length


# %% exercise 1: f_zbar does not move
def sigma2_bound(fz, fzb, lipschitz_fz, lipschitz_fzb, length):
    return (abs(fz[0]) + abs(fz[1]) - lipschitz_fz * length) / 2 - (abs(fzb[0]) + abs(fzb[1])) / 2


# %% exercise 1: without moduli
def sigma2_bound(fz, fzb, lipschitz_fz, lipschitz_fzb, length):
    sums = np.real(fz[0] + fz[1]) - np.real(fzb[0] + fzb[1])
    return 0.5 * (sums - length * (lipschitz_fz + lipschitz_fzb))


# %% exercise 1: the mean of the ends
def sigma2_bound(fz, fzb, lipschitz_fz, lipschitz_fzb, length):
    return (abs(fz[0]) + abs(fz[1]) - abs(fzb[0]) - abs(fzb[1])) / 2


# %% exercise 2: right: by the logarithm
def zeros_inside(f, n):
    panels = uniform_panels(f.domain.cage, n)
    at_start, at_end = f.wirtinger(panels.start)[0], f.wirtinger(panels.end)[0]
    return int(np.rint(np.log(at_end / at_start).imag.sum() / (2 * np.pi)))


# %% exercise 2: right: loop by loop, as a float that is a whole number
def zeros_inside(f, n):
    panels = uniform_panels(f.domain.cage, n)
    total = 0.0
    for loop in range(panels.loop.max() + 1):
        values = f.wirtinger(panels.start[panels.loop == loop])[0]
        angles = np.unwrap(np.angle(np.append(values, values[0])))
        total += np.round((angles[-1] - angles[0]) / (2 * np.pi))
    return total


# %% exercise 2: not rounded
def zeros_inside(f, n):
    panels = uniform_panels(f.domain.cage, n)
    at_start, at_end = f.wirtinger(panels.start)[0], f.wirtinger(panels.end)[0]
    return np.angle(at_end / at_start).sum() / (2 * np.pi)


# %% exercise 2: the angle is not divided by a turn
def zeros_inside(f, n):
    panels = uniform_panels(f.domain.cage, n)
    at_start, at_end = f.wirtinger(panels.start)[0], f.wirtinger(panels.end)[0]
    return round(np.angle(at_end / at_start).sum())


# %% exercise 2: f_zbar
def zeros_inside(f, n):
    panels = uniform_panels(f.domain.cage, n)
    at_start, at_end = (f(points) @ [1, 1j] for points in (panels.start, panels.end))
    return round(np.angle(at_end / at_start).sum() / (2 * np.pi))


# %% exercise 2: differences of principal angles
# Each jump of the principal angle takes a turn back, so the sum is always 0.
def zeros_inside(f, n):
    panels = uniform_panels(f.domain.cage, n)
    at_start, at_end = f.wirtinger(panels.start)[0], f.wirtinger(panels.end)[0]
    return round((np.angle(at_end) - np.angle(at_start)).sum() / (2 * np.pi))


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


# %% exercise 2: right: through the course's own sums, which need the derivatives only
def zeros_inside(f, n):
    panels = uniform_panels(f.domain.cage, n)
    starts = f.wirtinger(panels.start)[0]
    ends = f.wirtinger(panels.end)[0]
    turns = [np.angle(ends / starts)[panels.loop == i].sum() for i in range(1 + panels.loop.max())]
    return int(np.rint(np.sum(turns) / (2 * np.pi)))
