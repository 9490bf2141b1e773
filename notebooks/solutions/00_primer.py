# Answers to the exercises of 00_primer.ipynb, run by tests/notebooks.

# %% exercise 1: solution
def most_stretched(fz, fzb):
    """The angle of the direction h, |h| = 1, for which fz h + fzb conj(h) is longest."""
    # fz h has the angle arg fz + theta, fzb conj(h) has arg fzb - theta: make them equal.
    return (np.angle(fzb) - np.angle(fz)) / 2


# %% exercise 1: right: one angle of a quotient
def most_stretched(fz, fzb):
    return np.angle(fzb / fz) / 2


# %% exercise 1: right: by the singular vectors
def most_stretched(fz, fzb):
    one, i = fz + fzb, 1j * (fz - fzb)
    J = np.array([[one.real, i.real], [one.imag, i.imag]])
    x, y = np.linalg.svd(J)[2][0]
    return np.arctan2(y, x)


# %% exercise 1: right: the opposite direction
def most_stretched(fz, fzb):
    return np.angle(fzb * np.conj(fz)) / 2 + np.pi


# %% exercise 1: a typical wrong answer
# The direction in the image, not before the map.
def most_stretched(fz, fzb):
    return (np.angle(fzb) + np.angle(fz)) / 2


# %% exercise 1: without the half
def most_stretched(fz, fzb):
    return np.angle(fzb / fz)


# %% exercise 1: the direction that is stretched least
def most_stretched(fz, fzb):
    return (np.angle(fzb) - np.angle(fz)) / 2 + np.pi / 2


# %% exercise 1: degrees
def most_stretched(fz, fzb):
    return np.degrees(np.angle(fzb) - np.angle(fz)) / 2


# %% exercise 1: forgets f_z
def most_stretched(fz, fzb):
    return np.angle(fzb) / 2


# %% exercise 2: solution
def winding(w):
    """How often the closed curve through the points w, (n,) complex, winds around 0."""
    following = np.append(w[1:], w[0])
    return round(np.angle(following / w).sum() / (2 * np.pi))


# %% exercise 2: right: by the continued angle
def winding(w):
    angle = np.unwrap(np.angle(np.append(w, w[0])))
    return round((angle[-1] - angle[0]) / (2 * np.pi))


# %% exercise 2: right: point by point
def winding(w):
    total = 0.0
    for k in range(len(w)):
        total += np.log(w[k] / w[k - 1]).imag
    return round(total / (2 * np.pi))


# %% exercise 2: a typical wrong answer
# Leaves out the way from the last point to the first, and rounds down.
def winding(w):
    return int(np.angle(w[1:] / w[:-1]).sum() // (2 * np.pi))


# %% exercise 2: not rounded, and not closed
def winding(w):
    return np.angle(w[1:] / w[:-1]).sum() / (2 * np.pi)


# %% exercise 2: differences of principal angles
def winding(w):
    return round(np.diff(np.angle(np.append(w, w[0]))).sum() / (2 * np.pi))


# %% exercise 2: clockwise
def winding(w):
    following = np.append(w[1:], w[0])
    return round(np.angle(w / following).sum() / (2 * np.pi))


# %% exercise 2: without a sign
def winding(w):
    following = np.append(w[1:], w[0])
    return abs(round(np.angle(following / w).sum() / (2 * np.pi)))
