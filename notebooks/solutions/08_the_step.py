# %% exercise 1: solution
def largest_step(fz, fzb, dfz, dfzb):
    """The least t > 0 with |fz + t dfz| = |fzb + t dfzb| at a sample, or infinity."""
    a = abs(dfz) ** 2 - abs(dfzb) ** 2
    b = 2 * (np.conj(fz) * dfz - np.conj(fzb) * dfzb).real
    c = abs(fz) ** 2 - abs(fzb) ** 2
    root = np.sqrt(np.maximum(b * b - 4 * a * c, 0))
    folds = (b * b >= 4 * a * c) & (root > b)
    return np.min(np.where(folds, 2 * c / np.where(folds, root - b, 1), np.inf))


# %% exercise 1: a typical wrong answer
# It takes the other root of each parabola, which is negative or the later one.
def largest_step(fz, fzb, dfz, dfzb):
    a = abs(dfz) ** 2 - abs(dfzb) ** 2
    b = 2 * (np.conj(fz) * dfz - np.conj(fzb) * dfzb).real
    c = abs(fz) ** 2 - abs(fzb) ** 2
    root = np.sqrt(np.maximum(b * b - 4 * a * c, 0))
    later = (root - b) / (2 * a)
    return np.min(np.where((b * b >= 4 * a * c) & (later > 0), later, np.inf))


# %% exercise 2: solution
def backtrack(energy, slope, first, certified):
    """Halve the step, beginning with first, until it passes both tests of Algorithm 1.

    energy(t) and certified(t) are functions of the step, slope is energy's derivative at 0.
    """
    t = first
    while not (energy(t) < energy(0.0) + 1e-4 * t * slope and certified(t)):
        t = t / 2
    return t


# %% exercise 2: a typical wrong answer
# It is content with any decrease and never asks for a proof.
def backtrack(energy, slope, first, certified):
    t = first
    while not energy(t) < energy(0.0):
        t = t / 2
    return t


# %% exercise 3: solution
def longest_certified(line, longest):
    """A certified step within 1 % of one that is not; the step longest is not."""
    good, bad = 0.0, longest
    while bad > 1.01 * good:
        middle = (good + bad) / 2
        if glid.certify(line(middle)).certified:
            good = middle
        else:
            bad = middle
    return good


# %% exercise 3: a typical wrong answer
# It asks 20 samples instead of the certificate.
def longest_certified(line, longest):
    few = uniform_panels(bar.cage, 20).start
    good, bad = 0.0, longest
    while bad > 1.01 * good:
        middle = (good + bad) / 2
        if line(middle).sigma2(few).min() > 0:
            good = middle
        else:
            bad = middle
    return good


# %% exercise 1: right: a loop with numpy.roots
def largest_step(fz, fzb, dfz, dfzb):
    least = np.inf
    for f, g, df, dg in zip(fz, fzb, dfz, dfzb):
        a = abs(df) ** 2 - abs(dg) ** 2
        b = 2 * (np.conj(f) * df - np.conj(g) * dg).real
        for root in np.roots([a, b, abs(f) ** 2 - abs(g) ** 2]):
            if abs(root.imag) < 1e-12 and root.real > 0:
                least = min(least, root.real)
    return least


# %% exercise 1: right: both roots by the stable formula
def largest_step(fz, fzb, dfz, dfzb):
    a = abs(dfz) ** 2 - abs(dfzb) ** 2
    b = 2 * (np.conj(fz) * dfz - np.conj(fzb) * dfzb).real
    c = abs(fz) ** 2 - abs(fzb) ** 2
    with np.errstate(all="ignore"):
        q = -(b + np.where(b >= 0, 1, -1) * np.sqrt(b * b - 4 * a * c)) / 2
        both = np.concatenate([q / a, c / q])
    return min(both[np.isfinite(both) & (both > 0)], default=np.inf)


# %% exercise 1: where f_z vanishes
def largest_step(fz, fzb, dfz, dfzb):
    return np.min(np.where(dfz == 0, np.inf, abs(fz) / np.where(dfz == 0, 1, abs(dfz))))


# %% exercise 1: a lower bound
def largest_step(fz, fzb, dfz, dfzb):
    return np.min((abs(fz) - abs(fzb)) / (abs(dfz) + abs(dfzb)))


# %% exercise 1: the full step
def largest_step(fz, fzb, dfz, dfzb):
    return 1.0


# %% exercise 1: never
def largest_step(fz, fzb, dfz, dfzb):
    return np.inf


# %% exercise 2: right: a loop that returns
def backtrack(energy, slope, first, certified):
    here = energy(0.0)
    for k in range(60):
        t = first * 0.5**k
        if energy(t) < here + 1e-4 * slope * t and certified(t):
            return t
    return 0.0


# %% exercise 2: right: by recursion
def backtrack(energy, slope, first, certified):
    enough = energy(first) < energy(0.0) + 1e-4 * first * slope
    if enough and certified(first):
        return first
    return backtrack(energy, slope, first / 2, certified)


# %% exercise 2: the certificate first
def backtrack(energy, slope, first, certified):
    t = first
    while not (certified(t) and energy(t) < energy(0.0) + 1e-4 * t * slope):
        t = t / 2
    return t


# %% exercise 2: any decrease will do
def backtrack(energy, slope, first, certified):
    t = first
    while not (energy(t) < energy(0.0) and certified(t)):
        t = t / 2
    return t


# %% exercise 2: the energy is not asked
def backtrack(energy, slope, first, certified):
    t = first
    while not certified(t):
        t = t / 2
    return t


# %% exercise 2: a tenth instead of a half
def backtrack(energy, slope, first, certified):
    t = first
    while not (energy(t) < energy(0.0) + 1e-4 * t * slope and certified(t)):
        t = t / 10
    return t


# %% exercise 3: right: a fixed number of halvings
def longest_certified(line, longest):
    good, length = 0.0, longest
    for _ in range(12):
        length /= 2
        if glid.certify(line(good + length)).certified:
            good += length
    return good


# %% exercise 3: one halving
def longest_certified(line, longest):
    t = longest
    while not glid.certify(line(t)).certified:
        t /= 2
    return t


# %% exercise 3: the one that is not certified
def longest_certified(line, longest):
    good, bad = 0.0, longest
    while bad > 1.01 * good:
        middle = (good + bad) / 2
        if glid.certify(line(middle)).certified:
            good = middle
        else:
            bad = middle
    return bad


# %% exercise 3: no step
def longest_certified(line, longest):
    return 0.0


# %% exercise 3: the whole step
def longest_certified(line, longest):
    return longest


# %% exercise 1: right: in jax.numpy
def largest_step(fz, fzb, dfz, dfzb):
    import jax.numpy as jnp

    a = jnp.abs(dfz) ** 2 - jnp.abs(dfzb) ** 2
    b = 2 * (jnp.conj(fz) * dfz - jnp.conj(fzb) * dfzb).real
    c = jnp.abs(fz) ** 2 - jnp.abs(fzb) ** 2
    root = jnp.sqrt(jnp.maximum(b * b - 4 * a * c, 0))
    folds = (b * b >= 4 * a * c) & (root > b)
    return jnp.min(jnp.where(folds, 2 * c / jnp.where(folds, root - b, 1), jnp.inf))
