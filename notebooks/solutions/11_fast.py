# %% exercise 1: solution
def hessian_block(D, K):
    """D^T K D / |H| for the real matrix D (2 |H|, 2 n) and the blocks K (|H|, 2, 2)."""
    rows = D.reshape(len(K), 2, -1)
    return D.T @ (K @ rows).reshape(D.shape) / len(K)


# %% exercise 1: a typical wrong answer
# It takes the blocks' diagonals only, so a and d of (G.10) without b and c.
def hessian_block(D, K):
    diagonal = np.einsum("hii->hi", K).ravel()
    return D.T @ (diagonal[:, None] * D) / len(K)


# %% exercise 2: solution
def with_old_factor(gradient, factor, x, count):
    """count steps from x by one Cholesky factor, each with a gradient of its own."""
    for _ in range(count):
        x = x - cho_solve(factor, gradient(x))
    return x


# %% exercise 2: a typical wrong answer
# It computes the gradient once, and repeats the first step.
def with_old_factor(gradient, factor, x, count):
    step = cho_solve(factor, gradient(x))
    return x - count * step


# %% exercise 1: right: einsum
def hessian_block(D, K):
    rows = D.reshape(len(K), 2, -1)
    return np.einsum("hia,hij,hjb->ab", rows, K, rows) / len(K)


# %% exercise 1: right: a block diagonal matrix
def hessian_block(D, K):
    from scipy.linalg import block_diag

    return D.T @ block_diag(*K) @ D / len(K)


# %% exercise 1: without the mean
def hessian_block(D, K):
    rows = D.reshape(len(K), 2, -1)
    return D.T @ (K @ rows).reshape(D.shape)


# %% exercise 1: without the blocks
def hessian_block(D, K):
    return D.T @ D / len(K)


# %% exercise 1: all rows first, then the other rows
def hessian_block(D, K):
    rows = D.reshape(2, len(K), -1).transpose(1, 0, 2)
    return D.T @ (K @ rows).reshape(D.shape) / len(K)


# %% exercise 1: the mean block for all samples
def hessian_block(D, K):
    rows = D.reshape(len(K), 2, -1)
    return D.T @ (K.mean(axis=0) @ rows).reshape(D.shape) / len(K)


# %% exercise 2: right: by recursion
def with_old_factor(gradient, factor, x, count):
    if count == 0:
        return x
    return with_old_factor(gradient, factor, x - cho_solve(factor, gradient(x)), count - 1)


# %% exercise 2: right: a while loop and a copy
def with_old_factor(gradient, factor, x, count):
    x = np.array(x)
    while count > 0:
        x -= cho_solve(factor, gradient(x))
        count -= 1
    return x


# %% exercise 2: one step too many
def with_old_factor(gradient, factor, x, count):
    for _ in range(count + 1):
        x = x - cho_solve(factor, gradient(x))
    return x


# %% exercise 2: uphill
def with_old_factor(gradient, factor, x, count):
    for _ in range(count):
        x = x + cho_solve(factor, gradient(x))
    return x


# %% exercise 2: gradient descent without the factor
def with_old_factor(gradient, factor, x, count):
    for _ in range(count):
        x = x - gradient(x)
    return x


# %% exercise 2: the gradient is asked twice
def with_old_factor(gradient, factor, x, count):
    for _ in range(count):
        if abs(gradient(x)).max() > 0:
            x = x - cho_solve(factor, gradient(x))
    return x
