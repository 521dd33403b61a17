"""Least squares with coefficients of 0 or more, for a few unknowns."""
import itertools


def solve(matrix: list[list[float]], right: list[float]) -> list[float] | None:
    """Gauss elimination; None if the matrix is singular."""
    size = len(right)
    rows = [list(row) + [value] for row, value in zip(matrix, right)]
    for k in range(size):
        pivot = max(range(k, size), key=lambda i: abs(rows[i][k]))
        if abs(rows[pivot][k]) < 1e-12 * max(1.0, max(abs(value) for value in rows[pivot])):
            return None
        rows[k], rows[pivot] = rows[pivot], rows[k]
        for i in range(size):
            if i != k:
                factor = rows[i][k] / rows[k][k]
                rows[i] = [a - factor * b for a, b in zip(rows[i], rows[k])]
    return [rows[k][size] / rows[k][k] for k in range(size)]


def fit(rows: list[list[float]], values: list[float]) -> list[float]:
    """Returns the coefficients, none negative, that come closest to `values`: tries which of them are 0."""
    count = len(rows[0])
    # Columns of the same size, so that the solution does not depend on units.
    scales = [max(abs(row[k]) for row in rows) or 1.0 for k in range(count)]
    best, least = [0.0] * count, sum(value * value for value in values)
    for size in range(1, count + 1):
        for used in itertools.combinations(range(count), size):
            part = [[row[k] / scales[k] for k in used] for row in rows]
            matrix = [[sum(row[i] * row[j] for row in part) for j in range(size)] for i in range(size)]
            right = [sum(row[i] * value for row, value in zip(part, values)) for i in range(size)]
            found = solve(matrix, right)
            if found is None or min(found) < 0.0:
                continue
            error = sum((sum(a * b for a, b in zip(row, found)) - value) ** 2 for row, value in zip(part, values))
            if error < least * (1.0 - 1e-9):
                least = error
                best = [0.0] * count
                for k, value in zip(used, found):
                    best[k] = value / scales[k]
    return best
