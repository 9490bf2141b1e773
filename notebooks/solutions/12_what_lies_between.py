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


# %% exercise 3: a typical wrong answer
# It takes samples of time, which prove nothing.
def all_times_bound(fz, fzb):
    t = np.linspace(0, 1, 2001)
    return min(abs((1 - t) * fz[0] + t * fz[1]) - abs((1 - t) * fzb[0] + t * fzb[1]))
