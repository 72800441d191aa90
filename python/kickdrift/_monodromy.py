"""What small deviations do over a period about an orbit or a minimum, as answers."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from kickdrift import _plot
from kickdrift._cost import Work
from kickdrift._document import Frozen
from kickdrift._enclosure import Enclosure
from kickdrift._errors import KickdriftError
from kickdrift._numbers import frozen
from kickdrift._rigid import Doubles
from kickdrift._system import System, SystemVerdict

if TYPE_CHECKING:
    from matplotlib.axes import Axes


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
    pulled = {name: pull for name, pull in forces.items() if np.linalg.norm(pull / root) > rounding}
    if pulled and len(forces) > 1:
        most = max(float(np.linalg.norm(pull, axis=1).max()) for pull in pulled.values())
        notes.append(
            f"the forces of {' and of '.join(pulled)} do not vanish at the positions (up to {most:.3g} {unit}): a run "
            f"{SWINGS} of its own, where the Hessians are others; verdicts hold for those at the positions "
            f"alone. {follow}"
        )
    return notes


@dataclass(frozen=True, eq=False)
class Monodromy(Frozen):
    """Small deviations from a state over one period of the clocks: measured in doubles, with a proven verdict.

    About an orbit :attr:`verdict` is proven for all Hessians within the accuracy of the measured ones.
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
        The propagator of mass-weighted deviations (x, v) over half a period, n' = 3n less the held ones, in orthonormal
        frames of the free motions at both ends.
    residual : float
        The step that Newton's method would take next, relative to the extent of the atoms; 0 about a minimum.
    mu : array, shape (n',)
        The eigenvalues of the half period: lambda + 1/lambda = 2 + 4 mu for the multipliers lambda of the period.
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
    def growth_bounds(self) -> Enclosure | None:
        """Doubles that enclose the largest growth rate for all Hessians within the accuracy; None where it is not
        proven."""
        return self.verdict.growth_bounds if self.verdict is not None and self.proven else None

    @property
    def words(self) -> str:
        """What holds in a few words: proven or an estimate, and why no more is known."""
        does = (
            "nothing grows" if self.stable else f"deviations grow at {self.growth_rate:.3g}/{self.time_unit or 'time'}"
        )
        if self.drift > CLOSED:
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
SWINGS = "swings about an orbit"

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
        swings = any(SWINGS in note for note in notes)
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
        """These notes without that which sends to the orbit, if the sentence tells of it."""
        return tuple(note for note in notes if self.found is None or SWINGS not in note)


def _multipliers(mu: npt.NDArray[np.complex128]) -> npt.NDArray[np.complex128]:
    trace, root = 2 + 4 * mu, np.sqrt(mu * (mu + 1)) * 4
    return np.concatenate([(trace + root) / 2, (trace - root) / 2])


#: What is too soft for Newton's method may go so far in a period, relative to the extent: of clusters in which a water
#: is loosely bound, verdicts and rates were those of OpenMM's own map up to here; less than the other needs no word.
DRIFTS, CLOSED = 1e-8, 1e-11
