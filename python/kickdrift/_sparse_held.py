"""Held distances by sparse factors: what they leave free, and what they add to a Hessian."""

from __future__ import annotations

from typing import Any

import numpy as np

from kickdrift._errors import KickdriftError
from kickdrift._held import Held
from kickdrift._lanczos import Product
from kickdrift._rigid import Doubles
from kickdrift._scipy import linalg, sparse


def projection(held: Held, where: Doubles) -> Product:
    """Onto the deviations that held distances leave free, by sparse factors: thousands of them are no matter."""
    if not held.distances:
        return lambda vector: vector
    gradients, solve = _gradients(held, where)
    return lambda vector: np.asarray(vector - gradients.T @ solve(gradients @ vector))


def _gradients(held: Held, where: Doubles) -> tuple[Any, Product]:
    """The gradients of held distances, one a row, and what solves with them times their transpose."""
    i, j = (np.array([distance[k] for distance in held.distances]) for k in (0, 1))
    apart, axes, rows = where[i] - where[j], np.tile(np.arange(3), len(i)), np.repeat(np.arange(len(i)), 3)
    places = np.concatenate([3 * i.repeat(3) + axes, 3 * j.repeat(3) + axes])
    values = np.concatenate([apart.ravel(), -apart.ravel()]) / held.root[places]
    gradients = sparse.csr_matrix((values, (np.concatenate([rows, rows]), places)), shape=(len(i), where.size))
    try:
        return gradients, linalg.splu((gradients @ gradients.T).tocsc()).solve
    except RuntimeError as cause:
        raise KickdriftError("system", f"{len(i)} constraints", "depend on each other: leave those out") from cause


def curvature(held: Held, where: Doubles, force: Doubles) -> Any:
    """What held distances add to a Hessian, as :meth:`Held.curvature` says: a sparse matrix, 0 where none are held."""
    if not held.distances:
        return sparse.csr_matrix((where.size, where.size))
    gradients, solve = _gradients(held, where)
    factors = solve(gradients @ (force.ravel() / held.root))
    i, j = (np.array([distance[k] for distance in held.distances]) for k in (0, 1))
    values, places = [factors, factors, -factors, -factors], ([i, j, i, j], [i, j, j, i])
    rows, columns = (np.concatenate(parts) for parts in places)
    blocks = sparse.csr_matrix((np.concatenate(values), (rows, columns)), shape=(len(where), len(where)))
    weights = sparse.diags(1 / held.root)
    return (weights @ sparse.kron(blocks, sparse.identity(3)) @ weights).tocsr()


def weighted(matrix: Any, root: Doubles) -> Any:
    """The mass-weighted matrix of one that is not."""
    weights = sparse.diags(1 / root)
    return (weights @ matrix @ weights).tocsr()
