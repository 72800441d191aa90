"""Who the particles of a system of OpenMM's are: their places, bonds, constraints and names."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from kickdrift._errors import KickdriftError, shown
from kickdrift._levels import Atoms
from kickdrift._numbers import Exact, doubles, rational
from kickdrift._openmm import app, mm, unit
from kickdrift._openmm.forces import masses_of, moving_of
from kickdrift._rigid import Doubles

Constraint = tuple[int, int, float]


def names_of(
    masses: Doubles, topology: Any, kept: npt.NDArray[np.intp]
) -> tuple[list[str], list[str], list[tuple[int, int]] | None]:
    """What answers call these atoms, their elements, and who is bonded to whom; what is not known is empty or None."""
    if topology is None:
        return [f"{_symbol(masses[n])} {n}" for n in kept], [], None
    atoms = list(topology.atoms())
    if len(atoms) != len(masses):
        remedy = f"the system has {len(masses)} particles: give the topology that it was made of"
        raise KickdriftError("topology", f"{len(atoms)} atoms", remedy)
    chosen = [atoms[n] for n in kept]
    labels = [f"{atom.name} {atom.residue.name} {atom.residue.id}" for atom in chosen]
    elements = [atom.element.symbol if atom.element is not None else "atom" for atom in chosen]
    place = {n: k for k, n in enumerate(kept)}
    pairs = [(place.get(bond[0].index), place.get(bond[1].index)) for bond in topology.bonds()]
    bonded = [(i, j) for i, j in pairs if i is not None and j is not None]
    # A topology without bonds knows none: distances tell then.
    return labels, elements, bonded or None


def _symbol(mass: float) -> str:
    """The element of this mass; heavy hydrogens and atoms that gave them mass have none."""
    element = app.Element.getByMass(mass)
    near = element is not None and abs(element.mass._value - mass) < _ISOTOPES
    return str(element.symbol) if near else "atom"


#: How far, u, force fields' masses are from those of elements.
_ISOTOPES = 0.02


def atoms_of(system: Any, topology: Any, where: Doubles, masses: Doubles) -> Atoms:
    """What atoms of a system are called, before any hydrogen was made heavier; ``masses`` are what they have then.

    Who is bonded to whom tells the topology, else bonds and constraints of two that are not both hydrogens.
    """
    moving = moving_of(system)
    labels, elements, bonded = names_of(masses_of(system), topology, moving)
    symbols = elements or [label.split()[0] for label in labels]
    if bonded is None:
        place = {int(n): k for k, n in enumerate(moving)}
        bonded = [(place[i], place[j]) for i, j in bonds_of(system)]
    return Atoms(labels, symbols, bonded, where, masses)


def bonds_of(system: Any) -> list[tuple[int, int]]:
    forces = [force for force in system.getForces() if isinstance(force, mm.HarmonicBondForce)]
    pairs = [tuple(force.getBondParameters(n)[:2]) for force in forces for n in range(force.getNumBonds())]
    pairs += [tuple(system.getConstraintParameters(n)[:2]) for n in range(system.getNumConstraints())]
    masses = masses_of(system)
    distinct = {(min(pair), max(pair)) for pair in pairs if masses[list(pair)].all()}
    return sorted(pair for pair in distinct if masses[list(pair)].max() > _HYDROGEN)


#: u: what is no heavier is a hydrogen, as files of systems have it.
_HYDROGEN = 1.1


def changed(system: Any, topology: Any, where: Doubles, constraints: str | None, hmr: Exact | None) -> Any:
    """A copy with heavy hydrogens and held bonds of hydrogens, as :meth:`System.advise` has them; or the system itself.

    A bond is held at its length of rest, or as long as it is where it has none.
    """
    if constraints is None and hmr is None:
        return system
    if constraints not in (None, "h-bonds"):
        raise KickdriftError("constraints", str(constraints), "of OpenMM's systems write h-bonds")
    copy, masses = mm.XmlSerializer.clone(system), [float(mass) for mass in masses_of(system)]
    named = names_of(np.array(masses), topology, np.arange(len(masses)))[2] or bonds_of(system)
    light = [pair if masses[pair[0]] <= _HYDROGEN else pair[::-1] for pair in named]
    light = [(i, j) for i, j in light if 0 < masses[i] <= _HYDROGEN < masses[j]]
    if not light:
        raise KickdriftError("system", "no hydrogen", f"no mass is up to {_HYDROGEN} u: leave constraints and hmr out")
    if hmr is not None:
        heavy = float(rational("hmr", str(hmr).removesuffix("u").removesuffix("am").strip()))
        moved = list(masses)
        for i, j in light:
            moved[i], moved[j] = heavy, moved[j] - (heavy - masses[i])
        least = min((int(n) for n in moving_of(system)), key=lambda n: moved[n])
        if moved[least] <= 0 or heavy < max(masses[i] for i, _ in light):
            remedy = f"leaves particle {least} a mass of {moved[least]:.3g} u: give hydrogens 3.024 or so"
            raise KickdriftError("hmr", str(hmr), remedy)
        for n, mass in enumerate(moved):
            copy.setParticleMass(n, mass)
    if constraints is not None:
        place = {int(n): k for k, n in enumerate(moving_of(system))}
        there = {frozenset(copy.getConstraintParameters(n)[:2]) for n in range(copy.getNumConstraints())}
        rest: dict[frozenset[int], float] = {}
        for force in copy.getForces():
            if isinstance(force, mm.HarmonicBondForce):
                terms = (force.getBondParameters(n) for n in range(force.getNumBonds()))
                rest |= {frozenset(term[:2]): term[2]._value for term in terms}
        for i, j in light:
            if frozenset((i, j)) not in there:
                apart = float(np.linalg.norm(where[place[i]] - where[place[j]]))
                copy.addConstraint(i, j, rest.get(frozenset((i, j)), apart))
    return copy


def places_of(system: Any, atoms: Sequence[int]) -> list[int]:
    """Where atoms stand among the particles that are no virtual sites.

    Raises
    ------
    KickdriftError
        Where one is none of these.
    """
    place = {int(n): k for k, n in enumerate(moving_of(system))}
    if not len(atoms):
        raise KickdriftError("atoms", "none", "give those that move, or leave it out")
    for atom in atoms:
        if not isinstance(atom, int | np.integer):
            raise KickdriftError("atoms", shown(atom), "give the numbers of particles, from 0")
        if atom not in place:
            is_site = 0 <= atom < system.getNumParticles()
            remedy = "is a virtual site: give the atoms that it follows" if is_site else "is no particle of the system"
            raise KickdriftError("atoms", str(atom), remedy)
    return [place[int(atom)] for atom in atoms]


def positions_of(positions: Any, system: Any) -> Doubles:
    """Where the particles are that are no virtual sites, nm; sites are placed anew, whether they are given or not."""
    numbers = positions.value_in_unit(unit.nanometer) if unit.is_quantity(positions) else positions
    array = doubles("positions", numbers if isinstance(numbers, np.ndarray) else [list(row) for row in numbers])
    count, moving = system.getNumParticles(), moving_of(system)
    if array.shape == (count, 3):
        array = array[moving]
    elif array.shape != (len(moving), 3):
        or_so = f", or ({len(moving)}, 3) without the virtual sites" if len(moving) < count else ""
        raise KickdriftError("positions", f"shape {array.shape}", f"give shape ({count}, 3){or_so}")
    _are_in_nm(system, array)
    return array


def _are_in_nm(system: Any, where: Doubles) -> None:
    """That most bonds and held distances are not nearer to ten times, or to a tenth of, their length at rest.

    No force field has a state with most bonds three times as long: that is a unit. Bonds across a periodic box are left
    out, where the positions do not say which image is meant.

    Raises
    ------
    KickdriftError
        Before hours are spent.
    """
    place = {int(n): k for k, n in enumerate(moving_of(system))}
    terms = [system.getConstraintParameters(n) for n in range(system.getNumConstraints())]
    for force in system.getForces():
        if isinstance(force, mm.HarmonicBondForce) and not force.usesPeriodicBoundaryConditions():
            terms += [force.getBondParameters(n)[:3] for n in range(force.getNumBonds())]
    known = [(place[i], place[j], rest._value) for i, j, rest in terms if {i, j} <= place.keys() and rest._value > 0]
    if not known:
        return
    i, j, rest = np.array(known).T
    apart = np.linalg.norm(where[i.astype(int)] - where[j.astype(int)], axis=1) / rest
    for tens, told in ((10.0, "are they in angstrom? Give positions / 10"), (0.1, "are they in units of 10 nm?")):
        # Nearer to that than to 1, and to 100 times that: by powers of ten.
        like = (apart > tens / 10**0.5) & (apart < tens * 10**0.5)
        if 2 * like.sum() > len(like):
            remedy = f"of their length at rest have {like.sum()} of {len(like)} bonds: {told}, in nm, or a Quantity"
            raise KickdriftError("positions", f"{np.median(apart[like]):.3g} times", remedy)


def constraints_of(system: Any) -> list[Constraint]:
    """By the places of the particles that are no virtual sites."""
    place = {int(n): k for k, n in enumerate(moving_of(system))}
    every = (system.getConstraintParameters(n) for n in range(system.getNumConstraints()))
    return [(place[i], place[j], float(distance._value)) for i, j, distance in every]
