"""The integrator's own periodic orbit: found, followed to other forces and steps, and around its folds."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import pairwise
from typing import Any

import numpy as np

from kickdrift._errors import KickdriftError
from kickdrift._half import Half, along, compose, eigenvalues, plain, swing
from kickdrift._held import Held
from kickdrift._hessians import Force, hessian, journal_of, smooth
from kickdrift._journal import Journal
from kickdrift._kicks import common_tick
from kickdrift._minimum import SMALLEST_PART, firmed
from kickdrift._monodromy import DRIFTS, Monodromy
from kickdrift._numbers import frozen
from kickdrift._progress import Progress
from kickdrift._rigid import Doubles, is_held, off_the_mesh, rigid_motions
from kickdrift._system import System


def _damped(size_at: Callable[[float], float], size: float, tries: int) -> float | None:
    """The largest part of a Newton step, 1, 1/2, ..., that makes the size smaller by a tenth; rounding ends that."""
    return next((part for part in (0.5**k for k in range(tries)) if size_at(part) < 0.9 * size), None)


#: Newton's method has arrived where its next step is this part of the extent of the atoms.
_ARRIVED = 1e-9

#: A step that is no longer is not made: along the orbit Hessians change by it less than differences of doubles see.
_CLOSE_BY = 1e-12


@dataclass(frozen=True, eq=False)
class _Sum:
    """The sum of some forces, less a constant one."""

    forces: Sequence[Force]
    less: Doubles | float = 0.0

    def __call__(self, positions: Doubles) -> Doubles:
        return np.asarray(np.sum([force(positions) for force in self.forces], axis=0) - self.less)

    @property
    def journal(self) -> Journal | None:
        """That of all of them."""
        journals = [each for force in self.forces if (each := journal_of(force)) is not None]
        if not journals or len(journals) < len(self.forces):
            return None
        return replace(
            journals[0], names=("sum", np.asarray(self.less), *(name for each in journals for name in each.names))
        )

    def smooth(self, positions: Doubles, reach: float) -> Force:
        """Where one of them jumps, so does the sum: each as it is about these positions."""
        return _Sum([smooth(force, positions, reach) for force in self.forces], self.less)


@dataclass(frozen=True, eq=False)
class _Family:
    """Orbits by a share, at 1 the orbit that is sought: the forces and steps at each share. Newton's method moves along
    the columns of ``firm``."""

    made: Callable[[float], tuple[Sequence[Force], Sequence[Fraction]]]
    held: Held
    difference: float
    firm: Doubles
    progress: Progress | None


def _newton(family: _Family, share: float, start: Doubles, row: Doubles | None = None) -> _Orbit:
    """Damped Newton's method for rest after half a period.

    It moves along the columns of ``firm``, and along them it seeks rest: of rigid motions there is none to begin with,
    and what has no momentum gets none. Positions are put back on held distances as a drift is. Hessians are kept while
    each step leaves less than a tenth of the velocity: half a period asks for some forces, they for thousands.

    With a ``row``, the share moves too, and steps are at right angles to the row, whose last entry is that of the
    share: so orbits are found where the family folds. These are sought near by, so only by whole steps; what comes with
    them is half a period from beside them.
    """
    held, firm, extent = family.held, family.firm, float(np.ptp(start, axis=0).max()) or 1.0
    many, unit = firm.shape[1], 0.0
    tries, near = (8, _CLOSE_BY) if row is None else (1, _BESIDE)

    def towards(left: Doubles) -> Doubles:
        return np.asarray(np.linalg.lstsq(pulls, -np.append(left, np.zeros(len(pulls) - many)), rcond=None)[0])

    def moved(part: float) -> tuple[Doubles, float]:
        along = half.first @ (half.first.T @ (firm @ move[:many]))
        return held.drift(start, part * along, 1.0)[0], share + part * unit * float(move[many:].sum())

    def left_at(place: Doubles, share: float) -> Doubles:
        return np.asarray(firm.T @ swing(*family.made(share), place, held))

    def size_at(part: float) -> float:
        return float(np.abs(left_at(*moved(part))).max())

    while True:
        half = compose(*family.made(share), start, held, family.difference, progress=family.progress)
        pulls = firm.T @ half.last @ half.matrix[half.first.shape[1] :, : half.first.shape[1]] @ half.first.T @ firm
        every = half.last @ half.speed
        speed = firm.T @ every
        if row is not None:
            # The share in a unit of which, as the row, is as large as the rest.
            change, whole = (left_at(start, share + _BIT) - speed) / _BIT, float(np.linalg.norm(pulls))
            unit = whole / max(float(np.linalg.norm(change)), 1e-300)
            across = np.append(row[:many], unit * row[many])
            across *= whole / float(np.linalg.norm(across))
            pulls = np.vstack([np.column_stack([pulls, unit * change]), across])
        move, size = towards(speed), float(np.abs(speed).max())
        residual = float(np.abs(firm @ move[:many] / held.root).max()) / extent
        part = _damped(size_at, size, tries) if residual > near else None
        if part is None:
            # The whole moves by itself where a mesh pulls at it, and by nothing else.
            rigid, left = rigid_motions(start, held.masses, rotations=False), every - firm @ speed
            left = (left - rigid @ (rigid.T @ left)) / held.root
            drift = float(np.abs(left).max()) * float(common_tick(family.made(share)[1])) / extent
            return _Orbit(share, start, half, residual, drift)
        start, share = moved(part)
        speed = left_at(start, share)
        while float(np.abs(speed).max()) < 0.1 * size:
            move, size = towards(speed), float(np.abs(speed).max())
            there = moved(1.0)
            speed = left_at(*there)
            if not float(np.abs(speed).max()) < size:
                break
            start, share = there
        if row is not None:
            # On the way the place alone is asked for, not half a period from there.
            residual = float(np.abs(firm @ towards(speed)[:many] / held.root).max()) / extent
            if residual <= near:
                return _Orbit(share, start, half, residual, 0.0)


@dataclass(frozen=True, eq=False)
class _Orbit:
    """Where Newton's method ended: the share, positions, half a period from there, the step that would be next over the
    extent of the atoms, and how far what has no stiffness goes in a period."""

    share: float
    positions: Doubles
    half: Half
    residual: float
    drift: float


def monodromy(
    forces: Mapping[str, Force],
    steps: Sequence[Fraction],
    at: Doubles,
    held: Held,
    difference: float,
    about: str,
    unit: str | None = None,
    progress: Progress | None = None,
    *,
    time_unit: str = "",
    is_boxed: bool = False,
    has_field: bool = False,
    has_mesh: bool = False,
) -> Monodromy:
    """The monodromy about a minimum ``at``, or about the periodic orbit that Newton's method finds from there.

    The orbit starts at rest in the middle of a kick of every clock; so it is symmetric in time, and it is closed where
    it is at rest again after half a period: n equations for n positions. Where Newton's method does not find it from
    the minimum, it is followed from there: each group's force less (1 - t) times its value at the minimum, which in the
    total cancel, has the minimum as its orbit at t = 0 and is the force itself at t = 1. Distances are held as RATTLE
    holds them; what they take up of a force counts as none. Where neither finds it, it is followed from shorter steps,
    and where it ends is told in the unit of the steps; ``unit=None`` leaves that out. ``progress`` is called with the
    Hessians of half a period that are done and all of them, at each of Newton's steps. ``time_unit`` is that of the
    steps. In a box translations are rigid motions, where a field holds the atoms none. That is seen in the Hessians but
    of a mesh, which pulls a little at the whole.

    Raises
    ------
    KickdriftError
        An unknown ``about``, or no orbit found.
    """
    pulls = list(forces.values())
    period = common_tick(steps)
    if about == "minimum":
        half = compose(pulls, steps, at, held, difference, still=True, progress=progress)
        values = eigenvalues(half.matrix, half.struck, 0.0)
        why = "about the minimum a system of its Hessians is proven"
        return Monodromy(about, frozen(at.copy()), 0.0, period, frozen(half.matrix), 0.0, *values, None, why, time_unit)
    if about != "orbit":
        raise KickdriftError("about", about, "choose orbit or minimum")
    free = held.frame(at)
    balances = [((free @ (free.T @ (force(at).ravel() / held.root))) * held.root).reshape(at.shape) for force in pulls]
    every = _Sum(pulls)
    total, error = hessian(every, at, held.masses, difference)
    stiffness = total + held.curvature(every(at), at)
    firm = free @ firmed(free.T @ stiffness @ free)

    def lent(share: float) -> tuple[Sequence[Force], Sequence[Fraction]]:
        pairs = zip(pulls, balances, strict=True)
        return [_Sum([force], (1 - share) * balance) for force, balance in pairs], steps

    def shorter(share: float) -> tuple[Sequence[Force], Sequence[Fraction]]:
        return pulls, [Fraction(share) * step for step in steps]

    found, part, _ = _followed(_Family(lent, held, difference, firm, progress), at, 0, 1.0)
    if found is None:
        value, ends = f"orbit, followed to {part:.0%} of the groups' own forces", ", as near a resonance of the kicks"
        if unit is not None:
            found, part, fold = _followed(_Family(shorter, held, difference, firm, progress), at, 1, _ENDS)
            if part:
                outer = float(max(steps))
                ends = f". From shorter steps at the same ratios it is followed to {outer * part:.6g} {unit}"
                if fold < np.inf:
                    ends += f" and folds at {outer * fold:.5g} {unit}, where it meets another orbit"
    if found is None:
        raise KickdriftError("about", value, f"it ends there{ends}: choose another step, or about='minimum'")
    start = found.positions
    if found.drift > DRIFTS:
        remedy = (
            f"does not close: its softest motions drift by {found.drift:.0e} of the extent in a period, as bends of "
            "a chain of bonds alone, or a molecule that is loosely bound; give these a force, or about='minimum'"
        )
        raise KickdriftError("about", "orbit", remedy)
    half = found.half
    away = float(np.linalg.norm(start - at, axis=1).max())
    values = eigenvalues(half.matrix, half.struck, found.residual)
    measured = (about, frozen(start.copy()), away, period, frozen(half.matrix), found.residual, *values)
    moved = rigid_motions(start, held.masses, rotations=False)
    keep = has_field or (not has_mesh and is_held([total], moved, error))
    sides: dict[str, Any] = {"positions": start, "turned": half.struck[-1].positions, "periodic": is_boxed}
    masses, root, struck = held.masses, held.root, half.struck
    ahead = found.residual * (float(np.ptp(start, axis=0).max()) or 1.0)
    try:
        if held.distances:
            struck, frames = plain(half, steps, held, ahead)
            motions = [rigid_motions(sides[end], masses, rotations=not is_boxed) for end in ("positions", "turned")]
            rigid = [
                np.linalg.lstsq(frame, motion, rcond=None)[0] for frame, motion in zip(frames, motions, strict=True)
            ]
            sides = {} if keep else {"rigid": np.array(rigid)}
            masses = root = np.ones(half.first.shape[1])
        potentials, accuracy = along(struck, dict(zip(forces, steps, strict=True)), root, ahead)
        if is_boxed and not keep and not held.distances:
            weight = np.outer(root, root)
            # The system of the minimum says it once; a note for every kick would repeat that.
            unread: list[str] = []
            for name, (step, kicks) in potentials.items():
                cleaned = [off_the_mesh(kick / weight, moved, name, accuracy, unread) * weight for kick in kicks]
                potentials[name] = (step, np.array(cleaned))
    except KickdriftError as refused:
        return Monodromy(*measured, None, str(refused), time_unit, found.drift)
    made = System.along_orbit(masses, potentials, accuracy=accuracy, time_unit=time_unit, keep_rigid=keep, **sides)
    return Monodromy(*measured, made, "", time_unit, found.drift)


#: A fold is known to this part of the steps asked about: it is shown with five digits, of which four are meant.
_ENDS = 1 / 4096

#: So many orbits are looked for along a family at most.
_MANY = 40

#: Orbits on the way to it are known to this part of the extent, a thousandth of what they move.
_BESIDE = 1e-6

#: By such a change of the share that of the velocity is measured, to as small a part: Newton's method mends that.
_BIT = 2.0**-16

#: The next orbit is sought so far ahead that it is off by this part of the way there: whole Newton steps reach it.
_OFF = 0.2


def _followed(family: _Family, at: Doubles, halvings: int, near: float) -> tuple[_Orbit | None, float, float]:
    """The orbit at the share 1, or None; the largest share reached on the way from ``at``, the orbit at 0; and where
    the family folds, or infinity.

    The first one is sought from ``at`` itself, at 1 after so many halvings and more; each other one ahead of the last,
    on the parabola by the last three, as share and positions move, each relative to what it is. So they are found where
    the share turns back, too: there the family folds, two orbits meet, and neither goes on. That share is sought to
    ``near``. What is found farther from where it was sought than that is from the last is of another family.
    """
    held = family.held

    def found_from(place: Doubles, row: Doubles | None) -> _Orbit | None:
        try:
            found = _newton(family, float(place[0]), place[1:].reshape(at.shape), row)
        except (KickdriftError, np.linalg.LinAlgError):
            return None
        return found if found.residual <= (_ARRIVED if row is None else _BESIDE) else None

    def moved(way: Doubles, weight: float) -> Doubles:
        return np.append(family.firm.T @ (held.root * way[1:]), weight * way[0])

    def size(way: Doubles, weight: float) -> float:
        return float(np.linalg.norm(moved(way, weight)))

    def parabola(three: Sequence[Doubles], weight: float) -> tuple[float, Doubles]:
        """The length from the last but one to the last, and the coefficients over the length from there."""
        ways = [size(there - here, weight) for here, there in pairwise(three)]
        lengths = np.cumsum([0.0, *ways]) - sum(ways)
        return ways[-1], np.polyfit(lengths, np.array(three), len(ways))

    first = (_newton(family, 0.5**k, at) for k in range(halvings, 8))
    found = next((orbit for orbit in first if orbit.residual <= _ARRIVED), None)
    if found is None or found.share == 1:
        return found, float(found is not None), np.inf
    known = [np.append(0.0, at), np.append(found.share, found.positions)]
    stretch, is_refused = 1.0, False
    for _ in range(_MANY):
        last = known[-1]
        if last[0] < known[-2][0] or abs(stretch) < SMALLEST_PART:
            break
        weight = size(last - known[0], 0.0) / last[0]
        length, curve = parabola(known[-3:], weight)
        ones = np.roots(np.append(curve[:-1, 0], curve[-1, 0] - 1))
        ends = [float(end.real) for end in ones if np.isreal(end) and -length < end.real <= stretch * length]
        ahead, is_last = min(ends, default=stretch * length), bool(ends) and not is_refused
        if ahead < 0 and not is_last:
            break
        there: Doubles = np.polyval(curve, ahead).astype(float)
        there[1:] = held.drift(last[1:].reshape(at.shape), held.root * (there - last)[1:], 1.0)[0].ravel()
        there[0] = 1.0 if is_last else there[0]
        found = found_from(there, None if is_last else moved(there - last, weight**2))
        reached = last if found is None else np.append(found.share, found.positions)
        off = size(reached - there, weight) / size(there - last, weight)
        if found is None or off > 1:
            stretch, is_refused = ahead / length if is_last else ahead / length / 3, is_refused or is_last
        elif is_last:
            return found, 1.0, np.inf
        else:
            known.append(reached)
            # Off by the square of how far ahead.
            stretch, is_refused = min(2.0, (_OFF / max(off, 1e-300)) ** 0.5), False
    fold = np.inf
    while len(known) < 2 * _MANY:
        place = max(range(len(known)), key=lambda k: float(known[k][0]))
        if not 0 < place < len(known) - 1:
            break
        length, curve = parabola(known[place - 1 : place + 2], 0.0)
        top = -curve[1, 0] / (2 * curve[0, 0])
        there = np.polyval(curve, top).astype(float)
        fold = float(there[0])
        if fold <= known[place][0] + near:
            break
        found = found_from(there, moved(known[place + 1] - known[place - 1], 0.0))
        if found is None:
            break
        known.insert(place + (top > -length), np.append(found.share, found.positions))
    return None, max(float(orbit[0]) for orbit in known), fold
