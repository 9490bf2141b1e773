# Answers to the exercises of 12_what_lies_between.ipynb, run by tests/notebooks.
# %% exercise 1: solution
def shortest(first, last):
    """The least modulus of (1 - t) first + t last for t in [0, 1]; both complex."""
    step = last - first
    t = 0 if step == 0 else -(np.conj(step) * first).real / abs(step) ** 2
    return abs(first + np.clip(t, 0, 1) * step)


# %% exercise 1: a typical wrong answer
# It measures the distance of 0 from the infinite line.
def shortest(first, last):
    step = last - first
    return abs((np.conj(step) * first).imag) / abs(step)


# %% exercise 2: solution
def between(fz, fzb, t):
    """f_z and f_zbar at time t along a loop, (n,); fz and fzb are (2, n), at t = 0, 1."""
    logs = np.log(abs(fz)) + 1j * np.unwrap(np.angle(fz), axis=1)
    nus = np.conj(fzb) / fz
    a = np.exp((1 - t) * logs[0] + t * logs[1])
    nu = (1 - t) * nus[0] + t * nus[1]
    return a, np.conj(nu * a)


# %% exercise 2: a typical wrong answer
# numpy.log takes the principal angle at each point by itself.
def between(fz, fzb, t):
    a = np.exp((1 - t) * np.log(fz[0]) + t * np.log(fz[1]))
    nus = np.conj(fzb) / fz
    return a, np.conj(((1 - t) * nus[0] + t * nus[1]) * a)


# %% exercise 3: solution
def all_times_bound(fz, fzb):
    """A lower bound on |f_z| - |f_zbar| for all t in [0, 1].

    fz and fzb hold the complex values at t = 0 and t = 1, between which both move straight.
    """
    u = np.exp(2j * np.pi * np.arange(720) / 720)
    at_ends = [(np.conj(u) * a).real - abs(b) for a, b in zip(fz, fzb)]
    return np.min(at_ends, axis=0).max()


# %% exercise 3: a typical wrong answer
# It takes the better direction for each end by itself: no common u.
def all_times_bound(fz, fzb):
    return min(abs(a) - abs(b) for a, b in zip(fz, fzb))


# %% exercise 3: samples of time
# It takes samples of time, which prove nothing.
def all_times_bound(fz, fzb):
    t = np.linspace(0, 1, 2001)
    return min(abs((1 - t) * fz[0] + t * fz[1]) - abs((1 - t) * fzb[0] + t * fzb[1]))


# %% exercise 1: right: by cases
def shortest(first, last):
    step = last - first
    if (np.conj(first) * step).real >= 0:
        return abs(first)
    if (np.conj(last) * step).real <= 0:
        return abs(last)
    return abs((np.conj(step) * first).imag) / abs(step)


# %% exercise 1: right: by Shapely
def shortest(first, last):
    import shapely

    ends = [(complex(z).real, complex(z).imag) for z in (first, last)]
    return shapely.Point(0, 0).distance(shapely.LineString(ends))


# %% exercise 1: the shorter end
def shortest(first, last):
    return min(abs(first), abs(last))


# %% exercise 1: the middle
def shortest(first, last):
    return abs(first + last) / 2


# %% exercise 1: the way around 0
def shortest(first, last):
    return np.sqrt(abs(first) * abs(last))


# %% exercise 1: the place instead of the length
def shortest(first, last):
    step = last - first
    t = 0 if step == 0 else -(np.conj(step) * first).real / abs(step) ** 2
    return np.clip(t, 0, 1)


# %% exercise 2: right: moduli and angles apart
def between(fz, fzb, t):
    share = np.array([1 - t, t])
    size = np.exp(share @ np.log(abs(fz)))
    angle = share @ np.unwrap(np.angle(fz))
    a = size * np.exp(1j * angle)
    return a, (share @ (np.conj(fzb) / fz) * a).conj()


# %% exercise 2: right: the angle added up along the loop
def between(fz, fzb, t):
    steps = np.log(fz[:, 1:] / fz[:, :-1])
    start = np.log(fz[:, :1])
    logs = np.concatenate([start, start + np.cumsum(steps, axis=1)], axis=1)
    a = np.exp(logs[0] ** 1 * (1 - t) + logs[1] * t)
    nu = (1 - t) * np.conj(fzb[0]) / fz[0] + t * np.conj(fzb[1]) / fz[1]
    return a, np.conj(nu * a)


# %% exercise 2: blended straight
def between(fz, fzb, t):
    return (1 - t) * fz[0] + t * fz[1], (1 - t) * fzb[0] + t * fzb[1]


# %% exercise 2: f_zbar is blended straight
def between(fz, fzb, t):
    logs = np.log(abs(fz)) + 1j * np.unwrap(np.angle(fz), axis=1)
    return np.exp((1 - t) * logs[0] + t * logs[1]), (1 - t) * fzb[0] + t * fzb[1]


# %% exercise 2: the first end
def between(fz, fzb, t):
    return fz[0], fzb[0]


# %% exercise 2: nu without the conjugate
def between(fz, fzb, t):
    logs = np.log(abs(fz)) + 1j * np.unwrap(np.angle(fz), axis=1)
    nus = fzb / fz
    a = np.exp((1 - t) * logs[0] + t * logs[1])
    return a, ((1 - t) * nus[0] + t * nus[1]) * a


# %% exercise 3: right: a loop over angles
def all_times_bound(fz, fzb):
    best = -np.inf
    for angle in np.linspace(-np.pi, np.pi, 1001):
        u = np.exp(-1j * angle)
        ends = [np.real(u * a) - abs(b) for a, b in zip(fz, fzb)]
        best = max(best, min(ends))
    return best


# %% exercise 3: right: by an optimiser, from many starts
def all_times_bound(fz, fzb):
    def bound(angle):
        u = np.exp(-1j * angle)
        return min(np.real(u * fz[0]) - abs(fzb[0]), np.real(u * fz[1]) - abs(fzb[1]))

    angles = np.linspace(0, 2 * np.pi, 400)
    start = max(angles, key=bound)
    return max(map(bound, np.linspace(start - 0.02, start + 0.02, 41)))


# %% exercise 3: the direction of the mean
def all_times_bound(fz, fzb):
    u = (fz[0] + fz[1]) / abs(fz[0] + fz[1])
    return min((np.conj(u) * a).real - abs(b) for a, b in zip(fz, fzb))


# %% exercise 3: without f_zbar
def all_times_bound(fz, fzb):
    u = np.exp(2j * np.pi * np.arange(720) / 720)
    return np.min([(np.conj(u) * a).real for a in fz], axis=0).max()


# %% exercise 3: the middle only
def all_times_bound(fz, fzb):
    return abs(fz[0] + fz[1]) / 2 - abs(fzb[0] + fzb[1]) / 2
