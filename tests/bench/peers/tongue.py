"""The string eigenvalues of all coprime p + q <= N by SciPy's eigh_tridiagonal, beside `cargo bench --bench tongue`.

Setup, once, outside the repository:  python3 -m venv V && V/bin/pip install -r requirements.txt
Run:  V/bin/python tongue.py 100 [FILE]     FILE: every edge s, one a line, in the order p, q, entry, index.

Only the solver's calls are timed, not the making of the matrices. SciPy has no certificates; it gets no help and no
handicap: one call a problem, eigenvalues only, its default driver.
"""

import sys
import time
from math import gcd

import numpy as np
from scipy.linalg import eigh_tridiagonal


def half_period(p, q, rho, number=float):
    """Masses at the kick times from 0 to T/2 (halved at both ends) and the lengths between, in units of h1."""
    tick = 2  # T/2 is whole in ticks of h1/(2 q)
    half = p * q * tick // 2
    times = sorted(set(range(0, half + 1, q * tick)) | set(range(0, half + 1, p * tick)) | {half})
    mass = [number(t % (q * tick) == 0) + (t % (p * tick) == 0) * rho * p / q for t in times]
    mass[0] /= 2
    mass[-1] /= 2
    return mass, [number(b - a) / (q * tick) for a, b in zip(times, times[1:])]


def entries(mass, length, free_start, free_end):
    """Diagonal and squared off-diagonal of M^-1/2 K M^-1/2; pinned ends and ends without a mass left out."""
    if free_end and mass[-1] == 0:
        mass, length = mass[:-1], length[:-1]
    spring = [0] + [1 / l for l in length] + [0]
    nodes = range(0 if free_start else 1, len(mass) if free_end else len(mass) - 1)
    d = [(spring[j] + spring[j + 1]) / mass[j] for j in nodes]
    e = [spring[j + 1] ** 2 / (mass[j] * mass[j + 1]) for j in list(nodes)[:-1]]
    return d, e


def tridiagonal(mass, length, *ends):
    """The matrix in doubles: diagonal and off-diagonal."""
    d, e = entries(mass, length, *ends)
    return np.array(d, float), -np.sqrt(np.array(e, float))


def problems(largest):
    """The four problems of each coprime p + q <= largest at rho = 1/25, with their ends: free (True) or pinned."""
    for total in range(2, largest + 1):
        for p in range(1, total):
            if gcd(p, total - p) == 1:
                mass, length = half_period(p, total - p, 1 / 25)
                for ends in [(True, False), (False, False), (True, True), (False, True)]:
                    yield ends, *tridiagonal(mass, length, *ends)


def solve(problems):
    return [(ends, eigh_tridiagonal(d, e, eigvals_only=True) if len(d) else d) for ends, d, e in problems]


def positive(solved):
    """The edges: the rigid shift of the even-even problem is none."""
    return np.concatenate([values[1:] if ends == (True, True) else values for ends, values in solved])


def main():
    made = list(problems(int(sys.argv[1])))
    start = time.perf_counter()
    solved = solve(made)
    seconds = time.perf_counter() - start
    edges = positive(solved)
    print(f"scipy eigh_tridiagonal: {len(edges)} edges, {seconds:.3f} s")
    if len(sys.argv) > 2:
        np.savetxt(sys.argv[2], edges, fmt="%.17g")


if __name__ == "__main__":
    main()
