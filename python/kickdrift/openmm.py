"""Systems of OpenMM: its force groups, masses and integrators, as they are run.

Units: lengths in nm, times in ps, energies in kJ/mol, so stiffness over mass is 1/ps². A step is exact: a text with its
unit as ``"0.5fs"``, a quantity of OpenMM, which is read as it is printed (4.4 fs is 22/5 fs, whatever the double), or a
number of ps. An integrator's step is a double: the simplest rational is taken that rounds to it.

What decides is the dynamics of small deviations. Friction and noise of Langevin integrators, barostats and thermostats
are left out, and ``notes`` say so.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from os import PathLike
from typing import Any

import numpy as np

from kickdrift import _covered, _forcefield, _lanczos, _sparse_held
from kickdrift._advice import Advice
from kickdrift._cost import LARGEST, LONGEST, SOUGHT, Work, seconds_of
from kickdrift._errors import KickdriftError
from kickdrift._held import Held
from kickdrift._hessians import force_at, hessian, seen, usable
from kickdrift._levels import Atoms, Band, Bands, groups_of
from kickdrift._minimum import free
from kickdrift._monodromy import FOLLOWED, Followed, Monodromy, unbalanced
from kickdrift._numbers import Exact, positive
from kickdrift._openmm import app, mm
from kickdrift._openmm.atoms import Constraint, atoms_of, changed, constraints_of, names_of, places_of, positions_of
from kickdrift._openmm.clocks import EWALD, clocks_of, clocks_of_integrator, is_bath, levels_of, mask_of, moves_nothing
from kickdrift._openmm.forces import Engine, engine_of, led_downhill, masses_of, moving_of, platforms, resumed
from kickdrift._openmm.rest import at_rest, near_minimum, relaxed
from kickdrift._orbit import monodromy
from kickdrift._progress import Progress, shown
from kickdrift._rigid import Doubles, is_held, norm, off_the_mesh, rigid_motions
from kickdrift._shape import Shape
from kickdrift._shape import shapes as scanned
from kickdrift._system import System

__all__ = ["bands", "oscillations", "shapes", "system"]

#: The difference of positions, nm: force fields are smooth on this length.
DIFFERENCE = 1e-4

#: The same where forces come in single precision.
WIDE = 1e-3


def system(
    system: Any,
    positions: Any,
    *,
    topology: Any = None,
    integrator: Any = None,
    steps: Mapping[int, Any] | None = None,
    atoms: Sequence[int] | None = None,
    minimize: bool = True,
    difference: float | None = None,
    sparse: bool = False,
    platform: str = "Reference",
    progress: Progress | bool = False,
    longest: float = LONGEST,
    resume: str | PathLike[str] | None = None,
) -> System:
    """Make a system of OpenMM's: the Hessian of each force group at the minimum, with its measured error.

    Parameters
    ----------
    system : openmm.System
        Not changed. Hydrogen mass repartitioning comes along with the masses.
    positions : Quantity or array, shape (n, 3), nm
        Virtual sites are placed by their atoms, whether they are among these or not.
    topology : openmm.app.Topology, optional
        By which answers name atoms and motions, as ``H1 HOH 4`` and ``O-H stretch of HOH``; else by masses and
        distances, as ``H 10`` and ``O-H stretch of H2O``.
    integrator : openmm.Integrator, optional
        Verlet, MTSIntegrator or their Langevin kin; or instead
    steps : mapping of int to step, optional
        The step of each force group: ``"0.5fs"``, a quantity, or a number of ps. The reciprocal space of a
        NonbondedForce has a group of its own where its ``setReciprocalSpaceForceGroup`` says so.
    atoms : sequence of int, optional
        Only the Hessians of these atoms; all others stand still.
    minimize : bool
        Go to the minimum beside the positions, in a copy; of some atoms, to theirs among the others as these stand.
    difference : float
        The difference of positions, nm: 1e-4 unless given, 1e-3 in single precision. Pairs of a NonbondedForce or
        CustomNonbondedForce stay on their side of its cutoff meanwhile.
    sparse : bool
        For thousands of atoms on two levels: bonds, angles, torsions and a NonbondedForce with a cutoff by their
        formulas, compared with differences at random displacements; other bonded terms by differences. No constraints
        and no Ewald sums; ``minimize`` is OpenMM's minimizer alone. Needs SciPy. The answer is about the first stable
        region.
    platform : str
        The name of OpenMM's platform that computes the forces. The Reference platform has doubles. Forces in single
        precision (CPU; CUDA and OpenCL unless their default Precision is set to double) leave the Hessians some hundred
        times less accurate, which their ``accuracy`` says; ``minimize`` is then OpenMM's minimizer alone. For a force
        that exists on no other platform.
    progress : bool or callable
        A bar on standard error, in a log four lines for each step, with an estimate of the time; or a callback
        (columns done, columns in all) for each step.
    longest : float
        Seconds: Hessians that would take longer, or more memory than there is, are refused before they are begun.
    resume : path, optional
        A file that keeps the differences that were taken, 16 n bytes for each of a Hessian's n columns, and where
        OpenMM's minimizer ended. The same call goes on from there after it was interrupted or killed, with the same
        result to the last bit; so do other steps of the same system at the same positions. The file stays until it is
        deleted. Hessians of ``sparse=True`` are made anew.

    Returns
    -------
    System
        Its ``accuracy`` is the largest estimated error of a Hessian over its norm, its ``notes`` list the parts left
        out, and say whether the groups' own forces vanish at the positions: if they do not, a run is about another
        place. Constraints are met by RATTLE: deviations along them are projected out, the curvature they bring is kept.
        Rigid motions are projected out: translations and rotations, in a periodic box translations alone, none among
        atoms that stand still or in an outer field. Virtual sites follow their atoms at each drift: only particles with
        a mass have degrees of freedom and positions here.

    Raises
    ------
    KickdriftError
        Groups that are never integrated, steps of groups without a force, numbers of ps that no molecule bears,
        particles that have no mass and are no virtual sites, positions that are near no minimum, Hessians known too
        badly for any verdict.

    Examples
    --------
    Two atoms on a spring of 1000 kJ/mol/nm², and walls of 10:

    >>> import openmm
    >>> import kickdrift.openmm
    >>> springs, bond = openmm.System(), openmm.HarmonicBondForce()
    >>> walls = openmm.CustomExternalForce("5*(x^2+y^2+z^2)")
    >>> walls.setForceGroup(1)
    >>> for atom in range(2):
    ...     _ = springs.addParticle(1.0), walls.addParticle(atom)
    >>> _ = bond.addBond(0, 1, 0.0, 1000.0), springs.addForce(bond), springs.addForce(walls)
    >>> found = kickdrift.openmm.system(springs, [[0, 0, 0], [0, 0, 0]], steps={0: "1/200", 1: "1/50"})
    >>> found.decide().stable
    True
    """
    clocks = clocks_of(system, integrator, steps)
    where = positions_of(positions, system)
    engine = resumed(engine_of(system, platform), where, resume)
    constraints = constraints_of(system)
    places = None if atoms is None else places_of(system, atoms)
    usual = WIDE if engine.rounding else DIFFERENCE
    difference = usual if difference is None else positive("difference", difference)
    if sparse and engine.rounding:
        raise KickdriftError("platform", platform, "computes in single precision: sparse=True needs Reference")
    if sparse:
        if constraints or atoms is not None:
            remedy = "has no sparse Hessians with constraints or some atoms alone: leave sparse=True out"
            raise KickdriftError("system", f"{len(constraints)} constraints", remedy)
        return _sparse(system, engine, clocks, where, minimize, difference, topology, shown(progress), integrator)
    columns = 3 * (engine.count if places is None else len(places))
    dear, sought = seconds_of(engine.force(-1), where), SOUGHT if minimize else 0
    work = Work(columns, len(levels_of(clocks)), dear, sought)
    work.begin(longest, progress is True, _instead(system))
    chosen = None if places is None else [3 * atom + axis for atom in places for axis in range(3)]
    if places is not None:
        constraints = [pair for pair in constraints if pair[0] in places or pair[1] in places]
    notes = _notes(system, integrator, clocks)
    if minimize and engine.rounding:
        where = relaxed(engine, where, chosen)
        place = "the positions are where OpenMM's minimizer stopped, near a minimum and not at it"
        notes.append(f"forces of the {platform} platform are in single precision: {place}")
    elif minimize:
        where, told = at_rest(engine, where, constraints, difference, chosen, _of_minimum(progress))
        notes += told
    where, difference = engine.exactly(where, difference)
    held = Held(engine.masses, constraints)
    frame = held.frame(where, chosen)
    measured = _measured(engine, clocks, (where, constraints, chosen), frame, difference, shown(progress))
    moving = free(held, where, chosen, engine.is_boxed and chosen is None)
    notes += _unbalanced(engine.masses, measured, moving, chosen)
    accuracy = max(
        seen(level.matrix, level.error, level.name, f"{difference:g} nm", engine.smoother) for level in measured
    )
    kept = np.arange(engine.count) if places is None else np.asarray(places, dtype=np.intp)
    title = f"{engine.count} particles, ps and nm"
    if chosen is not None:
        notes.append(f"only {len(kept)} of {engine.count} atoms move")
        if constraints:
            # Distances to atoms that stand still: in coordinates along the constraints, which have no names.
            levels = {level.name: (level.step, level.matrix) for level in measured}
            return System.from_hessians(
                np.ones(frame.shape[1]),
                levels,
                accuracy=accuracy,
                title=title,
                time_unit="ps",
                notes=notes,
                keep_rigid=True,
            )
    keep = chosen is not None or _is_held(system, where, engine.masses, frame, measured)
    root = np.sqrt(np.repeat(engine.masses[kept], 3))
    labels, elements, bonded = names_of(masses_of(system), topology, engine.moving[kept])
    full = {level.name: level.full for level in measured}
    if system.usesPeriodicBoundaryConditions() and not keep:
        moved = rigid_motions(where[kept], engine.masses[kept], rotations=False)
        full = {name: off_the_mesh(matrix, moved, name, accuracy, notes) for name, matrix in full.items()}
    made = System.from_hessians(
        engine.masses[kept],
        {level.name: (level.step, full[level.name] * np.outer(root, root)) for level in measured},
        positions=where[kept],
        accuracy=accuracy,
        title=title,
        time_unit="ps",
        labels=labels,
        elements=elements,
        bonded=bonded,
        forces={level.name: level.force[kept] for level in measured},
        constraints=[pair[:2] for pair in constraints] or None,
        notes=notes,
        periodic=system.usesPeriodicBoundaryConditions(),
        keep_rigid=keep,
    )
    if chosen is not None or engine.rounding:
        return made

    def find() -> Monodromy:
        # Where no orbit is found at once, others are not sought unasked: that takes ten times as long.
        return _oscillations(system, where, integrator, steps, "orbit", False, difference, unit=None)

    scheme = list(levels_of(clocks))
    work = Work.of_period(columns, scheme, dear, "orbit")
    return replace(made, _orbit=Followed.beside(work, notes, find, f"{float(max(scheme)) * 1000:g} fs", "nm"))


def _instead(system: Any) -> str:
    """What to ask where dense Hessians are too much."""
    ewald = any(
        isinstance(force, mm.NonbondedForce) and force.getNonbondedMethod() in EWALD for force in system.getForces()
    )
    sparse = "" if ewald or system.getNumConstraints() else ", sparse=True"
    return f"{_BANDS}{sparse}, or atoms=[...] and minimize=False"


_BANDS = "kickdrift.openmm.bands(...) for the fastest motions"


def _of_minimum(progress: Progress | bool) -> Progress | None:
    return shown(progress, "columns on the way to the minimum")


def _sparse(
    system: Any,
    engine: Engine,
    clocks: Mapping[int, Fraction],
    where: Doubles,
    minimize: bool,
    difference: float,
    topology: Any,
    progress: Progress | None,
    integrator: Any,
) -> System:
    """Two levels with sparse Hessians, at the place where OpenMM's minimizer ends."""
    if minimize:
        where = led_downhill(engine, where, tolerance=_REST)
    potentials: dict[str, tuple[Exact, Any]] = {}
    accuracy, size, pulls = 1e-12, 0.0, {}
    for step, groups in levels_of(clocks).items():
        name = ", ".join(f"group {group}" for group in groups)
        # Forces in doubles allow a tenth of the difference.
        matrix, error = _forcefield.hessian(system, groups, where, difference / 10, progress)
        # No entry of the diagonal exceeds the norm.
        diagonal = matrix.diagonal()
        known = error / max(float(np.abs(diagonal).max(initial=0.0)), 1e-300)
        accuracy = max(accuracy, usable(known, name, f"{difference:g} nm", engine.smoother))
        size = max(size, float((diagonal / np.repeat(engine.masses, 3)).max(initial=0.0)))
        pulls[name] = engine.force(mask_of(groups))(where)
        potentials[name] = (step, matrix)
    follow = "Orbits of so many atoms are not followed"
    notes = [*_notes(system, integrator, clocks), *unbalanced(pulls, size, engine.masses, "kJ/mol/nm", follow)]
    periodic = system.usesPeriodicBoundaryConditions()
    held = any(isinstance(force, mm.CustomExternalForce) for force in system.getForces())
    labels, elements, bonded = names_of(masses_of(system), topology, engine.moving)
    return System.from_hessians(
        engine.masses,
        potentials,
        positions=None if held else where,
        accuracy=accuracy,
        title=f"{engine.count} particles, ps and nm",
        time_unit="ps",
        labels=labels,
        elements=elements,
        bonded=bonded,
        notes=notes,
        periodic=periodic,
        keep_rigid=held,
    )


#: kJ/mol/nm: the forces at which OpenMM's minimizer may end; jumps at a cutoff keep it from less.
_REST = 0.1


@dataclass(frozen=True)
class _Later:
    """A system whose bands are looked for once it is known what is held, and how heavy hydrogens are."""

    system: Any
    asked: Mapping[str, Any]

    def advise(
        self, steps: str | Sequence[Any] = (), *, constraints: str | None, hmr: Exact | None, **rest: Any
    ) -> Advice:
        return bands(self.system, constraints=constraints, hmr=hmr, **self.asked).advise(steps, **rest)


def given(source: Any, steps: Any, made: Mapping[str, Any]) -> tuple[System | _Later, Any]:
    """The system of a ``System`` or a ``Simulation``, and the schemes asked about beside its own.

    It is asked for its bands where dense Hessians are too large, where they take long and no ``longest`` allows it, or
    where there are constraints and other than two levels with forces.
    """
    arguments = dict(made)
    if isinstance(steps, Mapping):
        arguments["steps"], steps = steps, ()
    if isinstance(source, app.Simulation):
        state = source.context.getState(getPositions=True)
        arguments = {"positions": state.getPositions(asNumpy=True), "topology": source.topology} | arguments
        if "steps" not in arguments:
            arguments.setdefault("integrator", source.integrator)
        source = source.system
    if not isinstance(source, mm.System):
        raise KickdriftError(
            "periods", type(source).__name__, "of OpenMM give a Simulation, or a System with positions="
        )
    if "positions" not in arguments:
        raise KickdriftError("positions", None, "give the positions of the particles, nm")
    plain = ("positions", "topology", "integrator", "steps", "minimize")
    asked: dict[str, Any] = {key: arguments[key] for key in plain if key in arguments}
    is_plain = arguments.keys() <= asked.keys() | {"progress", "longest"}
    most = LARGEST if "longest" in arguments else _DENSE
    if is_plain and (3 * len(moving_of(source)) > most or _is_held_fast(source, asked)):
        return _Later(source, asked), steps
    return system(source, arguments.pop("positions"), **arguments), steps


def _is_held_fast(system: Any, asked: Mapping[str, Any]) -> bool:
    """Whether there are constraints, and not two levels of forces on what they leave free: rigid water has no bonds."""
    if not system.getNumConstraints():
        return False
    levels = levels_of(clocks_of(system, asked.get("integrator"), asked.get("steps")))
    return len(levels) != 2 or not _terms_of(system, levels[min(levels)])


def _terms_of(system: Any, groups: Sequence[int]) -> int:
    """How many terms the forces of some groups have; a force that is not counted has some."""
    forces = [force for force in system.getForces() if force.getForceGroup() in groups and not is_bath(force)]
    return sum(len(_forcefield._terms(force)) if _forcefield.are_bonded([force]) else 1 for force in forces)


#: Dense Hessians of so many degrees of freedom are made unasked: of more, with PME, they take minutes to hours.
_DENSE = 1200


@dataclass(frozen=True)
class _Level:
    """The groups of one step: their mass-weighted Hessian, that on what constraints allow, its error, their force."""

    name: str
    step: Fraction
    full: Doubles
    matrix: Doubles
    error: float
    force: Doubles


def _measured(
    engine: Engine,
    clocks: Mapping[int, Fraction],
    at: tuple[Doubles, Sequence[Constraint], Sequence[int] | None],
    frame: Doubles,
    difference: float,
    progress: Progress | None,
) -> list[_Level]:
    where, constraints, chosen = at
    found = []
    for step, groups in levels_of(clocks).items():
        force = engine.force(mask_of(groups))
        full, error = hessian(force, where, engine.masses, difference, chosen, progress, rounding=engine.rounding)
        matrix, pull = full, force_at(force, where)
        if constraints:
            matrix = matrix + Held(engine.masses, constraints).curvature(pull, where, chosen)
        matrix = frame.T @ matrix @ frame
        name = ", ".join(f"group {group}" for group in groups)
        found.append(_Level(name, step, full, (matrix + matrix.T) / 2, error, pull))
    return found


def _unbalanced(
    masses: Doubles,
    measured: Sequence[_Level],
    frame: Doubles,
    chosen: Sequence[int] | None,
) -> list[str]:
    kept = np.arange(3 * len(masses)) if chosen is None else np.asarray(chosen)
    root = np.sqrt(np.repeat(masses, 3))[kept]
    # What constraints take up moves nothing, nor does the pull of a mesh at a box as a whole.
    along = {
        level.name: (frame @ (frame.T @ (level.force.ravel()[kept] / root)) * root).reshape(-1, 3) for level in measured
    }
    total = np.sum([level.matrix for level in measured], axis=0)
    follow = "Ask oscillations(...) for what grows about that orbit, as a run shows it"
    return unbalanced(along, norm(total), masses[kept[::3] // 3], "kJ/mol/nm", follow)


def _is_held(system: Any, where: Doubles, masses: Doubles, frame: Doubles, measured: Sequence[_Level]) -> bool:
    """Whether there are no rigid motions: an outer field holds the atoms."""
    moved = frame.T @ rigid_motions(where, masses, rotations=False)
    matrices = [level.matrix for level in measured]
    error = sum(level.error for level in measured)
    field = any(isinstance(force, mm.CustomExternalForce) for force in system.getForces())
    # The mesh of a box's Ewald sum knows places, a little.
    return field or (not system.usesPeriodicBoundaryConditions() and is_held(matrices, np.asarray(moved), error))


def oscillations(
    system: Any,
    positions: Any,
    *,
    integrator: Any = None,
    steps: Mapping[int, Any] | None = None,
    about: str = "orbit",
    minimize: bool = True,
    difference: float = DIFFERENCE,
    progress: Progress | bool = False,
    longest: float = LONGEST,
    resume: str | PathLike[str] | None = None,
) -> Monodromy:
    """Measure what small deviations do over a period, about the integrator's own periodic orbit: what a run shows.

    Bonded and nonbonded forces balance at a minimum, none vanishes there; so each slow kick displaces the atoms and the
    fast forces swing them back. The orbit of that is found by Newton's method, with Hessians at each kick. Constraints
    are held at each drift as RATTLE, SHAKE and SETTLE hold them, and deviations are those that they leave free.

    Parameters
    ----------
    system, positions, integrator, steps, minimize, difference
        As for :func:`system`.
    about : str
        ``"orbit"``, or ``"minimum"``: the fixed point of all forces together, good to some hundredths of a fs near the
        first unstable step, with rates good to 10 % there and worse beyond.
    progress : bool or callable
        A bar on standard error, in a log four lines for each Hessian on the way to the minimum and four for each step
        of Newton's method, with an estimate of the time; or a callback (done, in all), first for columns, then for the
        Hessians of half a period.
    longest : float
        Seconds: what would take longer, or more memory than there is, is refused before it is begun.
    resume : path, optional
        As for :func:`system`.

    Returns
    -------
    Monodromy
        About the orbit its ``verdict`` is proven for all Hessians within the accuracy of those measured; with held
        bonds where every kick is one of the fastest clock's. Rates are estimates. About the minimum :func:`system`
        gives what can be proven.

    Raises
    ------
    KickdriftError
        As :func:`system`; drifts too long for the constraints; an orbit that is not found, and at which outer step the
        one of shorter steps ends.

    Examples
    --------
    >>> import openmm
    >>> import kickdrift.openmm
    >>> springs, walls = openmm.System(), openmm.CustomExternalForce("200*(x^2+y^2+z^2)")
    >>> _ = springs.addParticle(1.0), walls.addParticle(0), springs.addForce(walls)
    >>> kickdrift.openmm.oscillations(springs, [[0, 0, 0]], steps={0: "1/100"}, about="minimum")
    Monodromy(about the minimum: stable, an estimate)
    """
    return _oscillations(
        system,
        positions,
        integrator,
        steps,
        about,
        minimize,
        difference,
        progress=progress,
        longest=longest,
        resume=resume,
    )


def _oscillations(
    system: Any,
    positions: Any,
    integrator: Any = None,
    steps: Mapping[int, Any] | None = None,
    about: str = "orbit",
    minimize: bool = True,
    difference: float = DIFFERENCE,
    unit: str | None = "ps",
    progress: Progress | bool = False,
    longest: float = LONGEST,
    resume: str | PathLike[str] | None = None,
) -> Monodromy:
    """:func:`oscillations`; without a ``unit`` an orbit not found at once is not followed from shorter steps."""
    difference = positive("difference", difference)
    clocks = clocks_of(system, integrator, steps)
    where, levels = positions_of(positions, system), levels_of(clocks)
    engine = resumed(engine_of(system), where, resume)
    held = Held(engine.masses, constraints_of(system))
    # The mean of the groups, each of which is asked alone.
    dear = sum(seconds_of(engine.force(mask_of(groups)), where) for groups in levels.values()) / len(levels)
    work = Work.of_period(3 * engine.count, list(levels), dear, about, SOUGHT if minimize else 0)
    work.begin(longest, progress is True, _BANDS)
    if minimize:
        where = at_rest(engine, where, held.distances, difference, progress=_of_minimum(progress))[0]
    # Onto the held distances, to rounding: engines keep them to their tolerance.
    where = held.drift(where, np.zeros(where.size), 1.0)[0]
    forces = {str(groups): engine.force(mask_of(groups)) for groups in levels.values()}
    told = shown(progress, "Hessians of half a period")
    field = any(isinstance(force, mm.CustomExternalForce) for force in system.getForces())
    return monodromy(
        forces,
        list(levels),
        where,
        held,
        difference,
        about,
        unit,
        told,
        time_unit="ps",
        is_boxed=engine.is_boxed,
        has_field=field,
        has_mesh=engine.is_boxed,
    )


def bands(
    system: Any,
    positions: Any,
    *,
    topology: Any = None,
    integrator: Any = None,
    steps: Mapping[int, Any] | None = None,
    minimize: bool = True,
    difference: float | None = None,
    constraints: str | None = None,
    hmr: Exact | None = None,
) -> Bands:
    """Find the shortest period of each level of forces: of any number of atoms, PME and constraints.

    A level of bonded terms alone has the modes of each molecule, all of them, by the terms' formulas: no probability
    stands in the way, and they have names. Large molecules are seen through windows along their bonds, which leave a
    part in a thousand of the stiffness unknown. Lanczos' method asks for all other forces along directions in which all
    atoms move at once; of more than a hundred atoms on OpenMM's CPU platform, in single precision.

    Parameters
    ----------
    system, positions, topology, integrator, steps
        As for :func:`system`; any number of levels, one step for all forces, too.
    minimize : bool
        Go to where OpenMM's minimizer ends after some hundred steps, in a copy.
    difference : float, optional
        How far, nm, an atom moves at most: 0.001 unless given in single precision, where less is rounding. Twice as far
        tells the error.
    constraints, hmr : optional
        ``"h-bonds"``: bonds of hydrogens (up to 1.1 u) are held, too; and hydrogens of this mass, u, taken from the
        atoms that they are bonded to.

    Returns
    -------
    Bands
        Estimates: its ``advise`` says which steps are safe with them.

    Raises
    ------
    KickdriftError
        As :func:`system`.

    Examples
    --------
    >>> import openmm
    >>> import kickdrift.openmm
    >>> springs, walls = openmm.System(), openmm.CustomExternalForce("200*(x^2+y^2+z^2)")
    >>> _ = springs.addParticle(1.0), walls.addParticle(0), springs.addForce(walls)
    >>> found = kickdrift.openmm.bands(springs, [[0, 0, 0]], steps={0: "1/100"}, minimize=False)
    >>> round(found.levels[0].period), found.advise().status
    (314, 'safe')
    """
    clocks = clocks_of(system, integrator, steps)
    given = positions_of(positions, system)
    before, system = system, changed(system, topology, given, constraints, hmr)
    is_small = given.size <= FOLLOWED
    engine = engine_of(system, "CPU" if "CPU" in platforms() and not is_small else "Reference")
    usual = DIFFERENCE if is_small else WIDE
    difference = usual if difference is None else positive("difference", difference)
    where, held = given, Held(engine.masses, constraints_of(system))
    notes = _notes(system, integrator, clocks)
    if minimize:
        where, how = near_minimum(engine, where, held, difference, is_small)
        notes.append(how)
    atoms = atoms_of(before, topology, where, engine.masses)
    found = [_band(system, engine, held, where, level, atoms, difference) for level in levels_of(clocks).items()]
    return Bands(tuple(found), tuple(notes))


#: Products of Lanczos' method: of stored matrices, which cost little, and of forces.
_STORED, _ASKED = 300, 40


def _band(
    system: Any,
    engine: Engine,
    held: Held,
    where: Doubles,
    level: tuple[Fraction, list[int]],
    atoms: Atoms,
    difference: float,
) -> Band:
    """The shortest period of the groups of one step."""
    step, groups = level
    name = " + ".join(f"group {group}" for group in groups)
    force = engine.force(mask_of(groups))
    forces_of_level = [
        each for each in system.getForces() if each.getForceGroup() in groups and not moves_nothing(each)
    ]
    pairs = (each for each in system.getForces() if isinstance(each, mm.NonbondedForce))
    reciprocal = (each.getReciprocalSpaceForceGroup() for each in pairs)
    bent, error = _sparse_held.curvature(held, where, force(where)), 0.0
    if known := _forcefield.are_bonded(forces_of_level) and not any(group in groups for group in reciprocal):
        matrix, error = _forcefield.hessian(system, groups, where, DIFFERENCE / 10)
        matrix, error = _sparse_held.weighted(matrix, held.root) + bent, error / float(engine.masses.min())
        free = _covered.projected(matrix, held, where)
        modes = None if free is None else _covered.modes(free, atoms.kinds())
        if modes is not None:
            who = f"{modes.molecules:,} molecule{'s' * (modes.molecules != 1)}"
            looked = f"all {where.size - len(held.distances):,} modes of {who}"
            if modes.windows:
                looked += f", the large ones through {modes.windows} windows (counts are rounded)"
            # What is dropped as rounding: no more than that in each entry of a row.
            row = int(np.diff(free.indptr).max(initial=0))
            error += _covered.ROUNDED * row * float(np.abs(matrix.data).max(initial=0.0)) if held.distances else 0.0
            most = modes.largest + modes.beyond + error if modes.molecules else 0.0
            told = groups_of(modes, atoms)
            return Band(name, step, modes.largest, most, "", 0, looked, told[0].name if told else "", told)
    onto = _sparse_held.projection(held, where)
    product, steps, forces = _lanczos.by_differences(force, where, held.root, difference), _ASKED, 2
    if known:
        product, steps, forces = (lambda vector: np.asarray((matrix - bent) @ vector)), _STORED, 0

    def apply(vector: Doubles) -> Doubles:
        vector = onto(vector)
        return onto(product(vector) + bent @ vector)

    found = _lanczos.top(apply, where.size, steps)
    if forces:
        wide = _lanczos.by_differences(force, where, held.root, 2 * difference)
        error = float(np.linalg.norm(onto(wide(found.vector) - product(found.vector))))
    moving = np.linalg.norm(found.vector.reshape(-1, 3), axis=1)
    who = ", ".join(atoms.labels[n] for n in np.argsort(-moving)[:2] if moving[n] > moving.max() / 10)
    looked = "the Hessian of all bonded terms"
    motion = atoms.motions(range(engine.count), [found.vector[None]], [True] * engine.count)[0] or ""
    return Band(name, step, found.found, found.most + error, who, forces * steps, looked, motion)


def _notes(system: Any, integrator: Any, clocks: Mapping[int, Fraction]) -> list[str]:
    notes = [f"{force.getName()} is left out" for force in system.getForces() if is_bath(force)]
    if integrator is not None:
        idle = sorted(clocks_of_integrator(integrator, set(clocks)).keys() - clocks.keys())
        notes += [f"group {group} of the integrator has no force" for group in idle]
    if integrator is not None and "Langevin" in type(integrator).__name__:
        notes.append("friction and noise of the integrator are left out")
    if sites := system.getNumParticles() - len(moving_of(system)):
        # tests/test_openmm.py has the measurement.
        late = (
            ", as on CUDA, HIP and OpenCL. On OpenMM's Reference and CPU platforms an MTSIntegrator moves them once an "
            "outer step only: that is another map, which grows at steps where this one is stable (three waters of "
            "TIP4P-Ew at 0.34/ps with 2 fs)"
        )
        plain = len(set(clocks.values())) == 1
        notes.append(f"{sites} virtual sites follow their atoms at each drift{'' if plain else late}")
    if system.getNumConstraints():
        notes.append(
            f"{system.getNumConstraints()} constraints: deviations along them are projected out, RATTLE assumed"
        )
    return notes


def shapes(
    system: Any,
    positions: Any,
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
    system : openmm.System
        Not changed.
    positions : Quantity or array, shape (n, 3), nm
        At a minimum or near one.
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
    A Morse bond of two atoms:

    >>> import openmm
    >>> import kickdrift.openmm
    >>> system, bond = openmm.System(), openmm.CustomBondForce("485.72*(1-exp(-22.87*(r-0.1)))^2")
    >>> added = [system.addParticle(mass) for mass in (15.999, 1.008)], bond.addBond(0, 1), system.addForce(bond)
    >>> shape = kickdrift.openmm.shapes(system, [[0, 0, 0], [0.1, 0, 0]])[0]
    >>> round(shape.period, 1)
    8.6
    """
    engine, where = engine_of(system), positions_of(positions, system)
    place = {int(n): k for k, n in enumerate(engine.moving)}
    ends = (system.getConstraintParameters(n)[:2] for n in range(system.getNumConstraints()))
    held = {frozenset(place[n] for n in pair) for pair in ends}
    own = None if pairs is None else [(place.get(a, -1), place.get(b, -1)) for a, b in pairs]
    names = [name.replace(" ", "") for name in names_of(masses_of(system), None, engine.moving)[0]]
    found = scanned(
        engine.energy, where, engine.masses, names, held=held, pairs=own, temperature=temperature, count=count
    )
    first, second = ([int(engine.moving[shape.pair[k]]) for shape in found] for k in (0, 1))
    return [replace(shape, pair=pair) for shape, pair in zip(found, zip(first, second, strict=True), strict=True)]
