"""Hessians of groups of forces by differences, and how well they are known.

Coordinates are mass-weighted throughout, x = M^½ (r - r0): a kick of strength h is v -= h K x, a drift x += h v.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import TypeAlias

import numpy as np

from kickdrift._errors import KickdriftError
from kickdrift._journal import Journal
from kickdrift._progress import Progress
from kickdrift._rigid import Doubles, norm

Force: TypeAlias = Callable[[Doubles], Doubles]
"""The force of one group at positions: (n, 3) to (n, 3), energy/length."""


def smooth(force: Force, positions: Doubles, reach: float) -> Force:
    """The force as it is about these positions, while no distance changes by more than ``reach``: engines' forces that
    jump within that, as where pairs cross a cutoff, have a ``smooth`` of their own."""
    smoother = getattr(force, "smooth", None)
    return force if smoother is None else smoother(positions, _MARGIN * reach)


def journal_of(force: Force) -> Journal | None:
    """Where differences of this force are kept, if they are: forces that are known by a name have a ``journal``."""
    journal: Journal | None = getattr(force, "journal", None)
    return journal


def force_at(force: Force, positions: Doubles) -> Doubles:
    """The force at these positions, kept beside its differences: an engine's threads may add up in another order."""
    journal = journal_of(force)
    return force(positions) if journal is None else journal.kept(partial(force, positions), "force", positions)


def hessian(
    force: Force,
    positions: Doubles,
    masses: Doubles,
    difference: float,
    columns: Sequence[int] | None = None,
    progress: Progress | None = None,
    symmetric: bool = True,
    rounding: float = 0.0,
) -> tuple[Doubles, float]:
    """A mass-weighted Hessian by central differences of fourth order, and an estimate of its error.

    Parameters
    ----------
    force : callable
        (n, 3) to (n, 3).
    positions : array, shape (n, 3)
    masses : array, shape (n,)
    difference : float
        d; forces are taken at distances d and 2d.
    columns : sequence of int, optional
        The degrees of freedom to keep, all 3n unless given: the others stand still.
    symmetric : bool
        Whether the force is a gradient.
    rounding : float
        The unit roundoff of the forces where it is no double's.

    Returns
    -------
    (array, float)
        The symmetric part, and the error as a 2-norm: the correction from second to fourth order, of which what is left
        is a small part, plus the antisymmetric part. For a force that is no gradient it is the whole matrix, whose
        asymmetry is no error.
    """
    matrix, correction, asymmetry = differences(force, positions, masses, difference, columns, progress, symmetric)
    if rounding:
        # Noise is as large in the symmetric part, but for chance; on the diagonal it is unseen: a force's own rounding.
        pull = float(np.abs(force_at(force, positions)).max())
        asymmetry = _CHANCE * asymmetry + 2 * rounding * pull / (difference * float(masses.min()))
    return matrix, correction + asymmetry


#: With this the error was at most 0.8 of its estimate in 832 Hessians of 2 to 27 waters in single precision.
_CHANCE = 4.0


def differences(
    force: Force,
    positions: Doubles,
    masses: Doubles,
    difference: float,
    columns: Sequence[int] | None = None,
    progress: Progress | None = None,
    symmetric: bool = True,
) -> tuple[Doubles, float, float]:
    """The Hessian, the correction from second to fourth order, and the antisymmetric part, as 2-norms."""
    kept = np.arange(positions.size) if columns is None else np.asarray(columns)
    root = np.sqrt(np.repeat(masses, 3))[kept]
    second, fourth = np.empty((len(kept), len(kept))), np.empty((len(kept), len(kept)))
    force = smooth(force, positions, 2 * difference)

    def beside(column: int) -> Doubles:
        return np.array([_difference(force, positions, column, width)[kept] for width in (difference, 2 * difference)])

    journal = journal_of(force)
    for place, column in enumerate(kept):
        if journal is None:
            near, far = beside(column)
        else:
            near, far = journal.kept(partial(beside, column), "column", positions, kept, float(column), difference)
        second[:, place], fourth[:, place] = near, (4 * near - far) / 3
        if progress is not None:
            progress(place + 1, len(kept))
    second, fourth = (-matrix / np.outer(root, root) for matrix in (second, fourth))
    if not symmetric:
        return fourth, norm(fourth - second), 0.0
    mean = (fourth + fourth.T) / 2
    return mean, norm(fourth - second), norm(fourth - mean)


#: Rounding of distances, generously.
_MARGIN = 1.001


def _difference(force: Force, positions: Doubles, column: int, width: float) -> Doubles:
    moved = positions.copy()
    moved.flat[column] += width
    ahead = force(moved).ravel()
    moved.flat[column] -= 2 * width
    return (ahead - force(moved).ravel()) / (2 * width)


#: What makes a jump at a cutoff smaller, where nothing is known of the forces.
SMOOTHER = "a switching function or a longer cutoff"


def seen(matrix: Doubles, error: float, name: str, difference: str, smoother: str = SMOOTHER) -> float:
    """How well a measured Hessian is known, relative to its norm: at least rounding.

    Raises
    ------
    KickdriftError
        Where a tenth of it is unknown: no verdict holds for so uncertain a Hessian.
    """
    return usable(error / max(norm(matrix), 1e-300), name, difference, smoother)


def usable(known: float, name: str, difference: str, smoother: str) -> float:
    """How well a Hessian is known relative to its norm, at least rounding; refused where that is too little."""
    accuracy = max(known, 1e-12)
    if accuracy >= _UNKNOWN:
        remedy = (
            "is too uncertain for any verdict: its forces jump or bend within the differences, as where pairs cross a "
            f"cutoff; take {smoother}; or another difference than {difference}"
        )
        raise KickdriftError("system", f"the Hessian of {name}, known to {accuracy:.0%} of its norm", remedy)
    return accuracy


#: The library takes Hessians that are known better than this.
_UNKNOWN = 0.1
