"""Systems: many clocks, many degrees of freedom, and the questions about them."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from kickdrift._advice import Engine, SystemAdvice, Time
from kickdrift._document import question
from kickdrift._enclosure import Enclosure
from kickdrift._errors import KickdriftError, shown
from kickdrift._intervals import Intervals
from kickdrift._numbers import Exact, Range, Spaced, mapping_of, range_text, spaced_text, text, written
from kickdrift._periods import asked
from kickdrift._scan import AXES, Scan
from kickdrift._system_hessians import HessianSystem
from kickdrift._system_verdict import DecidedSystem


class Oscillation(Protocol):
    """What small deviations do about the integrator's own orbit: a ``Monodromy``, which tells more."""

    @property
    def positions(self) -> npt.NDArray[np.float64]:
        """Where the orbit is at rest, shape (n, 3)."""

    @property
    def away(self) -> float:
        """The largest distance of an atom from the minimum."""

    @property
    def stable(self) -> bool:
        """Whether no deviation grows."""

    @property
    def proven(self) -> bool:
        """Whether that is proven for all Hessians within the accuracy of those measured."""

    @property
    def growth_rate(self) -> float:
        """The largest growth rate, 1/time: an estimate."""

    @property
    def growth_bounds(self) -> Enclosure | None:
        """Doubles that enclose it for all these Hessians, where it is proven."""

    @property
    def multipliers(self) -> npt.NDArray[np.complex128]:
        """The multipliers of the period."""

    @property
    def along(self) -> System | None:
        """The Hessians at the kicks of half a period."""

    @property
    def verdict(self) -> SystemVerdict | None:
        """The verdict on these."""

    @property
    def words(self) -> str:
        """All this in a few words."""


class Orbit(Protocol):
    """The integrator's own orbit beside the minimum, which is looked for when it is asked for."""

    @property
    def found(self) -> Oscillation | None:
        """What small deviations do about it; None where it is not found."""

    @property
    def sentence(self) -> str:
        """The same as a line of text, or nothing."""

    def unsaid(self, notes: Sequence[str]) -> Sequence[str]:
        """These notes, but for those that the sentence makes superfluous."""


@dataclass(frozen=True, eq=False, repr=False)
class System(HessianSystem):
    """Masses and potentials, each with a clock of its own: M x'' + sum of K_k x = 0.

    Parameters
    ----------
    document : mapping
        As in a system file, without ``schema``: ``masses``, ``potentials`` and so on; numbers are exact, a float means
        what it prints, also in arrays of NumPy's. Measured Hessians stand by reference, ``{"npz": "arrays.npz",
        "array": NAME}``; :meth:`System.from_hessians` does it.
    arrays : mapping of str to array, optional
        The arrays referred to; read-only copies are kept.
    notes : sequence of str, optional
        What was left out or estimated while the system was made.

    Examples
    --------
    Two masses, a stiff bond between them and a soft tether to a wall:

    >>> import kickdrift as kd
    >>> system = kd.System({"masses": [1, 1], "potentials": [
    ...     {"step": "1/10", "springs": [[0, 1, 10]]}, {"step": "1/2", "springs": [[0, None, "1/2"]]}]})
    >>> system.decide().stable
    True
    """

    _orbit: Orbit | None = None

    def decide(
        self,
        *,
        exact: bool = False,
        accuracy: float | None = None,
        keep_rigid: bool = False,
        friction: Exact | None = None,
        method: str | None = None,
        budget: int | None = None,
    ) -> SystemVerdict:
        """Decide whether the system is stable, and find the growing modes.

        Parameters
        ----------
        exact : bool
            Exact arithmetic alone.
        accuracy : float, optional
            How well measured Hessians are known, in place of the system's own number.
        keep_rigid : bool
            Leave the rigid motions of measured Hessians in.
        friction : Exact, optional
            A rate G, 1/time, rational: v times exp(-G t) in the middle of every drift (BAOAB). The verdict stays that
            without friction; ``SystemVerdict.friction`` tells what friction does.
        method : str, optional
            The integrator of two dense Hessians, in place of the system's own: ``"respa"``, ``"implicit-explicit"``,
            ``"impulse"``, ``"molly-short"``, ``"molly-linear"``, ``"molly-long"``, ``"gautschi"``, ``"hairer-lubich"``.
            All but the first take the force of the shorter step in one go over the longer one.
        budget : int, optional
            The most products of machine words.

        Raises
        ------
        KickdriftError, BudgetError
            A system that makes no sense; more work than the budget allows.

        Examples
        --------
        >>> import kickdrift as kd
        >>> system = kd.System.from_hessians([1.0], {"stiff": ("1/40", [[400.0]]), "soft": ("1/10", [[1.0]])})
        >>> system.decide().stable, system.decide(method="implicit-explicit").stable
        (True, True)
        """
        damped = None if friction is None else text("friction", friction)
        asked = question(
            "system",
            budget,
            exact=exact,
            keep_rigid=keep_rigid,
            friction=damped,
            accuracy=accuracy,
            method=method,
        )
        asked = self._about(asked)
        return SystemVerdict(asked.render("json"), asked, self)

    def nearest(
        self,
        *,
        resolution: float = 1e-4,
        accuracy: float | None = None,
        method: str | None = None,
        budget: int | None = None,
    ) -> SystemVerdict:
        """The verdict, and the unstable intervals of the outer step next to the system's own, at its ratios of steps.

        Parameters
        ----------
        resolution : float
            The relative width above which no interval is missed.
        accuracy, method, budget
            As for :meth:`decide`.

        Returns
        -------
        SystemVerdict
            Its :attr:`SystemVerdict.nearest_unstable` has them, from half the step to twice the step at most.

        Raises
        ------
        KickdriftError, BudgetError
            As :meth:`decide`.

        Examples
        --------
        >>> import kickdrift as kd
        >>> system = kd.System.from_hessians([1.0], {"stiff": ("1/40", [[400.0]]), "soft": ("1/10", [[1.0]])})
        >>> found = system.nearest().nearest_unstable
        >>> found["own"], found["below"], [round(found["above"][end], 4) for end in ("lo", "hi")]
        (None, None, [0.1527, 0.1531])
        """
        asked = question("system", budget, nearest=True, width=resolution, accuracy=accuracy, method=method)
        asked = self._about(asked)
        return SystemVerdict(asked.render("json"), asked, self)

    def intervals(
        self,
        outer: Range,
        *,
        path: str = "outer",
        resolution: float = 1e-4,
        accuracy: float | None = None,
        method: str | None = None,
        budget: int | None = None,
    ) -> Intervals:
        """All stable and unstable intervals of the outer step, at the ratios of steps that there are; or of another
        number of the system.

        For measured Hessians a stretch is proven for all within their accuracy. ``the data do not tell`` if these share
        no verdict, or nothing is proven.

        Parameters
        ----------
        outer : Range
            The closed range of outer steps, or of the number at ``path``, rational.
        path : str
            Which number varies, as a system file has it: ``"masses.0"``, ``"potentials.soft.scale"``.
        resolution : float
            The relative width above which no interval is missed.
        accuracy : float, optional
            How well the Hessians are known.
        method : str, optional
            The integrator of two dense Hessians, as for ``decide``.
        budget : int, optional
            The most products of machine words.

        Raises
        ------
        BudgetError
            More work than the budget allows, before it begins.

        Examples
        --------
        >>> import kickdrift as kd
        >>> system = kd.System.from_hessians([1.0], {"stiff": ("1/40", [[400.0]]), "soft": ("1/10", [[1.0]])})
        >>> [row["verdict"] for row in system.intervals(("1/20", "1/10"))]
        ['stable']
        >>> len(system.intervals(("1/2", 4), path="potentials.soft.scale"))
        1
        """
        over = f"{written('path', path)}={range_text('outer', outer)}"
        asked = question("system", budget, intervals=over, width=resolution, accuracy=accuracy, method=method)
        asked = self._about(asked)
        return Intervals(asked.render("json"), "stretches", asked)

    def scan(
        self,
        over: str | Mapping[str, Spaced] | Sequence[tuple[str, Spaced]],
        *,
        exact: bool = False,
        accuracy: float | None = None,
        method: str | None = None,
        budget: int | None = None,
    ) -> Scan:
        """The verdict at each value of one number of the system, or of two.

        Parameters
        ----------
        over : mapping of str to (lo, hi, spacing), or str
            Which numbers vary, as a system file has them, and their values: ``{"outer": ("0.1", 2, "0.1")}`` keeps all
            steps in their ratios; ``{"potentials.soft.step": (1, 2, "1/10"), "masses.0": (1, 3, 1)}`` is a map.
            A text has one: ``"outer=0.1..2:0.1"``.
        exact, accuracy, method, budget
            As for :meth:`decide`.

        Raises
        ------
        KickdriftError, BudgetError
            A path that leads nowhere; more work than the budget allows, before it begins.

        Examples
        --------
        >>> import kickdrift as kd
        >>> system = kd.System({"masses": [1], "potentials": [{"name": "bond", "step": 1, "springs": [[0, None, 1]]}]})
        >>> found = system.scan({"potentials.bond.step": (1, 3, "1/2")})
        >>> [(row["x"], row["kind"]) for row in found][:3]
        [('1', 'elliptic'), ('3/2', 'elliptic'), ('2', 'parabolic')]
        """
        axes = [over] if isinstance(over, str) else list(mapping_of("over", over, _OVER).items())
        if not 1 <= len(axes) <= len(AXES):
            raise KickdriftError("over", shown(over), "give one number of the system or two, each with its values")
        texts = [axis if isinstance(axis, str) else spaced_text("over", [axis], _OVER) for axis in axes]
        varied = dict(zip(AXES, texts, strict=False))
        asked = question("system", budget, exact=exact, accuracy=accuracy, method=method, **varied)
        asked = self._about(asked)
        return Scan(asked.render("json"), "verdicts", asked)

    def advise(
        self,
        steps: str | Sequence[Any] = (),
        *,
        engine: Engine | None = None,
        band: Exact = "5%",
        length: Time | None = None,
        friction: Exact | None = None,
        constraints: str | None = None,
        hmr: Exact | None = None,
        levers: bool = True,
        harmonic: bool = False,
    ) -> SystemAdvice:
        """Say which steps are safe for these Hessians, with a unit of time, for how long, and why.

        There may be one level, two, or more. The first unstable step, a band of periods below which all steps are
        stable, and the verdict at each scheme are proven for all Hessians within their accuracy.

        Parameters
        ----------
        steps : sequence of Time, or a sequence of such, optional
            Schemes beside the system's own steps, which are the first: from the inner to the outer step, fs.
        engine : path or text, or a sequence of such, optional
            An input of a simulation engine, whose steps are the first scheme then.
        band : Exact or percentage
            How far every period may be off, relatively.
        length : Time, optional
            The length of the run, as ``"10ns"``.
        friction : Exact, optional
            A thermostat's, as ``"1/ps"``: does it mask the growth?
        constraints : str, optional
            ``"h-bonds"``: bonds with hydrogens held, beside those held already; for Hessians with ``forces``.
        hmr : Exact, optional
            Hydrogens of this mass in amu, taken from their heavy atoms.
        levers : bool
            Whether to say what would let the step grow.
        harmonic : bool
            The bonds are harmonic: nothing published bounds a clock's own step, which else stays below T/6.28.

        Raises
        ------
        KickdriftError
            Bad input; exact stiffnesses, no ``time_unit``; a scheme of another number of steps than there are levels.

        Examples
        --------
        >>> import numpy as np
        >>> import kickdrift as kd
        >>> fast, slow = np.diag([0.39, 0.41]), np.array([[0.02, 0.01], [0.01, 0.02]])
        >>> system = kd.System.from_hessians([1.0, 1.0], {"fast": ("1/2", fast), "slow": (4, slow)}, time_unit="fs")
        >>> system.advise(steps=[("0.5fs", "6fs")])
        SystemAdvice(4 fs caution, 6 fs island)
        """
        question = asked(
            self._fields(),
            steps,
            engine,
            (band, length, friction, constraints, hmr),
            place=self._place(),
            levers=levers,
            harmonic=harmonic,
        )
        warnings = self.decide().warnings
        # With other masses or held bonds the orbit is another one, which nobody has followed.
        followed = self if constraints is None and hmr is None else replace(self, _orbit=None)
        unsaid = _lines(followed._new_warnings(warnings))
        parted = (_parted(question.render(form)) for form in ("text", "details"))
        text, details = (followed._orbit_sentence() + sentences + unsaid + rest for sentences, rest in parted)
        return SystemAdvice(question.render("json"), text, details, warnings)

    def _orbit_sentence(self) -> str:
        """What is said first: the integrator's own orbit, where a run is about it and not about the minimum."""
        return "" if self._orbit is None else self._orbit.sentence

    def _new_warnings(self, notes: Sequence[str]) -> Sequence[str]:
        """The notes that the sentence about the orbit does not say already."""
        return notes if self._orbit is None else self._orbit.unsaid(notes)

    def __repr__(self) -> str:
        potentials = self.document.get("potentials", ())
        steps = ", ".join(f"{p.get('name', k)}: step {p['step']}" for k, p in enumerate(potentials))
        made = "built" if {"build", "mesh"} & set(self.document) else "no potentials"
        return f"System({self.document.get('title') or 'untitled'}; {steps or made})"


#: What :meth:`System.scan` varies.
_OVER = "give values by path, as {'outer': ('0.1', 2, '0.1')}, or a text as 'outer=0.1..2:0.1'"


def a_system(value: Any) -> System:
    """The argument ``system`` itself, where it is one.

    Raises
    ------
    KickdriftError
        Anything else.
    """
    if not isinstance(value, System):
        raise KickdriftError("system", shown(value), "give a System, as System.read('system.json') is")
    return value


def _parted(advice: str) -> tuple[str, str]:
    """The sentences that an advice begins with, and its table with all that follows."""
    sentences = _SENTENCES.match(advice)
    end = 0 if sentences is None else sentences.end()
    return advice[:end], advice[end:]


#: What is safe, what limits it, what would let it grow: a line each, behind its word.
_SENTENCES = re.compile(r"(?:(?:advice|limit|longer): .*\n)+")


def _lines(warnings: Sequence[str]) -> str:
    """Warnings as an answer's text has them."""
    return "".join(f"warning: {note}\n" for note in warnings)


@dataclass(frozen=True, eq=False, repr=False)
class SystemVerdict(DecidedSystem):
    """The verdict on a system, with its parts, the modes that grow, and of measured Hessians the margin.

    Examples
    --------
    >>> import kickdrift as kd
    >>> system = kd.System({"masses": [1], "potentials": [{"step": "1/10", "springs": [[0, None, "pi^2"]]},
    ...                                                  {"step": "0.98", "springs": [[0, None, "pi^2/25"]]}]})
    >>> verdict = system.decide()
    >>> verdict.stable, verdict.kind, verdict.proven
    (False, 'hyperbolic', True)
    """

    system: System

    @property
    def warnings(self) -> tuple[str, ...]:
        """The limits of the verdict, in words; parts left out when the system was made come first."""
        return (*self.system.notes, *self.data["warnings"])

    @property
    def orbit(self) -> Oscillation | None:
        """What small deviations do about the integrator's own orbit, where the groups' forces do not vanish at the
        minimum: that is what a run shows. None where they vanish, where the orbit is not found, or would not be soon.
        It is looked for when it is first asked for."""
        orbit = self.system._orbit
        return orbit.found if orbit is not None and self._is_respa else None

    def __repr__(self) -> str:
        if not self.proven:
            return f"SystemVerdict({self.kind})"
        rate = "" if self.growth_bounds is None else f", growth rate {self.growth_rate:.6g}"
        words = "stable" if self.stable else f"unstable{rate}"
        told = f"; warnings: {len(self.warnings)}" if self.warnings else ""
        return f"SystemVerdict({words}, {self.kind}{told})"

    @property
    def details(self) -> str:
        """All that there is to say: the lines of ``str(verdict)``, and what stands behind them."""
        return self._said("details")

    def __str__(self) -> str:
        return self._said("text")

    def _said(self, form: str) -> str:
        sentence, notes = "", self.system.notes
        if self._is_respa:
            sentence, notes = self.system._orbit_sentence(), self.system._new_warnings(notes)
        return sentence + _lines(notes) + self._asked.render(form).rstrip()
