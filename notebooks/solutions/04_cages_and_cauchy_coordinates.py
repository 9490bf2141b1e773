# Answers to the exercises of 04_cages_and_cauchy_coordinates.ipynb, run by tests/notebooks.
import numpy as np


# %% exercise 1: solution
def cauchy(z, vertices, j):
    m = len(vertices)
    before, own, after = (vertices[i % m] for i in (j - 1, j, j + 1))
    first = (after - z) / (after - own) * np.log((after - z) / (own - z))
    second = (before - z) / (own - before) * np.log((own - z) / (before - z))
    return (first - second) / (2j * np.pi)


# %% exercise 1: a typical wrong answer
# The logarithm of a quotient is not the difference of principal logarithms: it may jump by 2 pi i.
def cauchy(z, vertices, j):
    m = len(vertices)
    before, own, after = (vertices[i % m] for i in (j - 1, j, j + 1))
    first = (after - z) / (after - own) * (np.log(after - z) - np.log(own - z))
    second = (before - z) / (own - before) * (np.log(own - z) - np.log(before - z))
    return (first - second) / (2j * np.pi)


# %% exercise 2: solution
def affine_coefficients(vertices, a, b, c):
    return a * vertices + c, np.conj(b) * vertices


# %% exercise 2: a typical wrong answer
# The second sum is conjugated as a whole, its coefficient too.
def affine_coefficients(vertices, a, b, c):
    return a * vertices + c, b * vertices


# %% exercise 3: solution
def wirtinger(f, x, y, h=1e-5):
    right, left, up, down = f([[x + h, y], [x - h, y], [x, y + h], [x, y - h]]) @ [1, 1j]
    fx, fy = (right - left) / (2 * h), (up - down) / (2 * h)
    return (fx - 1j * fy) / 2, (fx + 1j * fy) / 2


# %% exercise 3: a typical wrong answer
# The signs of i are swapped: these are f_zbar and f_z.
def wirtinger(f, x, y, h=1e-5):
    right, left, up, down = f([[x + h, y], [x - h, y], [x, y + h], [x, y - h]]) @ [1, 1j]
    fx, fy = (right - left) / (2 * h), (up - down) / (2 * h)
    return (fx + 1j * fy) / 2, (fx - 1j * fy) / 2
