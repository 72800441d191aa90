"""Half a period along an orbit: its kicks and drifts, the Hessians at its kicks, its multipliers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np
import numpy.typing as npt

from kickdrift._errors import KickdriftError
from kickdrift._held import Held
from kickdrift._hessians import SMOOTHER, Force, differences, usable
from kickdrift._kicks import schedule
from kickdrift._numbers import frozen
from kickdrift._progress import Progress
from kickdrift._rigid import Doubles, norm


@dataclass(frozen=True)
class Struck:
    """A kick that was made: how long its group acted, the rows of the propagator that say where the atoms were, the
    error of its Hessian, which the differences leave, and its norm; the group, the positions, the Hessian, and what the
    turning of held distances adds to that."""

    duration: float
    rows: Doubles
    error: float
    size: float
    group: int
    positions: Doubles
    stiffness: Doubles
    shape: Doubles | float = 0.0


def eigenvalues(half: Doubles, struck: Sequence[Struck], residual: float) -> tuple[npt.NDArray[np.complex128], Doubles]:
    """The eigenvalues mu of B^T C, and how far each is off, to first order, where each kick's Hessian is by its error.

    A kick changed by dK changes the half period by S (0, -h dK X), X the rows at the kick and S what comes after it,
    which a symplectic matrix's own entries tell: from velocities S = half (-B_k^T, A_k^T). The change of mu
    with the eigenvectors y and x is y* (dB^T C + B^T dC) x over y* x.
    """
    n = len(half) // 2
    b, c = half[:n, n:], half[n:, :n]
    values, right = np.linalg.eig(b.T @ c)
    # Rows of the inverse are left eigenvectors with y* x = 1.
    left = np.linalg.inv(right)
    cx, by = c @ right, b @ left.T
    doubts = np.zeros(len(values))
    for kick in struck:
        before, speeds = kick.rows[:, :n], kick.rows[:, n:]
        after = half[:, n:] @ before.T - half[:, :n] @ speeds.T
        off = kick.duration * (kick.error + residual * kick.size)
        along = np.linalg.norm(speeds @ left.T, axis=0) * np.linalg.norm(after[:n].T @ cx, axis=0)
        along += np.linalg.norm(after[n:].T @ by, axis=0) * np.linalg.norm(before @ right, axis=0)
        doubts += off * along
    doubts += _ROUNDING * np.linalg.norm(left, axis=1) * np.linalg.norm(right, axis=0)
    return frozen(values.astype(np.complex128)), frozen(doubts)


#: Products of some ten matrices of the size of one are rounded by about this, n some hundreds.
_ROUNDING = 1e-13


@dataclass(frozen=True, eq=False)
class Half:
    """Half a period from rest: the propagator of deviations in the frames at its ends, the mass-weighted velocity at
    its end and that frame, the kicks, the time and factors of each drift along held distances, and the factors of their
    gradients in the last velocity."""

    matrix: Doubles
    speed: Doubles
    first: Doubles
    last: Doubles
    struck: list[Struck]
    drifts: list[tuple[float, Doubles]]
    taken: Doubles


def compose(
    forces: Sequence[Force],
    steps: Sequence[Fraction],
    start: Doubles,
    held: Held,
    difference: float,
    still: bool = False,
    progress: Progress | None = None,
) -> Half:
    """Half a period along the orbit from rest at ``start``, or about ``start`` itself where ``still``.

    Velocities along the gradients of held distances are carried along: the next drift takes them out, as RATTLE does.
    At both ends the velocity vanishes but for those, so frames of what is free are canonical coordinates there, and the
    propagator is symplectic.
    """
    first = allowed = held.frame(start)
    position, speed = start.copy(), np.zeros(start.size)
    at, going = np.hstack([first, np.zeros_like(first)]), np.hstack([np.zeros_like(first), first])
    known: dict[int, tuple[Doubles, float, float]] = {}
    struck, drifts = [], []
    last, kicks = Fraction(0), schedule(steps)
    strikes = sum(len(kick.groups) for kick in kicks)
    for kick in kicks:
        drift = float(kick.time - last)
        if still:
            at = at + drift * going
        elif drift:
            reached, speed, factors = held.drift(position, speed, drift)
            at, going = held.led(position, reached, factors, drift, at, going)
            drifts.append((drift, factors))
            position, allowed = reached, held.frame(reached)
        for group, duration in kick.groups:
            if not (still and group in known):
                known[group] = differences(forces[group], position, held.masses, difference)
            stiffness, correction, asymmetry = known[group]
            size = norm(stiffness)
            # For smooth forces the fourth order leaves the square of the second order's error, relative to the whole.
            error = correction**2 / max(size, 1e-300) + asymmetry
            made = (group, position, stiffness)
            struck.append(Struck(float(duration), allowed.T @ at, error, size, *made))
            if progress is not None:
                progress(len(struck), strikes)
            if still:
                stiffness = stiffness + held.curvature(forces[group](position), position)
                going = going - float(duration) * (allowed @ (allowed.T @ (stiffness @ at)))
            else:
                going = going - float(duration) * (stiffness @ at)
                speed = speed + float(duration) * forces[group](position).ravel() / held.root
        last = kick.time
    # Deviations turn the gradients, along which the velocity does not vanish.
    taken = held.along(speed, position)
    going = going - held.bent(taken) @ at
    return Half(
        np.vstack([allowed.T @ at, allowed.T @ going]), allowed.T @ speed, first, allowed, struck, drifts, taken
    )


def swing(forces: Sequence[Force], steps: Sequence[Fraction], start: Doubles, held: Held) -> Doubles:
    """The mass-weighted velocity after half a period from rest, but for what held distances take up."""
    position, speed, last = start.copy(), np.zeros(start.size), Fraction(0)
    for kick in schedule(steps):
        if kick.time > last:
            position, speed, _ = held.drift(position, speed, float(kick.time - last))
        for group, duration in kick.groups:
            speed = speed + float(duration) * forces[group](position).ravel() / held.root
        last = kick.time
    if not held.distances:
        return speed
    return speed - held.gradients(position).T @ held.along(speed, position)


def plain(
    half: Half, steps: Sequence[Fraction], held: Held, ahead: float
) -> tuple[list[Struck], tuple[Doubles, Doubles]]:
    """The kicks of half a period along held distances in coordinates in which drifts between them are plain, and the
    frames at both ends.

    Deviations are y = F_k a at the k-th kick, p = F_kᵀ v, for a basis F_k of what is free. RATTLE's drift with the
    factors l is a kick by -F_kᵀ (sum of l_c grad grad g_c) F_k/t and then F_{k+1} a' = F_k a + t v, but for what the
    gradients at the k-th kick take up. Times F_kᵀ, where F_k is chosen so that F_kᵀ F_{k+1} = 1, the last one
    orthonormal, this is
    a' = M_k a + t p with M_k = F_kᵀ F_k; and p' = F_{k+1}ᵀ (F_{k+1} a' - F_k a)/t = (M_{k+1} a' - a)/t. That is a kick
    by (1 - M_k)/t, the drift a' = a + t p, and a kick by (1 - M_{k+1})/t. All these are symmetric, and are added to the
    Hessians of the fastest clock. Where Newton's next step would move the atoms by ``ahead``, frames turn by that over
    a held distance, and tensions change by the Hessians times it.

    Raises
    ------
    KickdriftError
        Where some kick is none of the fastest clock's.
    """
    fastest, strikes = min(range(len(steps)), key=lambda k: steps[k]), iter(half.struck)
    # Half a period that ends between two kicks ends at rest where the last one was: no kick is made there.
    kicks = [kick for kick in schedule(steps) if kick.groups]
    made = [[next(strikes) for _ in kick.groups] for kick in kicks]
    if any(fastest not in [strike.group for strike in kicks] for kicks in made):
        raise KickdriftError("steps", "no multiples of the fastest", "choose such, for a proof along held bonds")
    frames = [held.frame(kicks[0].positions) for kicks in made]
    for k in reversed(range(len(frames) - 1)):
        frames[k] = frames[k] @ np.linalg.inv(frames[k + 1].T @ frames[k])
    struck, nearest = [], min(distance for _, _, distance in held.distances)
    for place, (frame, together) in enumerate(zip(frames, made, strict=True)):
        apart = np.eye(frame.shape[1]) - frame.T @ frame
        times = [half.drifts[k][0] for k in (place - 1, place) if 0 <= k < len(half.drifts)]
        shape = np.asarray(sum(apart / time for time in times))
        if place < len(half.drifts):
            time, factors = half.drifts[place]
            shape = shape - frame.T @ held.bent(factors) @ frame / time
        else:
            # Where it turns, the velocity does not vanish along the gradients, which deviations turn.
            shape = shape + frame.T @ held.bent(half.taken) @ frame
        for strike in together:
            added: Doubles | float = 0.0
            stiffness, error = frame.T @ strike.stiffness @ frame, strike.error * norm(frame) ** 2
            if strike.group == fastest:
                pulls = sum(other.duration * other.size for other in together)
                off = _SHAPED * sum(1 / time for time in times) + (norm(shape) + pulls) * ahead / nearest
                added, error = (shape + shape.T) / 2 / strike.duration, error + off / strike.duration
            struck.append(replace(strike, stiffness=stiffness, error=error, shape=added))
    return struck, (frames[0], frames[-1])


#: Frames and factors are rounded by this part of 1: some digits are lost where positions are large over what is held.
_SHAPED = 1e-13


#: What is proven holds for Hessians ten times farther from those measured than these are seen to be off. For a power
#: law x^-n differences of fourth order leave 1.2 (n + 4) (n + 5)/(n + 2)/(n + 3) of what is seen: 3 for Coulomb's law,
#: less for others; rounding leaves some times more or less in the symmetric part than in the other, which is seen.
_FARTHER = 10.0


def along(
    struck: Sequence[Struck], steps: Mapping[str, Fraction], root: Doubles, ahead: float
) -> tuple[dict[str, tuple[Fraction, Doubles]], float]:
    """The Hessians along the orbit by step, in force over length, and how well all are known, relative to the largest
    norm of each step's.

    Newton's next step, of the length ``ahead``, would change the Hessians in its share of the way along which they are
    seen to change.

    Raises
    ------
    KickdriftError
        Where a tenth of a Hessian is unknown.
    """
    kinds = list(steps)
    potentials, worst = {}, 1e-12
    for step in sorted(set(steps.values())):
        groups = [place for place, name in enumerate(kinds) if steps[name] == step]
        by_group = [[kick for kick in struck if kick.group == place] for place in groups]
        matrices = [np.sum([kick.stiffness for kick in kicks], axis=0) for kicks in zip(*by_group, strict=True)]
        errors = [sum(kick.error for kick in kicks) for kicks in zip(*by_group, strict=True)]
        added = [sum(kick.shape for kick in kicks) for kicks in zip(*by_group, strict=True)]
        whole = [matrix + shape for matrix, shape in zip(matrices, added, strict=True)]
        size = max(1e-300, *(norm(matrix) for matrix in whole))
        where = [kick.positions for kick in by_group[0]]
        changes = 0.0
        for k in range(len(where) - 1):
            way = float(np.abs(where[k + 1] - where[k]).max())
            if way > ahead:
                changes = max(changes, norm(matrices[k + 1] - matrices[k]) / way)
        worst = max(worst, _FARTHER * (max(errors) + changes * ahead) / size)
        name = ", ".join(kinds[place] for place in groups)
        potentials[name] = (step, np.array(whole) * np.outer(root, root))
    return potentials, usable(worst, "a kick along the orbit", "the one that was taken", SMOOTHER)
