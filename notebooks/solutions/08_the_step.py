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
