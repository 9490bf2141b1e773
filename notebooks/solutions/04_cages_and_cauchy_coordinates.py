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


# %% exercise 1: right: the two edges by a function
def cauchy(z, vertices, j):
    around = np.roll(vertices, 1 - j)[:3]

    def edge(far):
        return (far - z) / (far - around[1]) * np.log((far - z) / (around[1] - z))

    return (edge(around[2]) - edge(around[0])) / (2j * np.pi)


# %% exercise 1: right: by Gauss's rule for the integral, with the hat function
def cauchy(z, vertices, j):
    nodes, weights = np.polynomial.legendre.leggauss(400)
    share, weights = (nodes + 1) / 2, weights / 2
    m, total = len(vertices), 0
    for other, sign in (((j + 1) % m, 1), ((j - 1) % m, -1)):
        step = vertices[other] - vertices[j]
        w = vertices[j] + share * step
        values = (1 - share) / (w - np.asarray(z)[..., None])
        total = total + sign * (values * weights).sum(axis=-1) * step
    return total / (2j * np.pi)


# %% exercise 1: one edge
def cauchy(z, vertices, j):
    own, after = vertices[j], vertices[(j + 1) % len(vertices)]
    return (after - z) / (after - own) * np.log((after - z) / (own - z)) / (2j * np.pi)


# %% exercise 1: without the factor
def cauchy(z, vertices, j):
    m = len(vertices)
    before, own, after = (vertices[i % m] for i in (j - 1, j, j + 1))
    first = (after - z) / (after - own) * np.log((after - z) / (own - z))
    second = (before - z) / (own - before) * np.log((own - z) / (before - z))
    return first - second


# %% exercise 1: the edges are added
def cauchy(z, vertices, j):
    m = len(vertices)
    before, own, after = (vertices[i % m] for i in (j - 1, j, j + 1))
    first = (after - z) / (after - own) * np.log((after - z) / (own - z))
    second = (before - z) / (own - before) * np.log((own - z) / (before - z))
    return (first + second) / (2j * np.pi)


# %% exercise 1: always the same share
def cauchy(z, vertices, j):
    return np.ones_like(z) / len(vertices)


# %% exercise 2: right: the constant in psi
def affine_coefficients(vertices, a, b, c):
    return a * vertices, (b * vertices.conj() + c).conj()


# %% exercise 2: right: as lists
def affine_coefficients(vertices, a, b, c):
    phi = [a * vertex + c for vertex in vertices]
    return phi, [complex(b).conjugate() * vertex for vertex in vertices]


# %% exercise 2: the constant in both
def affine_coefficients(vertices, a, b, c):
    return a * vertices + c, np.conj(b) * vertices + np.conj(c)


# %% exercise 2: conjugated vertices
def affine_coefficients(vertices, a, b, c):
    return a * vertices + c, np.conj(b) * vertices.conj()


# %% exercise 2: without the constant
def affine_coefficients(vertices, a, b, c):
    return a * vertices, np.conj(b) * vertices


# %% exercise 2: the two are swapped
def affine_coefficients(vertices, a, b, c):
    return np.conj(b) * vertices, a * vertices + c


# %% exercise 3: right: along the axes, as complex numbers
def wirtinger(f, x, y, h=1e-5):
    def g(z):
        return complex(*f([[z.real, z.imag]])[0])

    z = complex(x, y)
    fx, ify = (g(z + h) - g(z - h)) / (2 * h), (g(z + 1j * h) - g(z - 1j * h)) / (2j * h)
    return (fx + ify) / 2, (fx - ify) / 2


# %% exercise 3: right: by eight points on a circle
def wirtinger(f, x, y, h=1e-5):
    turn = np.exp(2j * np.pi * np.arange(8) / 8)
    points = np.stack([x + h * turn.real, y + h * turn.imag], axis=1)
    values = f(points) @ [1, 1j]
    return (values / turn).mean() / h, (values * turn).mean() / h


# %% exercise 3: without the halves
def wirtinger(f, x, y, h=1e-5):
    right, left, up, down = f([[x + h, y], [x - h, y], [x, y + h], [x, y - h]]) @ [1, 1j]
    fx, fy = (right - left) / (2 * h), (up - down) / (2 * h)
    return fx - 1j * fy, fx + 1j * fy


# %% exercise 3: one-sided, with a large step
def wirtinger(f, x, y, h=1e-5):
    here, right, up = f([[x, y], [x + 0.1, y], [x, y + 0.1]]) @ [1, 1j]
    fx, fy = (right - here) / 0.1, (up - here) / 0.1
    return (fx - 1j * fy) / 2, (fx + 1j * fy) / 2


# %% exercise 3: the conjugate of f_zbar
def wirtinger(f, x, y, h=1e-5):
    right, left, up, down = f([[x + h, y], [x - h, y], [x, y + h], [x, y - h]]) @ [1, 1j]
    fx, fy = (right - left) / (2 * h), (up - down) / (2 * h)
    return (fx - 1j * fy) / 2, np.conj(fx + 1j * fy) / 2


# %% exercise 3: the partial derivatives
def wirtinger(f, x, y, h=1e-5):
    right, left, up, down = f([[x + h, y], [x - h, y], [x, y + h], [x, y - h]]) @ [1, 1j]
    return (right - left) / (2 * h), (up - down) / (2 * h)
