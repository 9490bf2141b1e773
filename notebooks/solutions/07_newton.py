# Answers to the exercises of 07_newton.ipynb, run by tests/notebooks.

# %% exercise 1: solution
def nearest(K):
    """The positive semidefinite matrix nearest to the symmetric matrix K."""
    values, vectors = np.linalg.eigh(K)
    return vectors @ np.diag(np.maximum(values, 0)) @ vectors.T


# %% exercise 1: a typical wrong answer
# Turns negative eigenvalues over: positive semidefinite, but not the nearest such matrix.
def nearest(K):
    """The positive semidefinite matrix nearest to the symmetric matrix K."""
    values, vectors = np.linalg.eigh(K)
    return vectors @ np.diag(np.abs(values)) @ vectors.T


# %% exercise 2: solution
def lambda_34(sigma1, sigma2):
    """The eigenvalues lambda_3 and lambda_4 of K for E_iso."""
    # sigma_1 and sigma_2 are sqrt(2) times orthonormal coordinates, hence twice the second
    # derivatives (1 + 3 sigma^-4) of the two halves.
    return 2 * (1 + 3 * sigma1**-4), 2 * (1 + 3 * sigma2**-4)


# %% exercise 2: a typical wrong answer
# The paper's factor.
def lambda_34(sigma1, sigma2):
    """The eigenvalues lambda_3 and lambda_4 of K for E_iso."""
    return 4 * (1 + 3 * sigma1**-4), 4 * (1 + 3 * sigma2**-4)


# %% exercise 2: another wrong answer
# The two are swapped: lambda_3 is the one that depends on sigma_1.
def lambda_34(sigma1, sigma2):
    """The eigenvalues lambda_3 and lambda_4 of K for E_iso."""
    return 2 * (1 + 3 * sigma2**-4), 2 * (1 + 3 * sigma1**-4)


# %% exercise 3: solution
def minimise(v):
    """A local minimum of energy by Newton's method from v, with gradient and hessian."""
    for _ in range(60):
        g = np.asarray(gradient(v))
        values, vectors = np.linalg.eigh(hessian(v))
        d = -vectors @ ((vectors.T @ g) / np.maximum(values, 1e-2))
        t = 1.0
        while not energy(v + t * d) <= energy(v) + 1e-4 * t * (g @ d) and t > 1e-10:
            t /= 2
        v = v + t * d
    return v


# %% exercise 3: a typical wrong answer
# Newton's method as it stands, with full steps and the exact Hessian.
def minimise(v):
    """A local minimum of energy by Newton's method from v, with gradient and hessian."""
    for _ in range(60):
        v = v - np.linalg.solve(hessian(v), gradient(v))
    return v


# %% exercise 3: gradient descent
# It arrives, after more than a thousand steps from side to side of the valley.
def minimise(v):
    """A local minimum of energy, by gradient descent from v."""
    for _ in range(2000):
        g = np.asarray(gradient(v))
        t = 1.0
        while not energy(v - t * g) <= energy(v) - 1e-4 * t * (g @ g) and t > 1e-12:
            t /= 2
        v = v - t * g
    return v


# %% exercise 3: gradient descent that looks at the Hessian
# Only the step's length comes from the Hessian, so it is as slow.
def minimise(v):
    """A local minimum of energy, by 100 steps of gradient descent from v."""
    for _ in range(100):
        g = np.asarray(gradient(v))
        v = v - g / abs(np.linalg.eigvalsh(hessian(v))).max()
    return v
