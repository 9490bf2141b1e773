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


# %% exercise 1: right: an array, with |f_z|^2 + |f_zbar|^2 as a name
def mips_row(x, y):
    total, d = x + y, x - y
    first = np.array([-2 * y, 2 * x]) / d**2
    return np.concatenate([first, np.array([4 * y, 4 * x, -2 * total]) / d**3])


# %% exercise 1: right: from E = 1 + 2 y / (x - y)
def mips_row(x, y):
    d = x - y
    return [-2 * y / d**2, 2 / d + 2 * y / d**2, 4 * y / d**3, 4 / d**2 + 4 * y / d**3] + [
        -2 / d**2 - 4 * y / d**3
    ]


# %% exercise 1: x and y are swapped
def mips_row(x, y):
    d = x - y
    return 2 * x / d**2, -2 * y / d**2, 4 * x / d**3, 4 * y / d**3, -2 * (x + y) / d**3


# %% exercise 1: without the second derivatives' factor
def mips_row(x, y):
    d = x - y
    return -2 * y / d**2, 2 * x / d**2, 2 * y / d**3, 2 * x / d**3, -(x + y) / d**3


# %% exercise 1: three numbers
def mips_row(x, y):
    d = x - y
    return -2 * y / d**2, 2 * x / d**2, 4 * y / d**3


# %% exercise 1: powers of x + y
def mips_row(x, y):
    d = x + y
    return -2 * y / d**2, 2 * x / d**2, 4 * y / d**3, 4 * x / d**3, -2 * (x + y) / d**3


# %% exercise 2: right: by powers
def arap(x, y):
    return 2 * (x + y + 1 - 2 * x**0.5)


# %% exercise 2: right: a square and the rest
def arap(x, y):
    f = jnp.sqrt(x)
    return 2 * (f - 1) ** 2 + 2 * y


# %% exercise 2: the difference is forgotten
def arap(x, y):
    return (x - 1) ** 2 + (y - 1) ** 2


# %% exercise 2: half as much
def arap(x, y):
    return x + y - 2 * jnp.sqrt(x) + 1


# %% exercise 2: the other root
def arap(x, y):
    return 2 * (x + y) - 4 * jnp.sqrt(y) + 2


# %% exercise 2: without the constant
def arap(x, y):
    return 2 * (x + y) - 4 * jnp.sqrt(x)


# %% exercise 3: no energy of stretches
# (Each further answer costs a solve. Three of them try this check.)
def careful(x, y):
    return y


# %% exercise 3: its minimum is no isometry
def careful(x, y):
    return (x - 2) ** 2 + y


# %% exercise 3: its minimum is close to the isometry
def careful(x, y):
    return e_iso(x, y) + (x + y) ** 4 / 4 + 2 / (x - y)
