"""Systems of ASE: one calculator for each group of forces.

Units: lengths in Å, energies in eV, masses in u as ASE has them; steps in fs, exact, or with their unit, ``"0.004ps"``.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any

import numpy as np

from kickdrift._cost import LONGEST
from kickdrift._errors import KickdriftError, needs, shown
from kickdrift._groups import Groups
from kickdrift._hessians import Force
from kickdrift._monodromy import Monodromy
from kickdrift._numbers import Exact, doubles, duration, level_of, mapping_of, positive
from kickdrift._periods import listed
from kickdrift._progress import Progress
from kickdrift._rigid import Doubles
from kickdrift._shape import Shape
from kickdrift._shape import shapes as scanned
from kickdrift._system import System

try:
    from ase import Atoms, units
except ImportError:
    raise needs("ase") from None

__all__ = ["oscillations", "shapes", "system"]

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
    groups : mapping of str to (calculator, step), in either order
        The forces, and how often each is integrated: a number of fs, exactly, or a text with its unit. A pair of
        calculators stands for the first minus the second: ``{"cheap": (cheap, "0.5fs"), "correction": ((dear, cheap),
        "4fs")}`` evaluates a dear potential every 4 fs.
    minimize : bool
        Go to the minimum beside the positions first, by Newton's method.
    difference : float
        The difference of positions, Å.
    progress : bool or callable
        A bar on standard error, in a log four lines a group, with an estimate of the time; or a callback
        (columns done, columns in all) for each group.
    longest : float
        Seconds: Hessians that would take longer, or more memory than there is, are refused before they are begun.
    symmetric : bool
        False: some force is non-conservative, as a learned model that predicts forces directly. Then the asymmetry of a
        Jacobian is no error, and the answer's ``no_gradient`` keeps apart the growth without steps.

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
    width = positive("difference", difference)
    return _groups(atoms, groups).system(minimize, width, progress, symmetric, longest)


def given(atoms: Any, steps: Any, made: Mapping[str, Any]) -> tuple[System, Any]:
    """The system that advice is asked for, and the schemes asked about beside its own."""
    if "groups" not in made:
        raise KickdriftError("groups", None, "of ASE give groups={'fast': (calculator, '0.5fs'), ...}")
    return system(atoms, **made), listed(steps)


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
    width = positive("difference", difference)
    return _groups(atoms, groups).oscillations(about, minimize, width, "fs", progress, longest)


def _groups(atoms: Any, groups: Mapping[str, tuple[Any, Exact]]) -> Groups:
    if not groups:
        raise KickdriftError("groups", None, "give a calculator and a step for each group of forces")
    masses = np.asarray(atoms.get_masses(), dtype=np.float64)
    if not len(masses):
        raise KickdriftError("atoms", "none", "give at least one")
    if not (masses > 0).all():
        atom = int(np.argmin(masses > 0))
        raise KickdriftError("atoms", f"mass {masses[atom]:g} of atom {atom}", "a mass must be positive")
    if atoms.constraints:
        raise KickdriftError("atoms", f"{len(atoms.constraints)} constraints", "constraints are not handled here")
    forces: dict[str, Force] = {}
    steps: list[Fraction] = []
    for name, pair in mapping_of("groups", groups, "give a mapping of names to (calculator, step)").items():
        step, calculator = level_of(f"groups[{name}]", pair, "give (calculator, step), as (EMT(), '0.5fs')", step_at=1)
        forces[name] = _force(atoms, calculator, f"groups[{name}]")
        steps.append(duration(f"groups[{name}]", step, "fs"))
    return Groups(
        forces,
        steps,
        masses=masses,
        where=doubles("atoms", atoms.positions),
        time="fs",
        length="Å",
        # A force of u Å/fs² in eV/Å.
        force=("eV/Å", 1 / units.fs**2),
        labels=[f"{symbol}{n}" for n, symbol in enumerate(atoms.get_chemical_symbols())],
        is_boxed=bool(atoms.pbc.any()),
    )


def _force(atoms: Any, calculator: Any, field: str) -> Force:
    if isinstance(calculator, tuple) and len(calculator) == 2:
        dear, cheap = (_force(atoms, part, field) for part in calculator)
        return lambda positions: dear(positions) - cheap(positions)
    if isinstance(calculator, type) or not hasattr(calculator, "get_forces"):
        name = calculator.__name__ if isinstance(calculator, type) else shown(calculator)
        raise KickdriftError(field, name, "give a calculator of ASE's, as EMT(), or a pair of them")
    copy = Atoms(numbers=atoms.numbers, positions=atoms.positions, cell=atoms.cell, pbc=atoms.pbc)
    copy.set_masses(atoms.get_masses())
    copy.set_initial_charges(atoms.get_initial_charges())
    copy.calc = calculator

    def force(positions: Doubles) -> Doubles:
        copy.set_positions(positions)
        # From eV/Å to u Å/fs².
        return np.asarray(copy.get_forces() * units.fs**2, dtype=np.float64)

    return force


def shapes(
    atoms: Any,
    calculator: Any,
    *,
    pairs: Sequence[tuple[int, int]] | None = None,
    temperature: float = 298.0,
    count: int = 1,
) -> list[Shape]:
    """Scan the energy along the fastest bonds, some twenty energies each, and describe it as ``kd.aperture`` reads it.

    The two atoms of a bond move along it, about their centre of mass; all others stand still. A mode of several bonds
    is not scanned: a hot bond vibrates alone, since its frequency changes. So the scan leaves out the coupling of
    bonds, which makes the fastest mode some percent faster, and whatever moves meanwhile.

    Parameters
    ----------
    atoms : ase.Atoms
        At a minimum or near one. Not changed; constraints of ASE's are an error.
    calculator : ase.calculators.calculator.Calculator
        The energy.
    pairs : sequence of (int, int), optional
        Bonds, as pairs of atoms; unless given every atom and the one nearest to it. Held distances are left out.
    temperature : float
        K: the scan goes to 20 kT.
    count : int
        How many bonds, the fastest first.

    Raises
    ------
    KickdriftError
        Pairs that are none, bonds that are all held, a length without a minimum beside it.

    Examples
    --------
    >>> import ase
    >>> from ase.calculators.morse import MorsePotential
    >>> import kickdrift.ase
    >>> atoms = ase.Atoms("OH", [[0, 0, 0], [0.97, 0, 0]])
    >>> calculator = MorsePotential(epsilon=5.03, r0=0.97, rho0=2.2)
    >>> [shape] = kickdrift.ase.shapes(atoms, calculator)
    >>> shape.bond.split(":")[0], round(shape.period, 1)
    ('O0-H1', 8.7)
    """
    if atoms.constraints:
        raise KickdriftError("atoms", f"{len(atoms.constraints)} constraints", "constraints are not handled here")
    copy = atoms.copy()
    copy.calc = calculator

    def energy(positions: Doubles) -> float:
        copy.set_positions(10 * positions)
        return float(copy.get_potential_energy() * units.mol / units.kJ)

    where, masses = doubles("atoms", atoms.positions) / 10, doubles("masses", atoms.get_masses())
    names = [f"{symbol}{n}" for n, symbol in enumerate(atoms.get_chemical_symbols())]
    return scanned(energy, where, masses, names, held=(), pairs=pairs, temperature=temperature, count=count)
