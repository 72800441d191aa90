"""Rigid motions in coordinates that only OpenMM and ASE know: along constraints, among atoms that a field holds."""

from __future__ import annotations

from collections.abc import Sequence
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


def is_held(matrices: Sequence[Doubles], translations: Doubles, error: float) -> bool:
    """Whether a field holds the atoms, be it that of one potential that another one balances: of a translation, forces
    that know no place leave what differences leave."""
    return any(norm(matrix @ translations) > max(10 * error, 1e-9 * norm(matrix)) for matrix in matrices)


#: A mesh holds less of a stiffness along translations:
#: 2.5e-4 to 4.1e-4 of the reciprocal part of OpenMM's PME, in boxes of
#: 27 and 8 waters. A field that is not told as one holds more.
_MESH = 1e-2


def off_the_mesh(matrix: Doubles, translations: Doubles, name: str, known: float, notes: list[str]) -> Doubles:
    """A mass-weighted Hessian without what the mesh of an Ewald sum holds along translations: the sum it stands for
    knows no place. A note says how much, where it is more than the Hessian is known to."""
    part = norm(matrix @ translations) / (norm(matrix) or 1.0)
    if not known < part <= _MESH:
        return matrix
    notes.append(f"the mesh of a box holds {part:.1e} of {name} along translations: taken out")
    left = matrix - translations @ (translations.T @ matrix)
    return np.asarray(left - (left @ translations) @ translations.T)
