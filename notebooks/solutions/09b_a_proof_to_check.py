# %% exercise 1: solution
def halved_bound(coefficients):
    """A lower bound on [0, 1] from Bernstein coefficients, after one halving."""
    row = np.asarray(coefficients, dtype=float)
    least = min(row[0], row[-1])
    while len(row) > 1:
        row = (row[:-1] + row[1:]) / 2
        least = min(least, row[0], row[-1])
    return least


# %% exercise 1: a typical wrong answer
# The smallest of many values is an estimate from above; the polynomial may be smaller between them.
def halved_bound(coefficients):
    return bernstein(coefficients, np.linspace(0, 1, 101)).min()


# %% exercise 1: right: the two halves' coefficients, collected
def halved_bound(coefficients):
    row, left, right = list(map(float, coefficients)), [], []
    while row:
        left.append(row[0])
        right.append(row[-1])
        row = [(a + b) / 2 for a, b in zip(row, row[1:])]
    return min(left + right)


# %% exercise 1: right: by matrices of binomial numbers
def halved_bound(coefficients):
    from math import comb

    c = np.asarray(coefficients, float)
    n = len(c)
    half = np.array([[comb(i, j) / 2**i if j <= i else 0 for j in range(n)] for i in range(n)])
    return min((half @ c).min(), (half @ c[::-1]).min())


# %% exercise 1: without halving
def halved_bound(coefficients):
    return min(coefficients)


# %% exercise 1: the value in the middle
def halved_bound(coefficients):
    return bernstein(coefficients, np.array([0.5]))[0]


# %% exercise 1: the left half only
def halved_bound(coefficients):
    row = np.asarray(coefficients, dtype=float)
    least = row[0]
    while len(row) > 1:
        row = (row[:-1] + row[1:]) / 2
        least = min(least, row[0])
    return least


# %% exercise 1: one row of means
def halved_bound(coefficients):
    row = np.asarray(coefficients, dtype=float)
    return ((row[:-1] + row[1:]) / 2).min()


# %% exercise 2: solution
from fractions import Fraction


def decided(coefficients, claim, deepest):
    """Is a polynomial at least `claim` on [0, 1]? "true", "false" or "undecided"."""
    row = [Fraction(c) for c in coefficients]
    if min(row[0], row[-1]) < claim:
        return "false"
    if min(row) >= claim:
        return "true"
    if deepest == 0:
        return "undecided"
    left, right = [], []
    while row:
        left.append(row[0])
        right.append(row[-1])
        row = [(a + b) / 2 for a, b in zip(row, row[1:])]
    found = {decided(half, claim, deepest - 1) for half in (left, right[::-1])}
    return next(answer for answer in ("false", "undecided", "true") if answer in found)


# %% exercise 2: a typical wrong answer
# A coefficient between the ends is no value of the polynomial, so a low one refutes nothing.
def decided(coefficients, claim, deepest):
    return "true" if min(coefficients) >= claim else "false"


# %% exercise 2: right: whole numbers only, doubled instead of halved
def decided(coefficients, claim, deepest):
    level, answer = [list(coefficients)], "true"
    for depth in range(deepest + 1):
        later = []
        for row in level:
            if min(row[0], row[-1]) < claim:
                return "false"
            if min(row) >= claim:
                continue
            if depth == deepest:
                answer = "undecided"
                continue
            left, right, degree = [], [], len(row) - 1
            for k in range(degree + 1):
                left.append(row[0] << (degree - k))
                right.append(row[-1] << (degree - k))
                row = [a + b for a, b in zip(row, row[1:])]
            later += [left, right[::-1]]
        claim <<= len(coefficients) - 1
        level = later
    return answer


# %% exercise 2: right: a stack of parts
def decided(coefficients, claim, deepest):
    stack, answer = [([Fraction(c) for c in coefficients], 0)], "true"
    while stack:
        row, depth = stack.pop()
        if row[0] < claim or row[-1] < claim:
            return "false"
        if all(c >= claim for c in row):
            continue
        if depth == deepest:
            answer = "undecided"
            continue
        rows = [row]
        while len(rows[-1]) > 1:
            rows.append([(a + b) / 2 for a, b in zip(rows[-1], rows[-1][1:])])
        stack.append(([r[0] for r in rows], depth + 1))
        stack.append(([r[-1] for r in reversed(rows)], depth + 1))
    return answer


# %% exercise 2: in numbers of 64 bits
def decided(coefficients, claim, deepest):
    row = [float(c) for c in coefficients]
    if min(row[0], row[-1]) < claim:
        return "false"
    if min(row) >= claim:
        return "true"
    if deepest == 0:
        return "undecided"
    left, right = [], []
    while row:
        left.append(row[0])
        right.append(row[-1])
        row = [(a + b) / 2 for a, b in zip(row, row[1:])]
    found = {decided(half, claim, deepest - 1) for half in (left, right[::-1])}
    return next(answer for answer in ("false", "undecided", "true") if answer in found)


# %% exercise 2: whole numbers, the means rounded down
def decided(coefficients, claim, deepest):
    row = list(coefficients)
    if min(row[0], row[-1]) < claim:
        return "false"
    if min(row) >= claim:
        return "true"
    if deepest == 0:
        return "undecided"
    left, right = [], []
    while row:
        left.append(row[0])
        right.append(row[-1])
        row = [(a + b) // 2 for a, b in zip(row, row[1:])]
    found = {decided(half, claim, deepest - 1) for half in (left, right[::-1])}
    return next(answer for answer in ("false", "undecided", "true") if answer in found)


# %% exercise 2: samples
def decided(coefficients, claim, deepest):
    least = bernstein(coefficients, np.linspace(0, 1, 2**10 + 1)).min()
    return "true" if least >= claim else "false"


# %% exercise 2: the left half only
def decided(coefficients, claim, deepest):
    row = [Fraction(c) for c in coefficients]
    for _ in range(deepest + 1):
        if min(row[0], row[-1]) < claim:
            return "false"
        if min(row) >= claim:
            return "true"
        left = []
        while row:
            left.append(row[0])
            row = [(a + b) / 2 for a, b in zip(row, row[1:])]
        row = left
    return "undecided"


# %% exercise 2: what is not proved is false
def decided(coefficients, claim, deepest):
    row = [Fraction(c) for c in coefficients]
    if min(row) >= claim:
        return "true"
    if deepest == 0:
        return "false"
    left, right = [], []
    while row:
        left.append(row[0])
        right.append(row[-1])
        row = [(a + b) / 2 for a, b in zip(row, row[1:])]
    if decided(left, claim, deepest - 1) == decided(right, claim, deepest - 1) == "true":
        return "true"
    return "false"


# %% exercise 2: true or false of Python
def decided(coefficients, claim, deepest):
    return min(coefficients) >= claim
