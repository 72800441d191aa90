"""Systems of ASE: one calculator for each group of forces.

Units: lengths in Å, energies in eV, masses in u as ASE has them; steps in fs, exact, or with their unit, ``"0.004ps"``.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np

from kickdrift._errors import KickdriftError, needs
from kickdrift._held import Held
from kickdrift._hessians import (
    LONGEST,
    SOUGHT,
    Followed,
    Force,
    Monodromy,
    Work,
    hessian,
    minimum,
    monodromy,
    seconds_of,
    seen,
    unbalanced,
)
from kickdrift._numbers import Exact, doubles, duration
from kickdrift._progress import Progress, shown
from kickdrift._rigid import Doubles, is_held, norm, rigid_motions
from kickdrift._system import System

try:
    from ase import Atoms, units
except ImportError:
    raise needs("ase") from None

__all__ = ["oscillations", "system"]

#: The difference of positions, Å.
DIFFERENCE = 1e-3


def system(
    atoms: Any,
    groups: Mapping[str, tuple[Any, Exact]],
    *,
    minimize: bool = True,
    difference: float = DIFFERENCE,
    progress: Progress | bool = False,
    symmetric: bool = True,
    longest: float = LONGEST,
) -> System:
    """Make a system of ASE's: the Hessian of each calculator at the minimum of all, with its measured error.

    Parameters
    ----------
    atoms : ase.Atoms
        Not changed; constraints of ASE's are an error.
    groups : mapping of str to (calculator, step)
        The forces, and how often each is integrated: a number of fs, exactly, or a text with its unit. A pair of
        calculators stands for the first minus the second: ``{"cheap": (cheap, "0.5fs"), "correction": ((dear, cheap),
        "4fs")}`` evaluates a dear potential every 4 fs.
    minimize : bool
        Go to the minimum beside the positions first, by Newton's method.
    difference : float
        The difference of positions, Å.
    progress : bool or callable
        A bar on standard error, in a log four lines a group, behind what it will take; or what is called with the
        columns done and the columns in all, for each group.
    longest : float
        Seconds: Hessians that would take longer, or more memory than there is, are refused before they are begun.
    symmetric : bool
        False: some force is no gradient, as one that is learned and predicted directly. Then the asymmetry of a
        Jacobian is no error, and the answer's ``no_gradient`` keeps apart what grows without steps.

    Returns
    -------
    System
        In fs; its ``accuracy`` is the largest estimated error of a Hessian over its norm, its ``notes`` say whether the
        groups' own forces vanish at the positions: where they do not, a run is not about them. Rigid motions are
        projected out, in a periodic cell translations alone.

    Raises
    ------
    KickdriftError
        No group, a step that is not positive, constraints, positions that are near no minimum, Hessians known too badly
        for any verdict.

    Examples
    --------
    >>> import ase
    >>> from ase.calculators.emt import EMT
    >>> import kickdrift.ase
    >>> found = kickdrift.ase.system(ase.Atoms("Cu2", [[0, 0, 0], [2.2, 0, 0]]), {"all": (EMT(), 5)})
    >>> found.decide().stable
    True
    """
    forces, steps, masses = _forces(atoms, groups)
    dear, sought = _evaluation(forces, atoms), SOUGHT * len(forces) if minimize else 0
    Work(3 * len(atoms), len(forces), dear, sought).begin(longest, progress is True, "fewer atoms")
    where = _start(atoms, forces, masses, minimize, difference, progress)
    seen_by = shown(progress)
    measured = {
        name: hessian(force, where, masses, difference, None, seen_by, symmetric) for name, force in forces.items()
    }
    accuracy = max(seen(*own, name, f"{difference:g} Å") for name, own in measured.items())
    pulls = {name: force(where) / units.fs**2 for name, force in forces.items()}
    total = np.sum([matrix for matrix, _ in measured.values()], axis=0) / units.fs**2
    follow = "Ask oscillations(...) for what grows about that orbit, as a run shows it"
    notes = unbalanced(pulls, norm(total), masses, "eV/Å", follow)
    moved = rigid_motions(where, masses, rotations=False)
    held = is_held(total * units.fs**2, moved, sum(error for _, error in measured.values()))
    root = np.sqrt(np.repeat(masses, 3))
    potentials: dict[str, tuple[Exact, Doubles]] = {}
    for (name, (matrix, _)), step in zip(measured.items(), steps, strict=True):
        own = (matrix + matrix.T) / 2 if symmetric else matrix
        potentials[name] = (step, own * np.outer(root, root))
    made = System.from_hessians(
        masses,
        potentials,
        positions=None if held else where,
        accuracy=accuracy,
        title=f"{len(atoms)} atoms, fs and Å",
        time_unit="fs",
        labels=[f"{symbol}{n}" for n, symbol in enumerate(atoms.get_chemical_symbols())],
        notes=notes,
        periodic=bool(atoms.pbc.any()),
        keep_rigid=held,
        symmetric=symmetric,
    )
    if not symmetric:
        return made

    def find() -> Monodromy:
        at = atoms.copy()
        at.positions = where
        return _oscillations(at, groups, "orbit", False, difference, unit=None)

    work = Work.of_period(3 * len(atoms), steps, dear, "orbit")
    return replace(made, _orbit=Followed.beside(work, notes, find, f"{float(max(steps)):g} fs", "Å"))


def oscillations(
    atoms: Any,
    groups: Mapping[str, tuple[Any, Exact]],
    *,
    about: str = "orbit",
    minimize: bool = True,
    difference: float = DIFFERENCE,
    progress: Progress | bool = False,
    longest: float = LONGEST,
) -> Monodromy:
    """Measure what small deviations do over a period, about the integrator's own orbit or about the minimum.

    Parameters
    ----------
    atoms, groups, minimize, difference
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
    >>> import ase
    >>> from ase.calculators.emt import EMT
    >>> import kickdrift.ase
    >>> kickdrift.ase.oscillations(ase.Atoms("Cu2", [[0, 0, 0], [2.2, 0, 0]]), {"all": (EMT(), 5)}).stable
    True
    """
    return _oscillations(atoms, groups, about, minimize, difference, "fs", progress, longest)


def _oscillations(
    atoms: Any,
    groups: Mapping[str, tuple[Any, Exact]],
    about: str,
    minimize: bool,
    difference: float,
    unit: str | None,
    progress: Progress | bool = False,
    longest: float = LONGEST,
) -> Monodromy:
    """:func:`oscillations`; without a ``unit`` an orbit not found at once is not followed from shorter steps."""
    forces, steps, masses = _forces(atoms, groups)
    dear, sought = _evaluation(forces, atoms), SOUGHT * len(forces) if minimize else 0
    Work.of_period(3 * len(atoms), steps, dear, about, sought).begin(longest, progress is True, "fewer atoms")
    where = _start(atoms, forces, masses, minimize, difference, progress)
    told = shown(progress, "Hessians of half a period")
    is_boxed = bool(atoms.pbc.any())
    return monodromy(
        forces, steps, where, Held(masses), difference, about, unit, told, time_unit="fs", is_boxed=is_boxed
    )


def _evaluation(forces: Mapping[str, Force], atoms: Any) -> float:
    """Seconds that a group's force takes, their mean."""
    return sum(seconds_of(force, atoms.positions) for force in forces.values()) / len(forces)


def _forces(atoms: Any, groups: Mapping[str, tuple[Any, Exact]]) -> tuple[dict[str, Force], list[Fraction], Doubles]:
    if not groups:
        raise KickdriftError("groups", None, "give a calculator and a step for each group of forces")
    if atoms.constraints:
        raise KickdriftError("atoms", f"{len(atoms.constraints)} constraints", "constraints are not handled here")
    forces, steps = {}, []
    for name, (calculator, step) in groups.items():
        forces[name] = _force(atoms, calculator)
        steps.append(duration(f"groups[{name}]", step, "fs"))
    # From eV to u Å²/fs².
    return forces, steps, np.asarray(atoms.get_masses(), dtype=np.float64)


def _force(atoms: Any, calculator: Any) -> Callable[[Doubles], Doubles]:
    if isinstance(calculator, tuple):
        dear, cheap = (_force(atoms, own) for own in calculator)
        return lambda positions: dear(positions) - cheap(positions)
    own = Atoms(numbers=atoms.numbers, positions=atoms.positions, cell=atoms.cell, pbc=atoms.pbc)
    own.set_masses(atoms.get_masses())
    own.set_initial_charges(atoms.get_initial_charges())
    own.calc = calculator

    def of(positions: Doubles) -> Doubles:
        own.set_positions(positions)
        return np.asarray(own.get_forces() * units.fs**2, dtype=np.float64)

    return of


def _start(
    atoms: Any,
    forces: Mapping[str, Force],
    masses: Doubles,
    minimize: bool,
    difference: float,
    progress: Progress | bool,
) -> Doubles:
    where = doubles("atoms", atoms.positions)
    if not minimize:
        return where
    every, told = list(forces.values()), shown(progress, "columns on the way to the minimum")

    def whole(at: Doubles) -> Doubles:
        return np.asarray(np.sum([force(at) for force in every], axis=0))

    return minimum(whole, where, Held(masses), difference, progress=told)[0]
