"""The stiffest motion by Lanczos' method, without a Hessian, for any number of atoms.

Coordinates are mass-weighted. A symmetric matrix has eigenvalues from a to b; k steps from a random direction find a
largest Ritz value t with b - t <= e (b - a), but for a probability of at most 1.648 sqrt(n) exp(-(2 k - 1) sqrt(e))
(Kuczynski and Wozniakowski, SIAM J. Matrix Anal. Appl. 13, 1992, theorem 4.2, whose matrices are definite; adding a
multiple of 1 changes no step). The same holds at the lower end.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from kickdrift._errors import KickdriftError
from kickdrift._hessians import Force, smooth
from kickdrift._rigid import Doubles

Product = Callable[[Doubles], Doubles]

#: How often Lanczos' bound may fail.
FAILS = 1e-3


@dataclass(frozen=True)
class Top:
    """The upper end of a spectrum: at most ``most``, but for a probability of :data:`FAILS`; at least ``found``."""

    found: float
    most: float
    vector: Doubles


def top(apply: Product, size: int, steps: int) -> Top:
    """The upper end of a symmetric matrix's spectrum by so many products with it, from one random direction."""
    vector = np.random.default_rng(1).normal(size=size)
    basis, diagonal, beside = [vector / np.linalg.norm(vector)], [], []
    for _ in range(min(steps, size)):
        image = apply(basis[-1])
        diagonal.append(float(image @ basis[-1]))
        known = np.array(basis)
        # Twice, so that rounding leaves them orthogonal.
        for _ in range(2):
            image = image - known.T @ (known @ image)
        length = float(np.linalg.norm(image))
        if length <= 1e-12 * max(np.abs(diagonal)):
            break
        beside.append(length)
        basis.append(image / length)
    count = len(diagonal)
    inner = np.diag(diagonal) + sum(np.diag(beside[: count - 1], side) for side in (-1, 1))
    values, vectors = np.linalg.eigh(inner)
    # Each end fails half as often as both may.
    missed = (np.log(1.648 * np.sqrt(size) * 2 / FAILS) / (2 * count - 1)) ** 2
    if len(beside) < count:
        # What the products reach from a random direction is all there is.
        missed = 0.0
    if missed >= 0.25:
        raise KickdriftError("steps", str(count), "of Lanczos' method are too few to bound anything")
    beyond = missed * float(values[-1] - values[0]) / (1 - 2 * missed)
    return Top(float(values[-1]), float(values[-1]) + beyond, np.array(basis[:count]).T @ vectors[:, -1])


def by_differences(force: Force, where: Doubles, root: Doubles, difference: float) -> Product:
    """The product of a mass-weighted Hessian by two forces, no atom displaced by more than ``difference``."""
    # Both atoms of a pair may go their own way.
    force = smooth(force, where, 2 * difference)

    def product(vector: Doubles) -> Doubles:
        moved = (vector / root).reshape(where.shape)
        size = float(np.linalg.norm(moved, axis=1).max())
        step = difference / size * moved
        apart = (force(where - step) - force(where + step)).ravel() / root
        return np.asarray(apart * size / (2 * difference))

    return product
