"""Logistic regression, for scripts/calibration and scripts/tracking."""
import math


def solved(matrix, values):
    """The solution of a system of linear equations, by elimination; the matrix is positive definite."""
    rows = [list(row) + [value] for row, value in zip(matrix, values)]
    for i, pivot in enumerate(rows):
        for row in rows[:i] + rows[i + 1:]:
            factor = row[i] / pivot[i]
            row[:] = [a - factor * b for a, b in zip(row, pivot)]
    return [row[-1] / row[i] for i, row in enumerate(rows)]


def fitted(examples):
    """Coefficients under which the outcomes of (inputs, hit, weight) are most probable, by Newton's
    method, and the mean log loss."""
    size = len(examples[0][0])
    found = [0.0] * size
    for _ in range(30):
        gradient, loss = [0.0] * size, 0.0
        hessian = [[1e-9 * (i == j) for j in range(size)] for i in range(size)]
        for x, hit, weight in examples:
            p = 1 / (1 + math.exp(-sum(a * b for a, b in zip(found, x))))
            loss -= weight * math.log(max(p if hit else 1 - p, 1e-12))
            for i in range(size):
                gradient[i] += weight * (hit - p) * x[i]
                for j in range(size):
                    hessian[i][j] += weight * p * (1 - p) * x[i] * x[j]
        found = [a + b for a, b in zip(found, solved(hessian, gradient))]
    return found, loss / sum(weight for _, _, weight in examples)
