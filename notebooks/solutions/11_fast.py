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
