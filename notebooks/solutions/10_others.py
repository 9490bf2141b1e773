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


# %% exercise 1: right: next with a default
def iterations_to(result, best, gap):
    enough = (1 + gap) * best
    energies = [result.initial.energy] + [one.energy for one in result.history]
    return next((i for i, energy in enumerate(energies) if energy <= enough), None)


# %% exercise 1: right: the smallest number of all
def iterations_to(result, best, gap):
    every = (result.initial, *result.history)
    return min((i.iteration for i in every if i.energy <= best * (1 + gap)), default=None)


# %% exercise 1: without the start
def iterations_to(result, best, gap):
    for iteration in result.history:
        if iteration.energy <= (1 + gap) * best:
            return iteration.iteration
    return None


# %% exercise 1: the last one
def iterations_to(result, best, gap):
    found = None
    for iteration in [result.initial, *result.history]:
        if iteration.energy <= (1 + gap) * best:
            found = iteration.iteration
    return found


# %% exercise 1: the gap as a difference
def iterations_to(result, best, gap):
    for iteration in [result.initial, *result.history]:
        if iteration.energy <= best + gap * 1e3:
            return iteration.iteration
    return None


# %% exercise 1: zero if never
def iterations_to(result, best, gap):
    for iteration in [result.initial, *result.history]:
        if iteration.energy <= (1 + gap) * best:
            return iteration.iteration
    return 0


# %% exercise 1: zero if ever
def iterations_to(result, best, gap):
    energies = [one.energy for one in [result.initial, *result.history]]
    return 0 if min(energies) <= (1 + gap) * best else None


# %% exercise 1: always the same gap
def iterations_to(result, best, gap):
    for iteration in [result.initial, *result.history]:
        if iteration.energy <= (1 + 1e-3) * best:
            return iteration.iteration
    return None


# %% exercise 1: never within a small gap
def iterations_to(result, best, gap):
    if result.start_energy <= (1 + gap) * best:
        return 0
    return result.iterations if gap > 1e-2 and result.energy <= (1 + gap) * best else None


# %% exercise 2: right: the inverse matrix, updated
def two_loop(gradient, pairs):
    one = np.eye(len(gradient))
    H = one
    for s, y in pairs:
        rho = 1 / (y @ s)
        V = one - rho * np.outer(y, s)
        H = V.T @ H @ V + rho * np.outer(s, s)
    return H @ gradient


# %% exercise 2: right: by recursion
def two_loop(gradient, pairs):
    if not len(pairs):
        return gradient
    *older, (s, y) = pairs
    alpha = (s @ gradient) / (s @ y)
    inner = two_loop(gradient - alpha * y, older)
    return inner + (alpha - (y @ inner) / (s @ y)) * s


# %% exercise 2: the wrong order
def two_loop(gradient, pairs):
    q, alphas = gradient.copy(), []
    for s, y in pairs:
        alphas.append((s @ q) / (s @ y))
        q = q - alphas[-1] * y
    for (s, y), alpha in zip(reversed(pairs), reversed(alphas)):
        q = q + (alpha - (y @ q) / (s @ y)) * s
    return q


# %% exercise 2: the gradient
def two_loop(gradient, pairs):
    return gradient


# %% exercise 2: the newest pair only, scaled
def two_loop(gradient, pairs):
    if not pairs:
        return gradient
    s, y = pairs[-1]
    return (s @ y) / (y @ y) * gradient


# %% exercise 2: s and y are swapped
def two_loop(gradient, pairs):
    q, alphas = gradient.copy(), []
    for y, s in reversed(pairs):
        alphas.append((s @ q) / (s @ y))
        q = q - alphas[-1] * y
    for (y, s), alpha in zip(pairs, reversed(alphas)):
        q = q + (alpha - (y @ q) / (s @ y)) * s
    return q


# %% exercise 3: right: by matrices and their inverses
def area_mean(f, points, h=1e-6):
    e = np.eye(2) * h
    J = np.stack([(f(points + d) - f(points - d)) / (2 * h) for d in e], axis=2)
    both = (J**2).sum(axis=(1, 2)) + (np.linalg.inv(J) ** 2).sum(axis=(1, 2))
    return both.mean() / 2


# %% exercise 3: right: by singular values
def area_mean(f, points, h=1e-6):
    e = np.eye(2) * h
    J = np.stack([(f(points + d) - f(points - d)) / (2 * h) for d in e], axis=2)
    sigma = np.linalg.svd(J, compute_uv=False)
    return 0.5 * (sigma**2 + sigma**-2).sum(axis=1).mean()


# %% exercise 3: without the half
def area_mean(f, points, h=1e-6):
    across, up = ((f(points + d) - f(points - d)) / (2 * h) for d in np.eye(2) * h)
    squares = np.sum(across**2 + up**2, axis=1)
    det = across[:, 0] * up[:, 1] - across[:, 1] * up[:, 0]
    return np.mean(squares * (1 + det**-2))


# %% exercise 3: the determinant once
def area_mean(f, points, h=1e-6):
    across, up = ((f(points + d) - f(points - d)) / (2 * h) for d in np.eye(2) * h)
    squares = np.sum(across**2 + up**2, axis=1)
    det = across[:, 0] * up[:, 1] - across[:, 1] * up[:, 0]
    return np.mean(squares * (1 + 1 / det) / 2)


# %% exercise 3: the step is forgotten
def area_mean(f, points, h=1e-6):
    across, up = (f(points + d) - f(points - d) for d in np.eye(2) * h)
    squares = np.sum(across**2 + up**2, axis=1)
    det = across[:, 0] * up[:, 1] - across[:, 1] * up[:, 0]
    return np.mean(squares * (1 + det**-2) / 2)


# %% exercise 3: a sum
def area_mean(f, points, h=1e-6):
    across, up = ((f(points + d) - f(points - d)) / (2 * h) for d in np.eye(2) * h)
    squares = np.sum(across**2 + up**2, axis=1)
    det = across[:, 0] * up[:, 1] - across[:, 1] * up[:, 0]
    return np.sum(squares * (1 + det**-2) / 2)
