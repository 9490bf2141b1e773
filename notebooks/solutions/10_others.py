# %% exercise 1: solution
def iterations_to(result, best, gap):
    """The first iteration with an energy of at most (1 + gap) * best, None if never."""
    for iteration in [result.initial, *result.history]:
        if iteration.energy <= (1 + gap) * best:
            return iteration.iteration
    return None


# %% exercise 1: a typical wrong answer
# It counts the iterations until the method stops, wherever it stops.
def iterations_to(result, best, gap):
    return result.iterations


# %% exercise 2: solution
def two_loop(gradient, pairs):
    """The inverse Hessian of the pairs (s, y), oldest first, applied to a gradient."""
    q, alphas = gradient.copy(), []
    for s, y in reversed(pairs):
        alphas.append((s @ q) / (s @ y))
        q = q - alphas[-1] * y
    for (s, y), alpha in zip(pairs, reversed(alphas), strict=True):
        q = q + (alpha - (y @ q) / (s @ y)) * s
    return q


# %% exercise 2: a typical wrong answer
# It leaves the second loop out.
def two_loop(gradient, pairs):
    q = gradient.copy()
    for s, y in reversed(pairs):
        q = q - (s @ q) / (s @ y) * y
    return q


# %% exercise 3: solution
def area_mean(f, points, h=1e-6):
    """The mean of E_iso over points inside, by finite differences of the map itself."""
    across = (f(points + np.array([h, 0])) - f(points - np.array([h, 0]))) / (2 * h)
    up = (f(points + np.array([0, h])) - f(points - np.array([0, h]))) / (2 * h)
    squares = np.sum(across**2 + up**2, axis=1)
    det = across[:, 0] * up[:, 1] - across[:, 1] * up[:, 0]
    return np.mean(squares * (1 + det**-2) / 2)


# %% exercise 3: a typical wrong answer
# It forgets the inverse's half of E_iso, so that shrinking looks free.
def area_mean(f, points, h=1e-6):
    across = (f(points + np.array([h, 0])) - f(points - np.array([h, 0]))) / (2 * h)
    up = (f(points + np.array([0, h])) - f(points - np.array([0, h]))) / (2 * h)
    return np.mean(np.sum(across**2 + up**2, axis=1))
