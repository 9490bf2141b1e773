# Answers to the exercises of 06_measuring_distortion.ipynb, run by tests/notebooks.

# %% exercise 1: solution
def mips_row(x, y):
    """alpha_1, alpha_2, beta_1, beta_2, beta_3 of E = (x + y) / (x - y)."""
    d = x - y
    return -2 * y / d**2, 2 * x / d**2, 4 * y / d**3, 4 * x / d**3, -2 * (x + y) / d**3


# %% exercise 1: a typical wrong answer
# beta_3, the mixed derivative, has the sign of the other two.
def mips_row(x, y):
    """alpha_1, alpha_2, beta_1, beta_2, beta_3 of E = (x + y) / (x - y)."""
    d = x - y
    return -2 * y / d**2, 2 * x / d**2, 4 * y / d**3, 4 * x / d**3, 2 * (x + y) / d**3


# %% exercise 2: solution
def arap(x, y):
    """E_ARAP of x = |f_z|^2 and y = |f_zbar|^2, smooth where x > y >= 0."""
    return 2 * (x + y) - 4 * jnp.sqrt(x) + 2


# %% exercise 2: a typical wrong answer
# Right values, but the root of y has no derivative at 0, where f_zbar vanishes.
def arap(x, y):
    """E_ARAP of x = |f_z|^2 and y = |f_zbar|^2, smooth where x > y >= 0."""
    f, g = jnp.sqrt(x), jnp.sqrt(y)
    return (f + g - 1) ** 2 + (f - g - 1) ** 2


# %% exercise 3: solution
def careful(x, y):
    """An energy density whose minimiser is nowhere stretched by 2 or more."""
    return jnp.exp(2 * e_iso(x, y))


# %% exercise 3: a typical wrong answer
# A multiple of an energy has the same minimiser (beside handles that are met anyway).
def careful(x, y):
    """An energy density whose minimiser is nowhere stretched by 2 or more."""
    return 10 * e_iso(x, y)
