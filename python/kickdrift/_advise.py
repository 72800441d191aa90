"""Advice: which steps are safe for these periods, for how long, and why."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from html import escape
from os import PathLike, fspath
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias, overload, runtime_checkable

from kickdrift import _plot
from kickdrift._document import Asked, Document, Row, flat, frame
from kickdrift._errors import KickdriftError, known, shown
from kickdrift._files import text_of
from kickdrift._native import Number
from kickdrift._numbers import Exact, items, mapping_of, text, written

if TYPE_CHECKING:
    import pandas
    from matplotlib.axes import Axes

Time: TypeAlias = Exact
"""A length of time: a text with its unit as ``"0.5fs"`` or ``"0.01ps"``, or an exact number of fs."""

Engine: TypeAlias = str | PathLike[str] | Sequence[str | PathLike[str]]
"""An input of a simulation engine: a path, or its text (of several lines); of OpenMM a system and an integrator."""


@runtime_checkable
class Advisable(Protocol):
    """A system."""

    def advise(
        self,
        steps: str | Sequence[Any] = (),
        *,
        engine: Engine | None,
        band: Exact,
        length: Time | None,
        friction: Exact | None,
        constraints: str | None,
        hmr: Exact | None,
        levers: bool,
        harmonic: bool,
    ) -> Any: ...


_COLOURS = {"safe": "safe", "caution": "caution", "near": "caution", "island": "caution", "little": "safe"}


@dataclass(frozen=True, eq=False, repr=False)
class Advised(Document):
    """What all advice has: schemes of steps, each with a status, and what to do."""

    _text: str

    _schemes_are = "schemes"

    @property
    def status(self) -> str:
        """The first scheme: ``safe``, ``caution`` (proven stable, beyond a published limit), ``near`` (an unstable
        interval is within the band), ``island`` (stable above an unstable interval), ``unstable``, or of Hessians ``not
        told`` within their accuracy; of periods ``not told`` without the fastest one. Of forces that are no gradient
        what the steps add to their growth: ``little``,
        ``much``, ``not told``."""
        return str(self.schemes[0]["status"])

    @property
    def safe(self) -> Number | None:
        """The longest outer step of the first scheme, fs, that is proven stable for the whole band and below what is
        published: T/3 of the fastest motion, and of each clock's own forces T/6.28."""
        return _number(self.schemes[0]["safe"])

    @property
    def largest(self) -> Number | None:
        """The longest one that is proven stable for the whole band."""
        return _number(self.schemes[0]["largest"])

    @cached_property
    def schemes(self) -> tuple[Row, ...]:
        """One row a scheme: ``outer``, ``status``, ``band_edge``, ``largest``, ``safe`` and so on; steps in fs."""
        return self._table(self._schemes_are)

    @cached_property
    def rows(self) -> tuple[Row, ...]:
        """One row a scheme and fast mode (of Hessians one a scheme): growth, and the unstable intervals of the outer
        step, fs."""
        return self._table("rows")

    @cached_property
    def levers(self) -> tuple[Row, ...]:
        """What would let the outer step of the first scheme grow: masses, constraints, methods, ratios, one row each.

        ``first`` unstable step, ``band_edge`` (proven below), ``step`` to take and its ``bound``, costs a picosecond,
        ``gain``, ``engines``; empty where they were left out.

        Examples
        --------
        >>> import kickdrift as kd
        >>> advice = kd.advise(["10fs", "40fs"], steps=["0.5fs", "4fs"])
        >>> [(row["lever"], row["step"]) for row in advice.levers[:2]], advice.levers[5]["first_exact"]
        ([('as given', '3'), ('MOLLY, short average', '231/50')], '40/pi')
        """
        return self._table("levers") if "levers" in self.data else ()

    @property
    def engine(self) -> Mapping[str, Any] | None:
        """What was read of an engine's input: ``name``, ``forces``, ``used``, ``remarks``, and its lines ``rewritten``
        with the step that is advised."""
        found = self.data.get("engine")
        return None if found is None else MappingProxyType(found)

    def _table(self, name: str) -> tuple[Row, ...]:
        return tuple(MappingProxyType(row) for row in self.data[name])

    def to_pandas(self) -> pandas.DataFrame:
        """The rows as a data frame; the ends of enclosures stand beside each other, as ``first_lower_lo``.

        Examples
        --------
        >>> import kickdrift as kd
        >>> frame = kd.advise({"OH": "10fs", "slow": "40fs"}, steps=["0.5fs", "4fs"]).to_pandas()
        >>> len(frame), "first_lower_lo" in frame
        (1, True)
        """
        return frame(flat(self.rows))

    def __str__(self) -> str:
        return self._text

    def __repr__(self) -> str:
        each = (f"{float(Number(scheme['outer'])):g} fs {scheme['status']}" for scheme in self.schemes)
        return f"{type(self).__name__}({', '.join(each)})"

    def _repr_html_(self) -> str:
        colour = _plot.COLOURS[_COLOURS.get(self.status, "unstable")]
        style = f"border-left: 4px solid {colour}; padding-left: 1em"
        lines, *_ = self._text.split("\n\n")
        return f"<pre style='{style}'>{escape(lines)}</pre>"


@dataclass(frozen=True, eq=False, repr=False)
class Advice(Advised):
    """Which steps are safe for some periods: each scheme of steps with each fast mode, what to do, and why.

    Examples
    --------
    >>> import kickdrift as kd
    >>> advice = kd.advise({"OH": "10fs", "slow": "40fs"}, steps=[("0.5fs", "4fs"), ("0.5fs", "5fs")])
    >>> advice.status, advice.safe, [scheme["status"] for scheme in advice.schemes]
    ('caution', Number('3'), ['caution', 'island'])
    """

    _asked: Asked

    @cached_property
    def modes(self) -> tuple[Row, ...]:
        """One row a mode: its clock, period and the limits that follow, fs."""
        return self._table("modes")

    def to_svg(self) -> str:
        """The program's figure: the outer step across, each mode a row.

        Examples
        --------
        >>> import kickdrift as kd
        >>> kd.advise({"OH": "10fs", "slow": "40fs"}, steps=["0.5fs", "4fs"]).to_svg().startswith("<svg")
        True
        """
        return self._asked.svg()

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw what is proven stable and unstable over the outer step of the first scheme, a row a mode.

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Where to draw; a new figure unless given.

        Examples
        --------
        >>> import kickdrift as kd
        >>> kd.advise({"OH": "10fs", "slow": "40fs"}, steps=["0.5fs", "4fs"]).plot().get_xlabel()
        'outer step (fs)'
        """
        return _plot.advice(self.data, ax)

    def _repr_html_(self) -> str:
        return f"{super()._repr_html_()}{self.to_svg()}"


@dataclass(frozen=True, eq=False, repr=False)
class SystemAdvice(Advised):
    """Which steps are safe for a molecule by its Hessians, as :meth:`System.advise` finds.

    Examples
    --------
    >>> import kickdrift as kd
    >>> fast, slow = [[0.39, 0], [0, 0.41]], [[0.02, 0.01], [0.01, 0.02]]
    >>> system = kd.System.from_hessians([1, 1], {"fast": ("1/2", fast), "slow": (4, slow)}, time_unit="fs")
    >>> advice = system.advise()
    >>> advice.status, advice.groups[0]["count"]
    ('caution', 2)
    """

    warnings: tuple[str, ...] = ()
    """What limits the advice, in words: what was found when the system was made, and what its verdict warns of."""

    _schemes_are = "rows"

    @cached_property
    def groups(self) -> tuple[Row, ...]:
        """The modes of the fast stiffness alone, the fastest first: ``count``, ``shortest``, ``longest`` period, fs,
        and the ``atoms`` that the fastest moves; none of forces that are no gradient."""
        return self._table("groups") if "groups" in self.data else ()

    @cached_property
    def ladder(self) -> tuple[Row, ...]:
        """Of forces that are no gradient the multiples of the step before the outermost one that were looked at:
        ``outer``, the enclosed ``growth_rate``, per ps, and what the steps add, ``status``; none of others.

        Examples
        --------
        >>> import kickdrift as kd
        >>> cheap, correction = [[0.5, 0], [0, 0.5]], [[0.02, 1e-4], [-1e-4, 0.02]]
        >>> levels = {"cheap": ("1/2", cheap), "correction": (4, correction)}
        >>> advice = kd.System.from_hessians([1, 1], levels, time_unit="fs", symmetric=False).advise()
        >>> advice.status, advice.ladder[7]["outer"], advice.ladder[7]["status"]
        ('little', '4', 'little')
        """
        return self._table("ladder") if "ladder" in self.data else ()

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw what is proven stable and the first unstable interval over the outer step, a row a scheme.

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Where to draw; a new figure unless given.

        Examples
        --------
        >>> import kickdrift as kd
        >>> fast, slow = [[0.39, 0], [0, 0.41]], [[0.02, 0.01], [0.01, 0.02]]
        >>> system = kd.System.from_hessians([1, 1], {"fast": ("1/2", fast), "slow": (4, slow)}, time_unit="fs")
        >>> system.advise().plot().get_xlabel()
        'outer step (fs)'
        """
        if self.ladder:
            return _plot.ladder(self.data, ax)
        return _plot.system_advice(self.data, ax)


def _number(value: str | None) -> Number | None:
    return None if value is None else Number(value)


@overload
def advise(
    periods: Mapping[str, Time] | Sequence[Time] = (),
    *,
    steps: str | Sequence[Any] = (),
    bonds: Mapping[str, str] | None = None,
    on: Mapping[str, int] | None = None,
    engine: Engine | None = None,
    band: Exact = "5%",
    length: Time | None = None,
    friction: Exact | None = None,
    constraints: str | None = None,
    hmr: Exact | None = None,
    levers: bool = True,
    all_modes: bool = False,
    harmonic: bool = False,
) -> Advice: ...


@overload
def advise(
    periods: Any,
    *,
    steps: str | Sequence[Any] | Mapping[int, Any] = (),
    engine: Engine | None = None,
    band: Exact = "5%",
    length: Time | None = None,
    friction: Exact | None = None,
    constraints: str | None = None,
    hmr: Exact | None = None,
    levers: bool = True,
    harmonic: bool = False,
    **made: Any,
) -> SystemAdvice: ...


def advise(
    periods: Any = (),
    *,
    steps: str | Sequence[Any] | Mapping[int, Any] = (),
    bonds: Mapping[str, str] | None = None,
    on: Mapping[str, int] | None = None,
    engine: Engine | None = None,
    band: Exact = "5%",
    length: Time | None = None,
    friction: Exact | None = None,
    constraints: str | None = None,
    hmr: Exact | None = None,
    levers: bool = True,
    all_modes: bool = False,
    harmonic: bool = False,
    **made: Any,
) -> Advice | SystemAdvice:
    """Say which steps are safe for these periods, for how long, and why.

    Parameters
    ----------
    periods : what vibrates
        A mapping of str to Time, or a sequence of Time: the periods of the forces, fs, wavenumbers as ``"3700/cm"``, or
        ``"water"``, ``"protein"`` (in water), ``"peptide"`` (in vacuum) for what nonbonded forces have there; the last
        ones are on the slower clocks. Of ``"fast"`` a typical one by name, as ``"protein,h-bonds"`` or
        ``"water,rigid"``.
        Without the fastest period nothing is called safe. Texts without a unit are plain numbers, where all
        times are. Or a molecule: a :class:`System`, the path of a system file, OpenMM's
        ``Simulation`` or ``System``, ASE's ``Atoms``, an instance of LAMMPS, which is asked for :meth:`System.advise`.
    steps : sequence of Time, or a sequence of such
        A scheme, from the innermost to the outermost step, fs; or several schemes. Of OpenMM's ``System`` also a
        mapping of force groups to steps.
    bonds : mapping of str to str, optional
        ``"k=1106kcal/mol/A^2,15.999,1.008"``: the force constant (k of E = k x²/2, K of E = K x²), two masses in amu,
        and behind them the heavy atom's hydrogens if not 1.
    on : mapping of str to int, optional
        The clocks of modes, 1 the fastest.
    engine : path or text, or a sequence of such, optional
        An input of OpenMM, LAMMPS, GROMACS, NAMD, Tinker or i-PI, for its steps.
    band : Exact or percentage
        How far every period may be off, relatively.
    length : Time, optional
        The length of the run, as ``"10ns"``.
    friction : Exact, optional
        A thermostat's, as ``"1/ps"``: whether it masks what grows.
    constraints : str, optional
        What is held: ``"h-bonds"``, of bonds also ``"all-bonds"`` or their names.
    hmr : Exact, optional
        Hydrogens of this mass in amu, taken from their heavy atoms.
    levers : bool
        Whether to say what would let the step grow.
    all_modes : bool
        The periods are the shortest of all motions on their clocks, so that it is known whether a faster one exists.
    harmonic : bool
        The bonds are harmonic: nothing published bounds a clock's own step, which else stays below T/6.28.
    **made
        What else makes the system of OpenMM's, ASE's or LAMMPS's: the keywords of :func:`kickdrift.openmm.system`
        (``positions``, ``topology``, ``integrator`` and so on), :func:`kickdrift.ase.system` (``groups``) or
        :func:`kickdrift.lammps.system` (``respa``).
        Of OpenMM's with more than 1,200 degrees of freedom the answer is that of :func:`kickdrift.openmm.bands`, which
        takes seconds, unless ``longest`` gives the seconds that Hessians may take.

    Raises
    ------
    KickdriftError, BudgetError
        Bad input, with its field, value and remedy; a ratio of steps that makes too long a period.

    Examples
    --------
    >>> import kickdrift as kd
    >>> advice = kd.advise(["10fs", "40fs"], steps=["0.5fs", "4fs"])
    >>> print(str(advice).splitlines()[0])
    4 fs    stable; next unstable interval 4.6768-4.9679 fs, margin 0.677 fs; caution: not below T/3 = 3.33 fs
    >>> [mode["from"] for mode in kd.advise({"OH": "10fs", "slow": "water"}, steps=["0.5fs", "4fs"]).modes]
    ['period', 'slow period of water']
    >>> gromacs = "dt = 0.0005 ; ps\\nmts = yes\\nmts-level2-factor = 8\\n"
    >>> kd.advise(["10fs", "40fs"], engine=gromacs).engine["rewritten"]
    ['mts-level2-factor = 6', 'nstlog = 1020', 'nstenergy = 1020', 'nstcalcenergy = 102']
    """
    found, rest = molecule(periods, steps, made)
    if found is not None:
        for field, value in {"bonds": bonds, "on": on, "all_modes": all_modes or None}.items():
            if value is not None:
                raise KickdriftError(field, str(value), "is for periods: a system has its modes of its own")
        told: Advice | SystemAdvice = found.advise(
            rest,
            engine=engine,
            band=band,
            length=length,
            friction=friction,
            constraints=constraints,
            hmr=hmr,
            levers=levers,
            harmonic=harmonic,
        )
        return told
    known(made, advise, elsewhere=_ENGINES)
    given_alone = [periods] if isinstance(periods, str) else periods
    alone = items("periods", given_alone, "give a list of periods in fs, or texts as '10fs'; or periods by name")
    named = periods.items() if isinstance(periods, Mapping) else ((None, value) for value in alone)
    given: dict[str, list[str]] = {"period": [], "bond": [], "on": []}
    for name, value in named:
        own = str(_time("periods", value))
        given["period"].append(own if name is None else f"{_name('periods', name)}={own}")
    bonded, clocks = mapping_of("bonds", bonds or {}, _BONDS), mapping_of("on", on or {}, _CLOCKS)
    given["bond"] = [f"{_name('bonds', name)}:{value}" for name, value in bonded.items()]
    given["on"] = [f"{_name('on', name)}={clock}" for name, clock in clocks.items()]
    scales = (band, length, friction, constraints, hmr)
    every = asked(given, rest, engine, scales, levers=levers, all_modes=all_modes, harmonic=harmonic)
    return Advice(every.render("json"), every.render("text"), every)


#: What to give in place of what is none.
_BONDS = "give a mapping of names to bonds, as {'OH': 'k=1106kcal/mol/A^2,15.999,1.008'}"
_CLOCKS = "give a mapping of names to clocks, as {'OH': 1}"
_INPUTS = "give the path of an input or its text, or several"

#: What keywords are that :func:`advise` does not name.
_ENGINES = "is for a system of OpenMM, ASE or LAMMPS"


def molecule(
    given: Any, steps: str | Sequence[Any] | Mapping[int, Any], made: Mapping[str, Any]
) -> tuple[Advisable | None, str | Sequence[Any]]:
    """The system that this is or makes, None where it is periods; and the schemes asked about beside its own."""
    if isinstance(given, Advisable):
        known(made, advise, elsewhere=_ENGINES)
        return given, _no_groups(steps)
    if isinstance(given, str | PathLike) and fspath(given).endswith((".json", ".npz")):
        known(made, advise, elsewhere=_ENGINES)
        from kickdrift._system import System

        return System.read(given), _no_groups(steps)
    home = type(given).__module__.partition(".")[0]
    if home == "ase":
        from kickdrift import ase

        if "groups" not in made:
            raise KickdriftError("groups", None, "of ASE give groups={'fast': (calculator, '0.5fs'), ...}")
        known(made, ase.system, advise)
        return ase.system(given, **made), _no_groups(steps)
    if home == "lammps":
        from kickdrift import lammps

        if "respa" not in made:
            raise KickdriftError("respa", None, "of LAMMPS give respa='run_style respa ...', the line with its levels")
        known(made, lammps.system, advise)
        return lammps.system(given, **made), _no_groups(steps)
    if home == "openmm":
        from kickdrift import openmm

        known(made, openmm.system, advise)
        return openmm.given(given, steps, made)
    return None, _no_groups(steps)


def _no_groups(steps: str | Sequence[Any] | Mapping[int, Any]) -> str | Sequence[Any]:
    if isinstance(steps, Mapping):
        raise KickdriftError("steps", shown(steps), "steps by force group are OpenMM's: list them, the inner one first")
    return steps


def asked(
    given: Mapping[str, str | list[str]],
    steps: str | Sequence[Any],
    engine: Engine | None,
    scales: tuple[Exact, Time | None, Exact | None, str | None, Exact | None],
    place: str | Mapping[str, Any] = "",
    levers: bool = True,
    all_modes: bool = False,
    harmonic: bool = False,
) -> Asked:
    """The question about what is given, and what all advice is asked with: the band, the length of the run, friction,
    constraints, the mass of hydrogens."""
    band, length, friction, constraints, hmr = scales
    engines = _inputs(engine)
    texts = [_text(given) for given in engines]
    rest = {
        "steps": _schemes(steps),
        "engine": texts,
        "band": band if isinstance(band, str) else text("band", band),
        "length": _time("length", length),
        "friction": friction if friction is None or isinstance(friction, str) else f"{text('friction', friction)}/ps",
        # OpenMM's own names are objects.
        "constraints": constraints if constraints is None or isinstance(constraints, str) else str(constraints),
        "hmr": hmr if hmr is None or isinstance(hmr, str) else text("hmr", hmr),
        "no_levers": None if levers else "true",
        "all_modes": "true" if all_modes else None,
        "harmonic": "true" if harmonic else None,
    }
    names = [
        f"engine{n}" if own == fspath(path) else fspath(path)
        for n, (path, own) in enumerate(zip(engines, texts, strict=True))
    ]
    every = {name: value for name, value in {**given, **rest}.items() if value}
    return Asked("advise", every, None, place, {"engine": names} if names else {})


def _inputs(engine: Engine | None) -> list[str | PathLike[str]]:
    """An engine's inputs: none, one or several."""
    if engine is None or isinstance(engine, str | PathLike):
        return [engine] if engine else []
    several = items("engine", engine, _INPUTS)
    for given in several:
        if not isinstance(given, str | PathLike):
            raise KickdriftError("engine", shown(given), _INPUTS)
    return several


def _text(engine: str | PathLike[str]) -> str:
    """An engine's input: it itself where it has several lines, or what stands in the file."""
    own = fspath(engine)
    if "\n" in own:
        return own
    # Letters in comments, which no engine reads, may be in Latin-1.
    return text_of(own, "name an engine's input", "latin-1")


def _time(field: str, value: Time | None) -> str | None:
    if value is None or isinstance(value, str):
        return value and written(field, value)
    return f"{text(field, value)}fs"


def _name(field: str, name: str) -> str:
    if not name or set(name) & set("=:,"):
        raise KickdriftError(field, name, "give a name without the signs = : ,")
    return name


def _schemes(steps: str | Sequence[Any]) -> list[str]:
    """Schemes as the program reads them; one scheme may stand alone."""
    if isinstance(steps, str):
        return [written("steps", steps)]
    own = items("steps", steps, "give the steps of a scheme, the inner one first, as '0.5fs,4fs' or [0.5, 4]")
    several = bool(own) and isinstance(own[0], list | tuple)
    schemes = own if several else [own] if own else []
    return [",".join(str(_time("steps", step)) for step in scheme) for scheme in schemes]
