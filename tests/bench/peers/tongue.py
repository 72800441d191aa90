"""The string eigenvalues of all coprime p + q <= N by SciPy's eigh_tridiagonal, beside `cargo bench --bench tongue`.

Setup, once, outside the repository:  python3 -m venv V && V/bin/pip install -r requirements.txt
Run:  V/bin/python tongue.py 100 [FILE]     FILE: every edge s, one a line, in the order p, q, entry, index.

Only the solver's calls are timed, not the making of the matrices. SciPy has no certificates; it gets no help and no
handicap: one call a problem, eigenvalues only, its default driver.
"""

import sys
import time
from math import gcd, sqrt

import numpy as np
from scipy.linalg import eigh_tridiagonal


def half_period(p, q, rho):
    """Masses at the kick times from 0 to T/2 (halved at both ends) and the lengths between, in units of h1."""
    tick = 2  # T/2 is whole in ticks of h1/(2 q)
    half = p * q * tick // 2
    times = sorted(set(range(0, half + 1, q * tick)) | set(range(0, half + 1, p * tick)) | {half})
    mass = [(t % (q * tick) == 0) * 1.0 + (t % (p * tick) == 0) * rho * p / q for t in times]
    mass[0] /= 2
    mass[-1] /= 2
    return mass, [(b - a) / (q * tick) for a, b in zip(times, times[1:])]


def tridiagonal(mass, length, free_start, free_end):
    """Diagonal and off-diagonal of M^-1/2 K M^-1/2; pinned ends and ends without a mass left out."""
    if free_end and mass[-1] == 0:
        mass, length = mass[:-1], length[:-1]
    spring = [0.0] + [1 / l for l in length] + [0.0]
    nodes = range(0 if free_start else 1, len(mass) if free_end else len(mass) - 1)
    d = [(spring[j] + spring[j + 1]) / mass[j] for j in nodes]
    e = [-spring[j + 1] / sqrt(mass[j] * mass[j + 1]) for j in list(nodes)[:-1]]
    return np.array(d), np.array(e)


def main():
    largest, out = int(sys.argv[1]), sys.argv[2] if len(sys.argv) > 2 else None
    problems = []
    for total in range(2, largest + 1):
        for p in range(1, total):
            if gcd(p, total - p) == 1:
                mass, length = half_period(p, total - p, 1 / 25)
                for ends in [(True, False), (False, False), (True, True), (False, True)]:
                    problems.append((ends, *tridiagonal(mass, length, *ends)))
    start = time.perf_counter()
    edges = [(ends, eigh_tridiagonal(d, e, eigvals_only=True) if len(d) else d) for ends, d, e in problems]
    seconds = time.perf_counter() - start
    # The rigid shift of the even-even problem is not an edge.
    edges = [values[1:] if ends == (True, True) else values for ends, values in edges]
    count = sum(len(values) for values in edges)
    print(f"scipy eigh_tridiagonal: {count} edges, {seconds:.3f} s")
    if out:
        np.savetxt(out, np.concatenate(edges), fmt="%.17g")


main()
