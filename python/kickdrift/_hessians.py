"""Hessians of groups of forces by differences, at a minimum and along the integrator's own periodic orbit.

Coordinates are mass-weighted throughout, x = M^½ (r - r0): a kick of strength h is v -= h K x, a drift x += h v.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property, partial
from itertools import pairwise
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import numpy.typing as npt

from kickdrift import _plot
from kickdrift._document import Frozen
from kickdrift._errors import KickdriftError
from kickdrift._held import Held
from kickdrift._journal import Journal
from kickdrift._numbers import frozen
from kickdrift._progress import Progress
from kickdrift._rigid import Doubles, is_held, norm, rigid_motions
from kickdrift._system import System, SystemVerdict

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Force: TypeAlias = Callable[[Doubles], Doubles]
"""The force of one group at positions: (n, 3) to (n, 3), energy/length."""


def smooth(force: Force, positions: Doubles, reach: float) -> Force:
    """The force as it is about these positions, while no distance changes by more than ``reach``: engines' forces that
    jump within that, as where pairs cross a cutoff, have a ``smooth`` of their own."""
    own = getattr(force, "smooth", None)
    return force if own is None else own(positions, _MARGIN * reach)


def journal_of(force: Force) -> Journal | None:
    """Where differences of this force are kept, if they are: forces that are known by a name have a ``journal``."""
    own: Journal | None = getattr(force, "journal", None)
    return own


@dataclass(frozen=True)
class Work:
    """What Hessians will take, before they are begun: their columns, how many are kept, seconds a force takes, and how
    many Hessians the way to a minimum or an orbit takes."""

    columns: int
    hessians: int
    evaluation: float
    sought: int = 0

    @staticmethod
    def of_period(columns: int, steps: Sequence[Fraction], evaluation: float, about: str, sought: int = 0) -> Work:
        """That of half a period: about the minimum one Hessian a group, about an orbit one a kick, at each of Newton's
        steps to it; ``sought`` Hessians before these."""
        if about == "minimum":
            return Work(columns, len(steps), evaluation, sought)
        kicks = sum(len(kick.groups) for kick in schedule(steps))
        return Work(columns, kicks, evaluation, sought + STEPS * kicks)

    @property
    def seconds(self) -> float:
        """Four forces a column."""
        return 4 * self.columns * (self.hessians + self.sought) * self.evaluation

    @property
    def bytes(self) -> float:
        """Matrices of doubles: six while one is made, and of each that is kept four copies in the system."""
        return 8.0 * self.columns**2 * (6 + 4 * self.hessians)

    def __str__(self) -> str:
        sought = f" and some {self.sought} on the way there" if self.sought else ""
        forces = 4 * self.columns * (self.hessians + self.sought)
        each = f"{self.hessians} Hessians of {self.columns} columns{sought}, {forces} forces"
        return f"{each} of {1e3 * self.evaluation:.3g} ms: some {_rounded(self.seconds)} s, {self.bytes / 1e9:.2g} GB"

    def begin(self, most: float, is_told: bool, remedy: str) -> None:
        """Say what it is, where that is wanted, and refuse what the library, the memory or ``most`` seconds do not let
        through.

        Raises
        ------
        KickdriftError
            Before anything is computed.
        """
        who = f"{self.columns} degrees of freedom"
        if self.columns > LARGEST:
            raise KickdriftError("system", who, f"dense ones are {LARGEST} at most: {remedy}")
        free = _memory()
        if self.bytes > free:
            raise KickdriftError("system", who, f"there are {free / 1e9:.2g} GB for {self}: {remedy}")
        if self.seconds > most:
            raise KickdriftError("system", who, f"{self}, more than {most:g} s: give longest=SECONDS, or {remedy}")
        if is_told:
            print(self, file=sys.stderr, flush=True)


def _rounded(seconds: float) -> str:
    """Two digits, or whole seconds."""
    return f"{seconds:.0f}" if seconds >= 100 else f"{seconds:.2g}"


#: Hessians that Newton's method makes on its way from beside a minimum; from far away, up to ``_HESSIANS``.
SOUGHT = 4

#: Steps of Newton's method from a minimum to an orbit, some; each makes the Hessians of half a period.
STEPS = 6


#: The library takes dense matrices of so many rows.
LARGEST = 4096


def _memory() -> float:
    """Bytes that programs may have, what caches hold included; all there are, or no limit, where that is not said."""
    try:
        lines = Path("/proc/meminfo").read_text().splitlines()
        return next(1024.0 * int(line.split()[1]) for line in lines if line.startswith("MemAvailable"))
    except (OSError, StopIteration):
        pass
    try:
        return float(os.sysconf("SC_PHYS_PAGES")) * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, OSError, ValueError):
        return np.inf


#: Hessians that take more seconds than this are asked for.
LONGEST = 3600.0


def seconds_of(force: Force, positions: Doubles) -> float:
    """How long a force takes, the second time."""
    force(positions)
    begin = perf_counter()
    force(positions)
    return perf_counter() - begin


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
        is a small part, plus the antisymmetric part. Of a force that is no gradient the whole, whose asymmetry is no
        error.
    """
    matrix, correction, asymmetry = _measured(force, positions, masses, difference, columns, progress, symmetric)
    if rounding:
        # Noise is as large in the symmetric part, but for chance; on the diagonal it is unseen: a force's own rounding.
        pull = float(np.abs(force(positions)).max())
        asymmetry = _CHANCE * asymmetry + 2 * rounding * pull / (difference * float(masses.min()))
    return matrix, correction + asymmetry


#: With this the error was at most 0.8 of its estimate in 832 Hessians of 2 to 27 waters in single precision.
_CHANCE = 4.0


def _measured(
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

    def of(column: int) -> Doubles:
        return np.array([_difference(force, positions, column, width)[kept] for width in (difference, 2 * difference)])

    journal = journal_of(force)
    for place, column in enumerate(kept):
        if journal is None:
            near, far = of(column)
        else:
            near, far = journal.kept(partial(of, column), "column", positions, kept, float(column), difference)
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
    root, own = held.root[kept], held.back(positions, columns)
    bend = np.empty((0, 0))
    descent, best, hessians, is_far = _descent(bend), (np.inf, own, force, np.inf), 0, True
    vain = 0
    for _ in range(_ROUNDS):
        begun, here, smallest, size, idle = own, smooth(force, own, reach), np.inf, np.inf, 0
        while hessians < _HESSIANS:
            frame = free(held, own, columns, is_boxed)
            pulled = frame.T @ (here(own).ravel()[kept] / root)
            size = float(np.linalg.norm(pulled))
            # Rounding ends the fall of the force: two steps without a tenth less are the end.
            idle = idle + 1 if not size < 0.9 * smallest else 0
            if idle == 2 or np.abs(own - begun).max() > reach / 8:
                break
            is_new = is_far or (size > 0.1 * smallest and size > _rounding(bend, held.masses))
            smallest, is_far = min(smallest, size), False
            if is_new:
                bend, _ = hessian(here, own, held.masses, difference, columns, progress)
                bend, hessians = bend + held.curvature(here(own), own, columns), hessians + 1
            if is_new or held.distances:
                descent = _descent(frame.T @ bend @ frame)
            along = frame @ descent(pulled)
            own = _moved(here, held, own, kept, along, reach / 7)
            if max(np.abs(along / root).max(initial=0.0), np.abs(own - positions).max()) > far:
                raise KickdriftError("positions", f"moved by {far:g}", "are not near a minimum: minimize them first")
        is_far = bool(np.abs(own - begun).max() > reach / 8)
        if is_far:
            continue
        left = float(np.linalg.norm(frame.T @ (force(own).ravel()[kept] / root)))
        vain = 0 if left < 0.9 * best[0] else vain + 1
        if left < best[0]:
            best = (left, own, here, min(smallest, left))
        if here is force or left < _rounding(bend, held.masses) or hessians >= _HESSIANS or vain == _VAIN:
            break
    if best[0] < np.inf:
        _, own, here, size = best
    bend, _ = hessian(here, own, held.masses, difference, columns, progress)
    frame = free(held, own, columns, is_boxed)
    arrived(size, frame.T @ (bend + held.curvature(here(own), own, columns)) @ frame, held.masses)
    return own, here


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


def _moved(force: Force, held: Held, own: Doubles, kept: npt.NDArray[np.intp], along: Doubles, most: float) -> Doubles:
    """Positions after a step, as much of it as moves no coordinate by more than ``most`` and leaves less than half of
    what pulls along it pulling back."""
    root = held.root[kept]
    part = min(1.0, most / max(float(np.abs(along / root).max(initial=0.0)), 1e-300))
    columns = None if len(kept) == own.size else list(kept)
    least = -0.5 * float(along @ (force(own).ravel()[kept] / root))
    while True:
        moved = own.copy()
        moved.flat[kept] += part * along / root
        moved = held.back(moved, columns)
        if part < _SMALLEST_PART or float(along @ (force(moved).ravel()[kept] / root)) > least:
            return moved
        part /= 2


def cooled(force: Force, where: Doubles, held: Held, difference: float) -> Doubles:
    """Positions nearer to a minimum, by dynamics that lose what leads uphill (FIRE, Bitzek and others 2006).

    It asks for forces alone, where energies that jump at a cutoff stop a minimizer that compares them. Far from a
    minimum a step of Newton's method costs as much as a thousand of these, and is kept as short. It ends where its
    steps get short, at a jump of the forces, or after ``_COOLED`` of them.
    """
    from kickdrift import _bands

    product = _bands.by_differences(force, where, held.root, difference)
    longest = 1.0 / float(np.sqrt(max(_bands.top(product, where.size, _ROUGH).found, 1e-300)))
    # The numbers are those of the paper.
    step, share, uphill, speed = longest, 0.1, 0, np.zeros(where.size)
    best = (np.inf, where)
    for _ in range(_COOLED):
        pull = force(where).ravel() / held.root
        pull -= held.gradients(where).T @ held.along(pull, where)
        size = float(np.linalg.norm(pull))
        best = min(best, (size, where), key=lambda own: own[0])
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
    if not pull < _rounding(stiffness, masses):
        raise KickdriftError("positions", f"force {pull:.1e}", "are not near a minimum: minimize them first")
    values = np.linalg.eigvalsh(stiffness)
    if values.size and values[0] < -_SOFT * np.abs(values).max():
        remedy = "are near a saddle, from which something falls: minimize them first"
        raise KickdriftError("positions", f"stiffness {values[0]:.1e}", remedy)


#: Directions softer than this part of the stiffest are rigid motions: they are left where they are.
_SOFT = 1e-7


def _rounding(stiffness: Doubles, masses: Doubles) -> float:
    """The mass-weighted pull that a displacement of 1e-9 brings about at most."""
    return 1e-9 * norm(stiffness) * float(np.sqrt(masses.max()))


def _firm(matrix: Doubles) -> Doubles:
    """The eigenvectors of a symmetric matrix but for the soft ones, which are rigid motions."""
    values, vectors = np.linalg.eigh(matrix)
    return np.asarray(vectors[:, np.abs(values) > _SOFT * np.abs(values).max()])


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


def unbalanced(forces: Mapping[str, Doubles], size: float, masses: Doubles, unit: str, follow: str) -> list[str]:
    """What to know where a group's own force does not vanish at the positions: they are no rest of the integrator.

    ``size`` is the norm of the total Hessian. A force is rounding where it would displace no atom by more than 1e-9, as
    :func:`arrived` has it.
    """
    rounding = 1e-9 * size * float(np.sqrt(masses.max()))
    root = np.sqrt(masses)[:, None]
    notes = []
    if np.linalg.norm(np.sum(list(forces.values()), axis=0) / root) > rounding:
        notes.append("the positions are no minimum of all forces together: nothing stays about them")
    pulled = {name: own for name, own in forces.items() if np.linalg.norm(own / root) > rounding}
    if pulled and len(forces) > 1:
        most = max(float(np.linalg.norm(own, axis=1).max()) for own in pulled.values())
        notes.append(
            f"the forces of {' and of '.join(pulled)} do not vanish at the positions (up to {most:.3g} {unit}): a run "
            f"{_SWINGS} of its own, where the Hessians are others; verdicts hold for those at the positions "
            f"alone. {follow}"
        )
    return notes


@dataclass(frozen=True)
class Kick:
    """One strike of the clocks: its time, and how long each group acts; at the ends of a period half as long."""

    time: Fraction
    groups: tuple[tuple[int, Fraction], ...]


def schedule(steps: Sequence[Fraction]) -> tuple[Kick, ...]:
    """The kicks of the first half of a period, halved at both its ends."""
    period = _common(steps)
    half = period / 2
    times = sorted({step * k for step in steps for k in range(int(half / step) + 1)} | {Fraction(0), half})
    kicks = []
    for time in times:
        weight = Fraction(1, 2) if time in (0, half) else Fraction(1)
        groups = tuple((k, weight * step) for k, step in enumerate(steps) if (time / step).denominator == 1)
        kicks.append(Kick(time, groups))
    return tuple(kicks)


def _common(steps: Sequence[Fraction]) -> Fraction:
    common = steps[0]
    for step in steps[1:]:
        ratio = common / step
        common *= ratio.denominator
    return common


@dataclass(frozen=True, eq=False)
class Monodromy(Frozen):
    """What small deviations from a state do over one period of the clocks: measured in doubles, and what is proven.

    About an orbit :attr:`verdict` is proven for all Hessians within the accuracy of those measured.
    Rates, multipliers and doubts are estimates, :attr:`growth_bounds` proven.

    Attributes
    ----------
    about : str
        ``orbit``: the integrator's own periodic orbit; ``minimum``: the minimum of the total energy, which is no fixed
        point of the integrator where the groups' own forces do not vanish there.
    positions : array, shape (n, 3)
        The state in the middle of a kick of every clock, at rest.
    away : float
        The largest distance of an atom from the minimum.
    period : Fraction
        The period of the clocks.
    half : array, shape (2n', 2n')
        The propagator of mass-weighted deviations (x, v) over half a period, n' = 3n less what is held, in orthonormal
        frames of what is free at both its ends.
    residual : float
        The step that Newton's method would take next, relative to the extent of the atoms; 0 about a minimum.
    mu : array, shape (n',)
        Of the half period: lambda + 1/lambda = 2 + 4 mu for the multipliers lambda of the period.
    doubts : array, shape (n',)
        How far each mu may be off, to first order in the errors of the Hessians: what the differences leave, and what
        the residual moves.
    along : System or None
        The Hessians at the kicks of half a period along an orbit, with their ``accuracy``: ten times what the
        differences are seen to leave and what Newton's next step would change, relative to the largest norm of each
        step's.
    unproven : str
        Why there are none; empty where there are.
    time_unit : str
        That of the period and of rates, where it is known.
    drift : float
        Along an orbit, how far motions that are softer than 1e-7 of the stiffest go in a period, relative to the extent
        of the atoms: along these it is not closed.
    """

    about: str
    positions: Doubles
    away: float
    period: Fraction
    half: Doubles
    residual: float
    mu: npt.NDArray[np.complex128]
    doubts: Doubles
    along: System | None = None
    unproven: str = ""
    time_unit: str = ""
    drift: float = 0.0

    @cached_property
    def _decided(self) -> tuple[SystemVerdict | None, str]:
        """The verdict, or why there is none."""
        if self.along is None:
            return None, self.unproven
        try:
            return self.along.decide(), ""
        except KickdriftError as error:
            return None, str(error)

    @property
    def verdict(self) -> SystemVerdict | None:
        """What the library says of the Hessians :attr:`along` the orbit; None where it says nothing."""
        return self._decided[0]

    @property
    def proven(self) -> bool:
        """Whether it is proven stable, or unstable, for all Hessians within the accuracy of those measured."""
        return self._holds is not None

    @property
    def _holds(self) -> bool | None:
        measured = None if self.verdict is None else self.verdict.measured
        return None if measured is None else {"stable": True, "unstable": False}.get(measured["holds"])

    @property
    def growth_bounds(self) -> tuple[float, float] | None:
        """Doubles that enclose the largest growth rate for all Hessians within the accuracy; None where it is not
        proven."""
        return self.verdict.growth_bounds if self.verdict is not None and self.proven else None

    @property
    def words(self) -> str:
        """What holds in a few words: proven or an estimate, and why no more is known."""
        does = (
            "nothing grows" if self.stable else f"deviations grow at {self.growth_rate:.3g}/{self.time_unit or 'time'}"
        )
        if self.drift > _CLOSED:
            does += f", softest motions apart, which drift by {self.drift:.0e} of the extent in a period"
        if self.proven and self.along is not None:
            bounds = self.growth_bounds
            is_enclosed = bounds is not None and bounds[1] - bounds[0] <= _SHARP * bounds[1]
            rate = "" if self.stable or is_enclosed else ", the rate an estimate"
            return f"{does} (proven for all Hessians within {self.along.accuracy:.0e} of those measured{rate})"
        decided, why = self._decided
        if decided is not None and decided.measured is not None:
            margin = decided.measured["margin"]
            known = "nothing is proven" if margin is None else f"proven only within {margin:.0e} of the Hessians' norms"
            accuracy = decided.measured["accuracy"]
            why = f"{known}, they are known to {accuracy:.0e}"
        return f"{does} (an estimate in doubles{f': {why}' if why else ''})"

    @cached_property
    def matrix(self) -> Doubles:
        """The propagator of mass-weighted deviations (x, v) over a period, shape (2n', 2n'): half of it, and the same
        backwards."""
        n = len(self.half) // 2
        a, b, c, d = self.half[:n, :n], self.half[:n, n:], self.half[n:, :n], self.half[n:, n:]
        back = np.block([[d.T, b.T], [c.T, a.T]])
        return frozen(np.asarray(back @ self.half))

    @cached_property
    def multipliers(self) -> npt.NDArray[np.complex128]:
        """The eigenvalues of the period, shape (2n',), from those of half of it: lambda + 1/lambda = 2 + 4 mu."""
        return frozen(_multipliers(self.mu))

    @property
    def growth_rate(self) -> float:
        """The largest growth rate, 1/time, of multipliers that are off the unit circle by more than their doubt: the
        numbers mu of bounded ones lie between -1 and 0. An estimate: 0 where it is proven that nothing grows."""
        if self._holds is True:
            return 0.0
        apart = np.abs(self.mu - np.clip(self.mu.real, -1.0, 0.0))
        grown = np.abs(_multipliers(self.mu[apart > self.doubts]))
        return float(np.log(grown.max())) / float(self.period) if grown.size else 0.0

    @property
    def stable(self) -> bool:
        """Whether no deviation grows: proven where :attr:`proven` says so, else whether none is seen to."""
        return self.growth_rate == 0.0 if self._holds is None else self._holds

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the multipliers in the complex plane."""
        return _plot.multipliers(self.multipliers, ax)

    def __repr__(self) -> str:
        words = "stable" if self.stable else f"growth rate {self.growth_rate:.4g}"
        known = "an estimate"
        if self.proven:
            known = "proven" if self.stable else "proven unstable"
        return f"Monodromy(about the {self.about}: {words}, {known})"


#: What a run does where the groups' forces do not vanish, in a note.
_SWINGS = "swings about an orbit"

#: A rate of which so small a part is open is known to the digits that are shown.
_SHARP = 0.01

#: Orbits are followed unasked where there are so many degrees of freedom, and where it takes so many seconds at most.
FOLLOWED, _UNASKED = 300, 20.0


@dataclass(frozen=True, eq=False, repr=False)
class Followed(Frozen):
    """The integrator's own orbit beside a minimum, found when it is asked for; a copy in another process has none.

    Attributes
    ----------
    find : callable or None
        Returns the monodromy about it.
    step : str
        The outer step, with its unit.
    length : str
        The unit of length.
    """

    find: Callable[[], Monodromy] | None
    step: str
    length: str

    @staticmethod
    def beside(
        work: Work, notes: Sequence[str], find: Callable[[], Monodromy], step: str, length: str
    ) -> Followed | None:
        """That of a system with these notes, where its orbit is another state than the minimum and found soon."""
        swings = any(_SWINGS in note for note in notes)
        soon = work.columns <= FOLLOWED and work.seconds <= _UNASKED
        return Followed(find, step, length) if swings and soon else None

    def __getstate__(self) -> dict[str, Any]:
        return {"find": None, "step": self.step, "length": self.length}

    @cached_property
    def _asked(self) -> tuple[Monodromy | None, str]:
        """The monodromy, or why there is none."""
        try:
            return (None, "") if self.find is None else (self.find(), "")
        except KickdriftError as error:
            return None, str(error)

    @property
    def found(self) -> Monodromy | None:
        """The monodromy about the orbit; None where it is not found."""
        return self._asked[0]

    @property
    def sentence(self) -> str:
        """What small deviations do about the orbit, which is what a run shows first: a line, or nothing."""
        found, why = self._asked
        begin = f"own orbit: at {self.step} a run swings about an orbit beside the minimum"
        if found is None:
            return f"{begin} that is not found: {why}\n" if why else ""
        return f"{begin}, {found.away:.2g} {self.length} away at most; about it {found.words}. Below: the minimum\n"

    def unsaid(self, notes: Sequence[str]) -> tuple[str, ...]:
        """These notes, but for the one that sends to the orbit, where the sentence has it."""
        return tuple(note for note in notes if self.found is None or _SWINGS not in note)


def _multipliers(mu: npt.NDArray[np.complex128]) -> npt.NDArray[np.complex128]:
    trace, root = 2 + 4 * mu, np.sqrt(mu * (mu + 1)) * 4
    return np.concatenate([(trace + root) / 2, (trace - root) / 2])


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


def _eigenvalues(
    half: Doubles, struck: Sequence[Struck], residual: float
) -> tuple[npt.NDArray[np.complex128], Doubles]:
    """The eigenvalues mu of B^T C, and how far each is off, to first order, where each kick's Hessian is by its error.

    A kick changed by dK changes the half period by S (0, -h dK X), X the rows at the kick and S what comes after it,
    which a symplectic matrix's own entries tell: from velocities S = half (-B_k^T, A_k^T). Of mu with the eigenvectors
    y and x the change is y* (dB^T C + B^T dC) x over y* x.
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
                known[group] = _measured(forces[group], position, held.masses, difference)
            stiffness, correction, asymmetry = known[group]
            own = norm(stiffness)
            # Of smooth forces the fourth order leaves of the second order's error what that is of the whole.
            error = correction**2 / max(own, 1e-300) + asymmetry
            made = (group, position, stiffness)
            struck.append(Struck(float(duration), allowed.T @ at, error, own, *made))
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


def _swing(forces: Sequence[Force], steps: Sequence[Fraction], start: Doubles, held: Held) -> Doubles:
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


def _damped(size_at: Callable[[float], float], size: float, tries: int) -> float | None:
    """The largest part of a Newton step, 1, 1/2, ..., that makes the size smaller by a tenth; rounding ends that."""
    return next((part for part in (0.5**k for k in range(tries)) if size_at(part) < 0.9 * size), None)


#: Newton's method has arrived where its next step is this part of the extent of the atoms.
_ARRIVED = 1e-9

#: A step that is no longer is not made: along the orbit Hessians change by it less than differences of doubles see.
_CLOSE_BY = 1e-12

#: What is too soft for Newton's method may go so far in a period, relative to the extent: of clusters in which a water
#: is loosely bound, verdicts and rates were those of OpenMM's own map up to here; less than the other needs no word.
_DRIFTS, _CLOSED = 1e-8, 1e-11

#: Where no such part of a way can be made, it is given up.
_SMALLEST_PART = 1 / 100


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
        own = [each for force in self.forces if (each := journal_of(force)) is not None]
        if not own or len(own) < len(self.forces):
            return None
        return replace(own[0], names=("sum", np.asarray(self.less), *(name for each in own for name in each.names)))

    def smooth(self, positions: Doubles, reach: float) -> Force:
        """Where one of them jumps, so does the sum: each as it is about these positions."""
        return _Sum([smooth(force, positions, reach) for force in self.forces], self.less)


@dataclass(frozen=True, eq=False)
class _Family:
    """Orbits by a share, which at 1 are the one that is sought: the forces and steps at each, and what Newton's method
    moves along, the columns of ``firm``."""

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
        return np.asarray(firm.T @ _swing(*family.made(share), place, held))

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
            drift = float(np.abs(left).max()) * float(_common(family.made(share)[1])) / extent
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
    own = list(forces.values())
    period = _common(steps)
    if about == "minimum":
        half = compose(own, steps, at, held, difference, still=True, progress=progress)
        values = _eigenvalues(half.matrix, half.struck, 0.0)
        why = "about the minimum a system of its Hessians is proven"
        return Monodromy(about, frozen(at.copy()), 0.0, period, frozen(half.matrix), 0.0, *values, None, why, time_unit)
    if about != "orbit":
        raise KickdriftError("about", about, "choose orbit or minimum")
    free = held.frame(at)
    balances = [((free @ (free.T @ (force(at).ravel() / held.root))) * held.root).reshape(at.shape) for force in own]
    every = _Sum(own)
    total, error = hessian(every, at, held.masses, difference)
    stiffness = total + held.curvature(every(at), at)
    firm = free @ _firm(free.T @ stiffness @ free)

    def lent(share: float) -> tuple[Sequence[Force], Sequence[Fraction]]:
        pairs = zip(own, balances, strict=True)
        return [_Sum([force], (1 - share) * balance) for force, balance in pairs], steps

    def shorter(share: float) -> tuple[Sequence[Force], Sequence[Fraction]]:
        return own, [Fraction(share) * step for step in steps]

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
    if found.drift > _DRIFTS:
        remedy = (
            f"does not close: its softest motions drift by {found.drift:.0e} of the extent in a period, as bends of "
            "a chain of bonds alone, or a molecule that is loosely bound; give these a force, or about='minimum'"
        )
        raise KickdriftError("about", "orbit", remedy)
    half = found.half
    away = float(np.linalg.norm(start - at, axis=1).max())
    values = _eigenvalues(half.matrix, half.struck, found.residual)
    measured = (about, frozen(start.copy()), away, period, frozen(half.matrix), found.residual, *values)
    moved = rigid_motions(start, held.masses, rotations=False)
    keep = has_field or (not has_mesh and is_held(total, moved, error))
    sides: dict[str, Any] = {"positions": start, "turned": half.struck[-1].positions, "periodic": is_boxed}
    masses, root, struck = held.masses, held.root, half.struck
    ahead = found.residual * (float(np.ptp(start, axis=0).max()) or 1.0)
    try:
        if held.distances:
            struck, frames = plain(half, steps, held, ahead)
            motions = [rigid_motions(sides[end], masses, rotations=not is_boxed) for end in ("positions", "turned")]
            rigid = [np.linalg.lstsq(own, motion, rcond=None)[0] for own, motion in zip(frames, motions, strict=True)]
            sides = {} if keep else {"rigid": np.array(rigid)}
            masses = root = np.ones(half.first.shape[1])
        potentials, accuracy = along(struck, dict(zip(forces, steps, strict=True)), root, ahead)
    except KickdriftError as refused:
        return Monodromy(*measured, None, str(refused), time_unit, found.drift)
    made = System.along_orbit(masses, potentials, accuracy=accuracy, time_unit=time_unit, keep_rigid=keep, **sides)
    return Monodromy(*measured, made, "", time_unit, found.drift)


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
    if any(fastest not in [strike.group for strike in own] for own in made):
        raise KickdriftError("steps", "no multiples of the fastest", "choose such, for a proof along held bonds")
    frames = [held.frame(own[0].positions) for own in made]
    for k in reversed(range(len(frames) - 1)):
        frames[k] = frames[k] @ np.linalg.inv(frames[k + 1].T @ frames[k])
    struck, nearest = [], min(distance for _, _, distance in held.distances)
    for place, (frame, own) in enumerate(zip(frames, made, strict=True)):
        apart = np.eye(frame.shape[1]) - frame.T @ frame
        times = [half.drifts[k][0] for k in (place - 1, place) if 0 <= k < len(half.drifts)]
        shape = np.asarray(sum(apart / time for time in times))
        if place < len(half.drifts):
            time, factors = half.drifts[place]
            shape = shape - frame.T @ held.bent(factors) @ frame / time
        else:
            # Where it turns, the velocity does not vanish along the gradients, which deviations turn.
            shape = shape + frame.T @ held.bent(half.taken) @ frame
        for strike in own:
            added: Doubles | float = 0.0
            stiffness, error = frame.T @ strike.stiffness @ frame, strike.error * norm(frame) ** 2
            if strike.group == fastest:
                pulls = sum(other.duration * other.size for other in own)
                off = _SHAPED * sum(1 / time for time in times) + (norm(shape) + pulls) * ahead / nearest
                added, error = (shape + shape.T) / 2 / strike.duration, error + off / strike.duration
            struck.append(replace(strike, stiffness=stiffness, error=error, shape=added))
    return struck, (frames[0], frames[-1])


#: Frames and factors are rounded by this part of 1: some digits are lost where positions are large over what is held.
_SHAPED = 1e-13


#: What is proven is so for Hessians ten times farther from those measured than these are seen to be off. Of a power law
#: x^-n differences of fourth order leave 1.2 (n + 4) (n + 5)/(n + 2)/(n + 3) of what is seen: 3 of Coulomb's, less of
#: others; and rounding leaves of the symmetric part some times more or less than of the other, which is seen.
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
        own = [[kick for kick in struck if kick.group == place] for place in groups]
        matrices = [np.sum([kick.stiffness for kick in kicks], axis=0) for kicks in zip(*own, strict=True)]
        errors = [sum(kick.error for kick in kicks) for kicks in zip(*own, strict=True)]
        added = [sum(kick.shape for kick in kicks) for kicks in zip(*own, strict=True)]
        whole = [matrix + shape for matrix, shape in zip(matrices, added, strict=True)]
        size = max(1e-300, *(norm(matrix) for matrix in whole))
        where = [kick.positions for kick in own[0]]
        changes = 0.0
        for k in range(len(where) - 1):
            way = float(np.abs(where[k + 1] - where[k]).max())
            if way > ahead:
                changes = max(changes, norm(matrices[k + 1] - matrices[k]) / way)
        worst = max(worst, _FARTHER * (max(errors) + changes * ahead) / size)
        name = ", ".join(kinds[place] for place in groups)
        potentials[name] = (step, np.array(whole) * np.outer(root, root))
    return potentials, usable(worst, "a kick along the orbit", "the one that was taken", SMOOTHER)


#: A fold is known to this part of the steps asked about: it is shown with five digits, of which four are meant.
_ENDS = 1 / 4096

#: So many orbits are looked for along a family at most.
_MANY = 40

#: Those on the way to the one that is sought are known to this part of the extent, a thousandth of what they move.
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
    found = next((own for own in first if own.residual <= _ARRIVED), None)
    if found is None or found.share == 1:
        return found, float(found is not None), np.inf
    known = [np.append(0.0, at), np.append(found.share, found.positions)]
    stretch, is_refused = 1.0, False
    for _ in range(_MANY):
        last = known[-1]
        if last[0] < known[-2][0] or abs(stretch) < _SMALLEST_PART:
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
        own = last if found is None else np.append(found.share, found.positions)
        off = size(own - there, weight) / size(there - last, weight)
        if found is None or off > 1:
            stretch, is_refused = ahead / length if is_last else ahead / length / 3, is_refused or is_last
        elif is_last:
            return found, 1.0, np.inf
        else:
            known.append(own)
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
    return None, max(float(own[0]) for own in known), fold
