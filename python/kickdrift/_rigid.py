"""Rigid motions of mass-weighted Hessians, found and projected out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

Doubles: TypeAlias = npt.NDArray[np.float64]


def norm(matrix: Doubles) -> float:
    """The 2-norm; of an empty matrix 0."""
    return float(np.linalg.norm(matrix, 2)) if matrix.size else 0.0


def rigid_motions(positions: Doubles, masses: Doubles, rotations: bool = True) -> Doubles:
    """Translations, and rotations unless a periodic cell forbids them: orthonormal mass-weighted columns."""
    root = np.sqrt(masses)
    centred = positions - (masses @ positions) / masses.sum()
    moves = [np.tile(axis, (len(masses), 1)) for axis in np.eye(3)]
    moves += [np.cross(axis, centred) for axis in np.eye(3)] if rotations else []
    columns = np.array([(root[:, None] * move).ravel() for move in moves]).T
    left, sizes, _ = np.linalg.svd(columns / np.linalg.norm(columns, axis=0).clip(1e-300), full_matrices=False)
    # A rotation about the line of a linear molecule moves nothing: what is left of it is rounding.
    return np.asarray(left[:, sizes > 1e-8])


def is_held(total: Doubles, translations: Doubles, error: float) -> bool:
    """Whether a field holds the atoms: of a translation, forces that know no place leave what differences leave."""
    return norm(total @ translations) > max(10 * error, 1e-9 * norm(total))


def complement(columns: Doubles) -> Doubles:
    """An orthonormal basis of what is orthogonal to the columns."""
    whole, sizes, _ = np.linalg.svd(columns)
    rank = int((sizes > 1e-10 * sizes.max(initial=0.0)).sum())
    return np.asarray(whole[:, rank:])


def is_of_two_levels(steps: Sequence[Fraction]) -> bool:
    """Whether the library projects rigid motions out itself: one step, or two whose ratio is an integer."""
    different = sorted(set(steps))
    return len(different) < 2 or (len(different) == 2 and (different[1] / different[0]).denominator == 1)


def fit(arrays: Mapping[str, Doubles], matrices: Mapping[str, Doubles]) -> bool:
    """Whether the shapes are those of one system; what does not fit is refused where it is decided."""
    n = len(next(iter(matrices.values()))) if matrices else 0
    where = arrays.get("positions")
    square = all(own.shape == (n, n) for own in matrices.values())
    return square and n > 0 and arrays["masses"].size in (n, n / 3) and (where is None or where.size == n)


def without_rigid(
    arrays: Mapping[str, Doubles], matrices: Mapping[str, Doubles], accuracy: float
) -> tuple[dict[str, Doubles], str]:
    """Mass-weighted Hessians without rigid motions: by the positions, else the null space of the total within the
    accuracy, as the library does for two levels."""
    n = len(next(iter(matrices.values())))
    masses = arrays["masses"].ravel()
    masses = masses if masses.size == n else np.repeat(masses, 3)
    weighted = {name: own / np.sqrt(np.outer(masses, masses)) for name, own in matrices.items()}
    where = arrays.get("positions")
    if where is not None:
        rigid, by = rigid_motions(where.reshape(-1, 3), masses[::3]), "positions"
    else:
        values, vectors = np.linalg.eigh(np.sum(list(weighted.values()), axis=0))
        least = accuracy * sum(norm(own) for own in weighted.values())
        rigid, by = vectors[:, np.abs(values) <= least], "null space of the total"
    kept = complement(rigid)
    if not rigid.size or not kept.size:
        return weighted, f"no rigid motions projected out ({by})"
    projected = {name: kept.T @ own @ kept for name, own in weighted.items()}
    return (
        {name: (own + own.T) / 2 for name, own in projected.items()},
        f"{rigid.shape[1]} rigid motions projected out ({by})",
    )
