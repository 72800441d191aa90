"""Advice: which steps are safe for these periods or for this molecule, for how long, and why."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from importlib import import_module
from os import PathLike, fspath
from typing import Any, Protocol, overload, runtime_checkable

from kickdrift._advice import Advice, Engine, SystemAdvice, Time
from kickdrift._errors import KickdriftError, known
from kickdrift._numbers import Exact
from kickdrift._periods import advise_archive, advise_periods, listed
from kickdrift._system import System


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


@overload
def advise(
    periods: Mapping[str, Time] | Sequence[Time] | Sequence[tuple[str, Time]] = (),
    *,
    steps: str | Sequence[Any] = (),
    bonds: Mapping[str, str] | Sequence[tuple[str, str]] | None = None,
    on: Mapping[str, int] | Sequence[tuple[str, int]] | None = None,
    engine: Engine | None = None,
    band: Exact = "5%",
    length: Time | None = None,
    temperature: Exact | None = None,
    bond_count: int | None = None,
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
    bonds: Mapping[str, str] | Sequence[tuple[str, str]] | None = None,
    on: Mapping[str, int] | Sequence[tuple[str, int]] | None = None,
    engine: Engine | None = None,
    band: Exact = "5%",
    length: Time | None = None,
    temperature: Exact | None = None,
    bond_count: int | None = None,
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
        A mapping of str to Time, pairs of both, or a sequence of Time: the periods of the forces, fs, wavenumbers as
        ``"3700/cm"``, or ``"water"``, ``"protein"`` (in water), ``"peptide"`` (in vacuum) for what nonbonded forces
        have there; the last ones are on the slower clocks. A typical ``"fast"`` one has a name, as
        ``"protein,h-bonds"`` or ``"water,rigid"``. Without the fastest period nothing is called safe. Texts without a
        unit are plain numbers, where all times are. Or a molecule: a :class:`System`, the path of a system file,
        OpenMM's ``Simulation`` or ``System``, ASE's ``Atoms``, an instance of LAMMPS, which is asked for
        :meth:`System.advise`; or the path of an archive ``FILE.npz`` with ``fast``, ``slow`` (mass-weighted, 1/ps²),
        ``masses`` and ``positions``.
    steps : sequence of Time, or a sequence of such
        A scheme, from the innermost to the outermost step, fs; or several schemes. For OpenMM's ``System`` also
        a mapping of force groups to steps.
    bonds : mapping of str to str, optional
        ``"k=1106kcal/mol/A^2,15.999,1.008"``: the force constant (k of E = k x²/2, K of E = K x²), two masses in amu,
        and behind them the heavy atom's hydrogens if not 1. In place of ``k=X`` the bond's shape, as
        :func:`aperture` reads it: ``"morse:D=485.72kJ/mol,a=22.87/nm,15.999,1.008"``.
    on : mapping of str to int, optional
        The clocks of modes, 1 the fastest.
    engine : path or text, or a sequence of such, optional
        An input of OpenMM, LAMMPS, GROMACS, NAMD, Tinker or i-PI, for its steps.
    band : Exact or percentage
        How far every period may be off, relatively.
    length : Time, optional
        The length of the run, as ``"10ns"``.
    temperature : Exact, optional
        At which bonds of a known shape must stay: a number in K, or a text with its unit; 298 K unless given.
    bond_count : int, optional
        How many bonds of a known shape the run has, whose hottest must stay; 10,000 unless given.
    friction : Exact, optional
        A thermostat's, as ``"1/ps"``: does it mask the growth?
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
        With more than 1,200 degrees of freedom in OpenMM the answer comes from :func:`kickdrift.openmm.bands`, which
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
    is_archive = is_path(periods, ".npz")
    found, rest = (None, listed(steps)) if is_archive else molecule(periods, steps, made)
    if is_archive or found is not None:
        of_periods = {"bonds": bonds, "on": on, "temperature": temperature, "bond_count": bond_count}
        for field, value in (of_periods | {"all_modes": all_modes or None}).items():
            if value is not None:
                raise KickdriftError(field, str(value), "is for periods: a system has its modes of its own")
    if is_archive:
        known(made, advise, elsewhere=_OF_ENGINES)
        scales = (band, length, friction, constraints, hmr)
        return advise_archive(periods, rest, engine, scales, levers=levers, harmonic=harmonic)
    if found is not None:
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
    known(made, advise, elsewhere=_OF_ENGINES)
    return advise_periods(
        periods,
        rest,
        engine,
        (band, length, friction, constraints, hmr),
        bonds=bonds,
        on=on,
        temperature=temperature,
        bond_count=bond_count,
        levers=levers,
        all_modes=all_modes,
        harmonic=harmonic,
    )


#: Whose objects are systems, each read by the module of this name; and what keywords are that :func:`advise` does not
#: name.
_ENGINES = ("ase", "lammps", "openmm")
_OF_ENGINES = "is for a system of OpenMM, ASE or LAMMPS; periods are a mapping, as {'OH': '10fs', 'slow': '40fs'}"


def is_path(given: Any, ending: str) -> bool:
    """Whether this is the path of a file with such an ending."""
    return isinstance(given, str | PathLike) and fspath(given).endswith(ending)


def molecule(
    given: Any, steps: str | Sequence[Any] | Mapping[int, Any], made: Mapping[str, Any]
) -> tuple[Advisable | None, str | Sequence[Any]]:
    """The system that this is or makes, None where it is periods; and the schemes asked about beside its own."""
    is_file = is_path(given, ".json")
    if is_file or isinstance(given, Advisable):
        known(made, advise, elsewhere=_OF_ENGINES)
        return System.read(given) if is_file else given, listed(steps)
    home = type(given).__module__.partition(".")[0]
    if home not in _ENGINES:
        return None, listed(steps)
    # The engine is installed, for this is an object of its.
    engine = import_module(f"kickdrift.{home}")
    known(made, engine.system, advise)
    found: tuple[Advisable, str | Sequence[Any]] = engine.given(given, steps, made)
    return found
