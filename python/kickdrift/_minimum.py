"""Where forces vanish: Newton's method, led there where it must be."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt

from kickdrift._errors import KickdriftError
from kickdrift._held import Held
from kickdrift._hessians import Force, hessian, smooth
from kickdrift._lanczos import by_differences, top
from kickdrift._progress import Progress
from kickdrift._rigid import Doubles, norm, rigid_motions


def minimum(
    force: Force,
    positions: Doubles,
    held: Held,
    difference: float,
    columns: Sequence[int] | None = None,
    is_boxed: bool = False,
    reach: float = np.inf,
    far: float = np.inf,
    progress: Progress | None = None,
) -> tuple[Doubles, Force]:
    """The minimum beside the positions by Newton's method, and the force whose minimum it is.

    It moves along the held distances, with the soft directions left out and the translations of a box, whose Ewald sums
    pull at it as a whole where its mesh is; against the force where the stiffness is negative. A Hessian is kept while
    each step leaves less than a tenth of the force.

    Forces that jump, as where pairs cross a cutoff, need have no minimum. So they are taken as smooth as they are about
    a place within ``reach``, down to the minimum of that; then anew from there, until what jumps is on its own side at
    the minimum, too. Where it never is, the place where the least is left of the forces as they are comes back with the
    smooth force.

    Parameters
    ----------
    columns : sequence of int, optional
        The degrees of freedom to move, all 3n unless given: the others stand still.
    is_boxed : bool
        Whether translations move nothing, but for a mesh.
    reach : float
        Within which forces are known to be smooth; no coordinate moves by more than a seventh of it at once.
    far : float
        How far a coordinate may go in all; where a step would lead farther, it ends there.
    progress : callable, optional
        Called with the columns done and the columns in all, for each Hessian.

    Raises
    ------
    KickdriftError
        Where Newton's method does not arrive, or at a saddle: the positions are not near a minimum.
    """
    kept = np.arange(positions.size) if columns is None else np.asarray(columns)
    root, place = held.root[kept], held.back(positions, columns)
    bend = np.empty((0, 0))
    descent, best, hessians, is_far = _descent(bend), (np.inf, place, force, np.inf), 0, True
    vain = 0
    for _ in range(_ROUNDS):
        begun, here, smallest, size, idle = place, smooth(force, place, reach), np.inf, np.inf, 0
        while hessians < _HESSIANS:
            frame = free(held, place, columns, is_boxed)
            pulled = frame.T @ (here(place).ravel()[kept] / root)
            size = float(np.linalg.norm(pulled))
            # Rounding ends the fall of the force: two steps without a tenth less are the end.
            idle = idle + 1 if not size < 0.9 * smallest else 0
            if idle == 2 or np.abs(place - begun).max() > reach / 8:
                break
            is_new = is_far or (size > 0.1 * smallest and size > rounding_of(bend, held.masses))
            smallest, is_far = min(smallest, size), False
            if is_new:
                bend, _ = hessian(here, place, held.masses, difference, columns, progress)
                bend, hessians = bend + held.curvature(here(place), place, columns), hessians + 1
            if is_new or held.distances:
                descent = _descent(frame.T @ bend @ frame)
            along = frame @ descent(pulled)
            place = _moved(here, held, place, kept, along, reach / 7)
            if max(np.abs(along / root).max(initial=0.0), np.abs(place - positions).max()) > far:
                raise KickdriftError("positions", f"moved by {far:g}", "are not near a minimum: minimize them first")
        is_far = bool(np.abs(place - begun).max() > reach / 8)
        if is_far:
            continue
        left = float(np.linalg.norm(frame.T @ (force(place).ravel()[kept] / root)))
        vain = 0 if left < 0.9 * best[0] else vain + 1
        if left < best[0]:
            best = (left, place, here, min(smallest, left))
        if here is force or left < rounding_of(bend, held.masses) or hessians >= _HESSIANS or vain == _VAIN:
            break
    if best[0] < np.inf:
        _, place, here, size = best
    bend, _ = hessian(here, place, held.masses, difference, columns, progress)
    frame = free(held, place, columns, is_boxed)
    arrived(size, frame.T @ (bend + held.curvature(here(place), place, columns)) @ frame, held.masses)
    return place, here


#: Hessians that a minimum may take, how often what jumps is looked at anew, and how often in vain: pairs that jump to
#: and fro come to rest on neither side.
_HESSIANS, _ROUNDS, _VAIN = 30, 30, 4


def free(held: Held, where: Doubles, columns: Sequence[int] | None, is_boxed: bool) -> Doubles:
    """An orthonormal basis of the deviations that held distances leave free; of a box without its translations."""
    frame = held.frame(where, columns)
    if not is_boxed:
        return frame
    moved = frame.T @ rigid_motions(where, held.masses, rotations=False)
    return np.asarray(frame @ np.linalg.svd(moved.T)[2][moved.shape[1] :].T)


def _descent(matrix: Doubles) -> Callable[[Doubles], Doubles]:
    """Newton's step for a pull, against negative stiffness as if it were positive, the soft directions left out."""
    values, vectors = np.linalg.eigh(matrix)
    firm = np.abs(values) > _SOFT * np.abs(values).max(initial=0.0)
    values, vectors = np.abs(values[firm]), vectors[:, firm]
    return lambda right: np.asarray(vectors @ ((vectors.T @ right) / values))


def _moved(
    force: Force, held: Held, place: Doubles, kept: npt.NDArray[np.intp], along: Doubles, most: float
) -> Doubles:
    """Positions after a step, as much of it as moves no coordinate by more than ``most`` and leaves less than half of
    what pulls along it pulling back."""
    root = held.root[kept]
    part = min(1.0, most / max(float(np.abs(along / root).max(initial=0.0)), 1e-300))
    columns = None if len(kept) == place.size else list(kept)
    least = -0.5 * float(along @ (force(place).ravel()[kept] / root))
    while True:
        moved = place.copy()
        moved.flat[kept] += part * along / root
        moved = held.back(moved, columns)
        if part < SMALLEST_PART or float(along @ (force(moved).ravel()[kept] / root)) > least:
            return moved
        part /= 2


def cooled(force: Force, where: Doubles, held: Held, difference: float) -> Doubles:
    """Positions nearer to a minimum, by dynamics that lose what leads uphill (FIRE, Bitzek and others 2006).

    It asks for forces alone, where energies that jump at a cutoff stop a minimizer that compares them. Far from a
    minimum a step of Newton's method costs as much as a thousand of these, and is kept as short. It ends where its
    steps get short, at a jump of the forces, or after ``_COOLED`` of them.
    """
    product = by_differences(force, where, held.root, difference)
    longest = 1.0 / float(np.sqrt(max(top(product, where.size, _ROUGH).found, 1e-300)))
    # The numbers are those of the paper.
    step, share, uphill, speed = longest, 0.1, 0, np.zeros(where.size)
    best = (np.inf, where)
    for _ in range(_COOLED):
        pull = force(where).ravel() / held.root
        pull -= held.gradients(where).T @ held.along(pull, where)
        size = float(np.linalg.norm(pull))
        best = min(best, (size, where), key=lambda candidate: candidate[0])
        if step < longest / 1000 or size == 0.0:
            break
        if pull @ speed > 0:
            speed, uphill = (1 - share) * speed + share * np.linalg.norm(speed) / size * pull, uphill + 1
            if uphill > 5:
                step, share = min(1.1 * step, longest), 0.99 * share
        else:
            step, share, uphill, speed = step / 2, 0.1, 0, np.zeros(where.size)
        speed = speed + step * pull
        speed *= min(1.0, _FAR * difference / max(step * float(np.abs(speed / held.root).max()), 1e-300))
        try:
            where, speed, _ = held.drift(where, speed, step)
        except KickdriftError:
            break
    return best[1]


#: Products of Lanczos' method for the stiffest motion, to a tenth; steps towards a minimum, by forces alone; and how
#: many differences of positions the longest of them is.
_ROUGH, _COOLED, _FAR = 12, 5000, 50


def arrived(pull: float, stiffness: Doubles, masses: Doubles) -> None:
    """That so small a mass-weighted pull is rounding: less than a displacement of 1e-9 would bring about.

    Raises
    ------
    KickdriftError
        Where it is not, so that Newton's method did not arrive; where it arrived at a saddle.
    """
    if not pull < rounding_of(stiffness, masses):
        raise KickdriftError("positions", f"force {pull:.1e}", "are not near a minimum: minimize them first")
    values = np.linalg.eigvalsh(stiffness)
    if values.size and values[0] < -_SOFT * np.abs(values).max():
        remedy = "are near a saddle, from which something falls: minimize them first"
        raise KickdriftError("positions", f"stiffness {values[0]:.1e}", remedy)


#: Directions softer than this part of the stiffest are rigid motions: they are left where they are.
_SOFT = 1e-7


def rounding_of(stiffness: Doubles, masses: Doubles) -> float:
    """The mass-weighted pull that a displacement of 1e-9 brings about at most."""
    return 1e-9 * norm(stiffness) * float(np.sqrt(masses.max()))


def firmed(matrix: Doubles) -> Doubles:
    """The eigenvectors of a symmetric matrix but for the soft ones, which are rigid motions."""
    values, vectors = np.linalg.eigh(matrix)
    return np.asarray(vectors[:, np.abs(values) > _SOFT * np.abs(values).max()])


#: Where no such part of a way can be made, it is given up.
SMALLEST_PART = 1 / 100
