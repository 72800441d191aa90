#!/usr/bin/env python3
"""Sparse levels: sparse.py; JSON. Needs the Python package and SciPy.

A lattice of L^3 diatomic molecules, each bond in a random direction with a frequency of about 2 pi/10 fs, neighbours tied by
weak random springs (slow force); three degrees of freedom an atom. Asked: the verdict at an outer step of 4 fs with eight inner
ones, and the first unstable outer step. Seconds are processor time.
"""

import json
import sys
import time

import numpy as np
import scipy.sparse as sp

import kickdrift as kd


def lattice(size):
    """Fast and slow stiffness, mass-weighted, in fs^-2."""
    rng = np.random.default_rng(size)
    cells = np.arange(size**3).reshape(size, size, size)
    atoms = 2 * size**3

    def springs(first, second, direction, strength):
        """Springs between atoms along unit vectors."""
        count = len(first)
        rows = np.repeat(np.arange(count), 6)
        columns = np.concatenate([3 * first[:, None] + np.arange(3), 3 * second[:, None] + np.arange(3)], axis=1).ravel()
        values = np.concatenate([direction, -direction], axis=1).ravel()
        stretch = sp.csr_matrix((values, (rows, columns)), shape=(count, 3 * atoms))
        return stretch.T @ sp.diags(strength) @ stretch

    def unit(count):
        vectors = rng.normal(size=(count, 3))
        return vectors / np.linalg.norm(vectors, axis=1)[:, None]

    molecules = np.arange(size**3)
    bond = (2 * np.pi / 10) ** 2 / 2 * rng.uniform(0.9, 1.0, size**3)
    fast = springs(2 * molecules, 2 * molecules + 1, unit(size**3), bond)
    weak = (2 * np.pi / 80) ** 2
    slow = sp.csr_matrix(fast.shape)
    for axis in range(3):
        here, there = cells.ravel(), np.roll(cells, -1, axis).ravel()
        for a in (0, 1):
            for b in (0, 1):
                slow = slow + springs(2 * here + a, 2 * there + b, unit(size**3), weak / 8 * rng.uniform(0.5, 1.0, size**3))
    # Held in place, so that nothing drifts.
    slow = slow + sp.identity(3 * atoms) * weak / 20
    return sp.csr_matrix(fast), sp.csr_matrix(slow)


def main():
    rows = []
    for size in (5, 8, 12):
        fast, slow = lattice(size)
        n = fast.shape[0]
        start = time.process_time()
        system = kd.System.from_hessians([1.0] * n, {"bonds": ("1/2", fast), "rest": (4, slow)}, time_unit="fs")
        found = json.loads(system.decide().to_json())
        rows.append({"degrees_of_freedom": n, "stored": int(fast.nnz + slow.nnz), "stable": found["stable"], "proven": found["proven"],
                     "measured": found["measured"], "seconds": round(time.process_time() - start, 2)})
        print(rows[-1], file=sys.stderr, flush=True)
    print(json.dumps({"program": kd.__version__, "rows": rows}, indent=2))


if __name__ == "__main__":
    main()
