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


# %% exercise 1: right: jax.numpy
def nearest(K):
    values, vectors = jax.numpy.linalg.eigh(jax.numpy.asarray(K))
    return (vectors * jax.numpy.maximum(values, 0)) @ vectors.T


# %% exercise 1: right: without the negative part
def nearest(K):
    values, vectors = np.linalg.eigh(K)
    negative = vectors[:, values < 0]
    return K - negative @ (negative.T @ K @ negative) @ negative.T


# %% exercise 1: right: half of K and of its absolute value, by singular values
def nearest(K):
    _, size, rows = np.linalg.svd(K)
    return (0.5 * (K + rows.T @ np.diag(size) @ rows)).tolist()


# %% exercise 1: K itself
def nearest(K):
    return K


# %% exercise 1: the negative entries become 0
def nearest(K):
    return np.maximum(K, 0)


# %% exercise 1: a multiple of the identity is added
# Positive semidefinite, but not the nearest in the Frobenius norm.
def nearest(K):
    return K - min(np.linalg.eigvalsh(K)[0], 0) * np.eye(len(K))


# %% exercise 1: the identity
def nearest(K):
    return np.eye(len(K))


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


# %% exercise 2: right: as an array of jax.numpy
def lambda_34(sigma1, sigma2):
    return 2 + 6 * jax.numpy.asarray([sigma1, sigma2]) ** -4.0


# %% exercise 2: right: by differentiating the two halves
def lambda_34(sigma1, sigma2):
    half = jax.grad(jax.grad(lambda sigma: 0.5 * (sigma**2 + sigma**-2)))
    return [2 * half(float(sigma1)), 2 * half(float(sigma2))]


# %% exercise 2: without the factor
def lambda_34(sigma1, sigma2):
    return 1 + 3 * sigma1**-4, 1 + 3 * sigma2**-4


# %% exercise 2: another power
def lambda_34(sigma1, sigma2):
    return 2 * (1 + 3 * sigma1**-2), 2 * (1 + 3 * sigma2**-2)


# %% exercise 2: the other two eigenvalues
def lambda_34(sigma1, sigma2):
    f, g = (sigma1 + sigma2) / 2, (sigma1 - sigma2) / 2
    first, second, *_ = eigenvalues(np.array([f, 0.0, g, 0.0]))
    return min(first, second), max(first, second)


# %% exercise 3: solution
def minimise(v, energy, gradient, hessian):
    """A local minimum by Newton's method from v; the three are functions of v."""
    for _ in range(60):
        g = np.asarray(gradient(v))
        if abs(g).max() < 1e-7:
            break
        values, vectors = np.linalg.eigh(hessian(v))
        d = -vectors @ ((vectors.T @ g) / np.maximum(values, 1e-2))
        t, here = 1.0, energy(v)
        while not energy(v + t * d) <= here + 1e-4 * t * (g @ d) and t > 1e-12:
            t /= 2
        v = v + t * d
    return v


# %% exercise 3: right: word for word
# It halves until the energy falls, and stops by the two rules of the task.
def minimise(v, energy, gradient, hessian):
    while max(abs(gradient(v))) > 1e-7:
        values, vectors = np.linalg.eigh(hessian(v))
        values = np.maximum(values, 0.1)
        step = -np.linalg.solve(vectors @ np.diag(values) @ vectors.T, gradient(v))
        halved = 0
        while not energy(v + step) < energy(v):
            step, halved = step / 2, halved + 1
            if halved == 40:
                return v
        v = v + step
    return v


# %% exercise 3: right: in jax.numpy, with absolute values of the eigenvalues
def minimise(v, energy, gradient, hessian):
    v = jnp.asarray(v)
    for _ in range(40):
        g = jnp.asarray(gradient(v))
        if jnp.abs(g).max() < 1e-7:
            return v
        values, vectors = jnp.linalg.eigh(jnp.asarray(hessian(v)))
        d = -vectors @ ((vectors.T @ g) / jnp.maximum(jnp.abs(values), 1e-3))
        for k in range(40):
            if energy(v + d / 2**k) < energy(v):
                v = v + d / 2**k
                break
    return v


# %% exercise 3: right: a shift that is raised until Cholesky succeeds
def minimise(v, energy, gradient, hessian):
    for _ in range(80):
        g, H, shift = np.asarray(gradient(v)), np.asarray(hessian(v)), 0.0
        if abs(g).max() < 1e-7:
            break
        while True:
            try:
                np.linalg.cholesky(H + shift * np.eye(4))
                break
            except np.linalg.LinAlgError:
                shift = max(1.0, 2 * shift)
        d = np.linalg.solve(H + shift * np.eye(4), -g)
        t = 1.0
        while energy(v + t * d) > energy(v) and t > 1e-12:
            t /= 2
        v = v + t * d
    return list(v)


# %% exercise 3: a typical wrong answer
# Newton's method as it stands, with full steps and the exact Hessian.
def minimise(v, energy, gradient, hessian):
    for _ in range(60):
        v = v - np.linalg.solve(hessian(v), gradient(v))
    return v


# %% exercise 3: gradient descent
# It arrives, after more than a thousand steps from side to side of the valley.
def minimise(v, energy, gradient, hessian):
    for _ in range(2000):
        g = np.asarray(gradient(v))
        t = 1.0
        while not energy(v - t * g) <= energy(v) - 1e-4 * t * (g @ g) and t > 1e-12:
            t /= 2
        v = v - t * g
    return v


# %% exercise 3: gradient descent that looks at the Hessian
# Only the step's length comes from the Hessian, so it is as slow.
def minimise(v, energy, gradient, hessian):
    for _ in range(100):
        g = np.asarray(gradient(v))
        v = v - g / abs(np.linalg.eigvalsh(hessian(v))).max()
    return v


# %% exercise 3: the start
def minimise(v, energy, gradient, hessian):
    hessian(v)
    return v


# %% exercise 3: one step
def minimise(v, energy, gradient, hessian):
    values, vectors = np.linalg.eigh(hessian(v))
    return v - vectors @ ((vectors.T @ gradient(v)) / np.maximum(values, 1e-2))


# %% exercise 3: the energy at the minimum instead of the minimum
def minimise(v, energy, gradient, hessian):
    for _ in range(60):
        values, vectors = np.linalg.eigh(hessian(v))
        d = -vectors @ ((vectors.T @ gradient(v)) / np.maximum(values, 1e-2))
        t = 1.0
        while energy(v + t * d) > energy(v) and t > 1e-12:
            t /= 2
        v = v + t * d
    return energy(v)
