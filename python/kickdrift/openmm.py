"""Systems of OpenMM: its force groups, masses and integrators, as they are run.

Units: lengths in nm, times in ps, energies in kJ/mol, so stiffness over mass is 1/ps². A step is exact: a text with its
unit as ``"0.5fs"``, a quantity of OpenMM, which is read as it is printed (4.4 fs is 22/5 fs, whatever the double), or a
number of ps. Of an integrator's step, a double, the simplest rational is taken that rounding makes it of.

What decides is the dynamics of small deviations. Friction and noise of Langevin integrators, barostats and thermostats
are left out, and ``notes`` say so.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from os import PathLike
from typing import Any

import numpy as np
import numpy.typing as npt

from kickdrift._advise import Advice
from kickdrift._bands import Atoms, Band, Bands
from kickdrift._errors import KickdriftError, needs
from kickdrift._held import Held
from kickdrift._hessians import (
    FOLLOWED,
    LARGEST,
    LONGEST,
    SOUGHT,
    Followed,
    Force,
    Monodromy,
    Work,
    cooled,
    free,
    hessian,
    minimum,
    monodromy,
    seconds_of,
    seen,
    unbalanced,
    usable,
)
from kickdrift._journal import Journal
from kickdrift._numbers import Exact, doubles, duration, rational, simplest
from kickdrift._progress import Progress, shown
from kickdrift._rigid import Doubles, is_held, norm, rigid_motions
from kickdrift._system import System

try:
    import openmm as mm
    from openmm import app, unit
except ImportError:
    raise needs("openmm") from None

__all__ = ["bands", "oscillations", "system"]

#: The difference of positions, nm: force fields are smooth on this length.
DIFFERENCE = 1e-4

#: The same where forces come in single precision.
WIDE = 1e-3


_Constraint = tuple[int, int, float]


#: Forces that end at a cutoff.
_CUT = (mm.NonbondedForce, mm.CustomNonbondedForce)


@dataclass(frozen=True)
class _Engine:
    """A context for forces by group, of the particles that move by themselves: virtual sites follow these.

    ``moving`` are the numbers of those particles in OpenMM's system; all, where there are no sites. ``journal`` keeps
    what was computed, where something does.
    """

    context: Any
    masses: Doubles
    moving: npt.NDArray[np.intp]
    journal: Journal | None = None

    @property
    def count(self) -> int:
        """The particles that move by themselves."""
        return len(self.moving)

    @cached_property
    def sites(self) -> npt.NDArray[np.intp]:
        """The numbers of the virtual sites."""
        return np.setdiff1d(np.arange(self.context.getSystem().getNumParticles()), self.moving)

    def place(self, positions: Doubles, context: Any = None) -> None:
        """Set the positions of the particles that move, and the sites to where they follow them."""
        context = context or self.context
        if not len(self.sites):
            context.setPositions(positions)
            return
        every = np.zeros((len(self.moving) + len(self.sites), 3))
        every[self.moving] = positions
        context.setPositions(every)
        # OpenMM moves no site by itself when positions are set.
        context.computeVirtualSites()

    def placed(self, positions: Doubles) -> Doubles:
        """Where all particles are while those that move are here."""
        if not len(self.sites):
            return positions
        self.place(positions)
        return np.array(self.context.getState(getPositions=True).getPositions(asNumpy=True)._value)

    @cached_property
    def _shared(self) -> Callable[[Doubles, Doubles], Doubles]:
        """Forces on all particles at positions of those that move, as forces on these: what acts on a site acts on its
        parents, as OpenMM has it."""
        own, pull = mm.XmlSerializer.clone(self.context.getSystem()), mm.CustomExternalForce("-(fx*x+fy*y+fz*z)")
        for n in reversed(range(own.getNumForces())):
            own.removeForce(n)
        for axis in "xyz":
            pull.addPerParticleParameter(f"f{axis}")
        for n in self.sites:
            pull.addParticle(int(n), [0.0, 0.0, 0.0])
        own.addForce(pull)
        context = mm.Context(own, mm.VerletIntegrator(0.001), mm.Platform.getPlatformByName("Reference"))
        engine = _Engine(context, self.masses, self.moving)

        def of(positions: Doubles, forces: Doubles) -> Doubles:
            for k, n in enumerate(self.sites):
                pull.setParticleParameters(k, int(n), list(forces[n]))
            pull.updateParametersInContext(context)
            return forces[self.moving] + engine.force(-1)(positions)

        return of

    def shared(self, positions: Doubles, forces: Doubles) -> Doubles:
        """The forces on the particles that move by themselves, of forces on all."""
        return self._shared(positions, forces) if len(self.sites) else forces

    @cached_property
    def rounding(self) -> float:
        """The unit roundoff of forces in single precision, as with mixed, which only adds up in more; 0 of doubles."""
        platform = self.context.getPlatform()
        known = "Precision" in platform.getPropertyNames()
        precision = platform.getPropertyValue(self.context, "Precision") if known else platform.getName()
        return 0.0 if precision in ("Reference", "double") else 2.0**-24

    def exactly(self, where: Doubles, difference: float) -> tuple[Doubles, float]:
        """Positions, and a difference from them, that single precision rounds no further: nearly those given."""
        if not self.rounding:
            return where, difference
        largest = float(np.abs(where).max(initial=0.0)) + 3 * difference
        grid = self.rounding * 2.0 ** np.ceil(np.log2(largest))
        return np.round(where / grid) * grid, max(1, round(difference / grid)) * grid

    @cached_property
    def is_boxed(self) -> bool:
        """Whether translations move nothing, but for the mesh of an Ewald sum."""
        system = self.context.getSystem()
        field = any(isinstance(force, mm.CustomExternalForce) for force in system.getForces())
        return bool(system.usesPeriodicBoundaryConditions()) and not field

    @cached_property
    def smoother(self) -> str:
        """What makes a jump at a cutoff smaller. OpenMM leaves the switching function out of LJPME, whatever is set."""
        own = [own.getNonbondedMethod() for own in self.context.getSystem().getForces() if isinstance(own, _CUT)]
        takes = set(own) - {mm.NonbondedForce.NoCutoff, mm.NonbondedForce.LJPME}
        tuned = "a smaller Ewald tolerance or a longer cutoff"
        if mm.NonbondedForce.LJPME in own and not takes:
            return f"{tuned} (OpenMM takes no switching function with LJPME, but with PME)"
        return f"a switching function, {tuned}"

    def force(self, groups: int) -> _Forces:
        """The forces of some groups, bits of a mask."""
        return _Forces(self, groups)

    def energy(self, where: Doubles) -> float:
        """Of all forces, kJ/mol."""
        self.place(where)
        return float(self.context.getState(getEnergy=True).getPotentialEnergy()._value)

    @cached_property
    def cuts(self) -> dict[int, list[Any]]:
        """What is cut off of each group: pairs whose forces are known."""
        from kickdrift import _forcefield

        found: dict[int, list[Any]] = {}
        for force in self.context.getSystem().getForces():
            if isinstance(force, _CUT) and (own := _forcefield.cut(force, self.context)) is not None:
                found.setdefault(force.getForceGroup(), []).append(own)
        return found


@dataclass(frozen=True)
class _Forces:
    """The forces of some groups, bits of a mask, at positions in nm, in kJ/mol/nm."""

    engine: _Engine
    groups: int

    def __call__(self, positions: Doubles) -> Doubles:
        self.engine.place(positions)
        state = self.engine.context.getState(getForces=True, groups=self.groups)
        return np.asarray(state.getForces(asNumpy=True)._value, dtype=np.float64)[self.engine.moving]

    @property
    def journal(self) -> Journal | None:
        return self.engine.journal and self.engine.journal.of("forces", float(self.groups))

    def smooth(self, positions: Doubles, reach: float) -> Force:
        """With each pair kept on that side of the cutoff on which it is at these positions."""
        acting = [own for group, cuts in self.engine.cuts.items() if self.groups >> group & 1 for own in cuts]
        if not acting:
            return self
        every, about = self.engine.placed(positions), (positions, reach)
        reach *= _stretch(self.engine.context.getSystem(), every)
        kept = [found for own in acting if (found := own.kept(every, reach)) is not None]
        return _Smooth(self, kept, about) if kept else self


@dataclass(frozen=True)
class _Smooth:
    """The forces of some groups with pairs kept on a side of the cutoff, while they are near it: ``about`` which
    positions, and within which reach."""

    force: _Forces
    kept: Sequence[Any]
    about: tuple[Doubles, float]

    @property
    def journal(self) -> Journal | None:
        own = self.force.journal
        return own and own.of("smooth", *self.about)

    def __call__(self, positions: Doubles) -> Doubles:
        engine = self.force.engine
        every = engine.placed(positions)
        added = np.sum([own(every) for own in self.kept], axis=0)
        return np.asarray(self.force(positions) + (engine.shared(positions, added) if added.any() else 0.0))

    def note(self, positions: Doubles) -> str | None:
        """What to know of a minimum of this where it is none of the forces as they are: pairs beyond their side."""
        every = self.force.engine.placed(positions)
        crossed = [own.crossed(every) for own in self.kept]
        pairs = [pair for pairs, _ in crossed for pair in pairs]
        if not pairs:
            return None
        off = max(float(own.max(initial=0.0)) for _, own in crossed)
        jump = float(np.linalg.norm(self(positions) - self.force(positions), axis=1).max())
        who = f"{len(pairs)} pair{'s' * (len(pairs) > 1)} (as particles {pairs[0][0]} and {pairs[0][1]})"
        return (
            f"forces jump at a cutoff, and no minimum of them as they are was found near: {who} kept on one side of it "
            f"come to rest on the other, up to {off:.1g} nm beyond it, where forces jump by up to {jump:.2g} "
            "kJ/mol/nm; the positions are the minimum with these kept so. The jump is smaller with "
            f"{self.force.engine.smoother}"
        )


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
        A bar on standard error, in a log four lines for each step, behind what it will take; or what is called with the
        columns done and the columns in all, for each step.
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
        Its ``accuracy`` is the largest estimated error of a Hessian over its norm, its ``notes`` say what is left out,
        and whether the groups' own forces vanish at the positions: where they do not, a run is not about them.
        Constraints are met by RATTLE: deviations along them are projected out, the curvature they bring is kept. Rigid
        motions are projected out: translations and rotations, in a periodic box translations alone, none among atoms
        that stand still or in an outer field. Virtual sites follow their atoms at each drift: only what has a mass has
        degrees of freedom, and positions are those of these particles.

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
    >>> own, bond = openmm.System(), openmm.HarmonicBondForce()
    >>> walls = openmm.CustomExternalForce("5*(x^2+y^2+z^2)")
    >>> walls.setForceGroup(1)
    >>> for atom in range(2):
    ...     _ = own.addParticle(1.0), walls.addParticle(atom)
    >>> _ = bond.addBond(0, 1, 0.0, 1000.0), own.addForce(bond), own.addForce(walls)
    >>> found = kickdrift.openmm.system(own, [[0, 0, 0], [0, 0, 0]], steps={0: "1/200", 1: "1/50"})
    >>> found.decide().stable
    True
    """
    clocks = _clocks(system, integrator, steps)
    where = _positions(positions, system)
    engine = _resumed(_engine(system, platform), where, resume)
    constraints = _constraints(system)
    places = None if atoms is None else _places(system, atoms)
    if difference is None:
        difference = WIDE if engine.rounding else DIFFERENCE
    if sparse and engine.rounding:
        raise KickdriftError("platform", platform, "computes in single precision: sparse=True needs Reference")
    if sparse:
        if constraints or atoms is not None:
            remedy = "has no sparse Hessians with constraints or some atoms alone: leave sparse=True out"
            raise KickdriftError("system", f"{len(constraints)} constraints", remedy)
        return _sparse(system, engine, clocks, where, minimize, difference, topology, shown(progress), integrator)
    columns = 3 * (engine.count if places is None else len(places))
    dear, sought = seconds_of(engine.force(-1), where), SOUGHT if minimize else 0
    work = Work(columns, len(_levels(clocks)), dear, sought)
    work.begin(longest, progress is True, _instead(system))
    chosen = None if places is None else [3 * atom + axis for atom in places for axis in range(3)]
    if places is not None:
        constraints = [own for own in constraints if own[0] in places or own[1] in places]
    notes = _notes(system, integrator, clocks)
    if minimize and engine.rounding:
        where = _relaxed(engine, where, chosen)
        place = "the positions are where OpenMM's minimizer stopped, near a minimum and not at it"
        notes.append(f"forces of the {platform} platform are in single precision: {place}")
    elif minimize:
        where, told = _at_rest(engine, where, constraints, difference, chosen, _of_minimum(progress))
        notes += told
    where, difference = engine.exactly(where, difference)
    held = Held(engine.masses, constraints)
    frame = held.frame(where, chosen)
    measured = _measured(engine, clocks, (where, constraints, chosen), frame, difference, shown(progress))
    moving = free(held, where, chosen, engine.is_boxed and chosen is None)
    notes += _unbalanced(engine.masses, measured, moving, chosen)
    accuracy = max(seen(own.matrix, own.error, own.name, f"{difference:g} nm", engine.smoother) for own in measured)
    kept = np.arange(engine.count) if places is None else np.asarray(places, dtype=np.intp)
    title = f"{engine.count} particles, ps and nm"
    if chosen is not None:
        notes.append(f"only {len(kept)} of {engine.count} atoms move")
        if constraints:
            # Distances to atoms that stand still: in coordinates along the constraints, which have no names.
            levels = {own.name: (own.step, own.matrix) for own in measured}
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
    labels, elements, bonded = _named(_masses(system), topology, engine.moving[kept])
    made = System.from_hessians(
        engine.masses[kept],
        {own.name: (own.step, own.full * np.outer(root, root)) for own in measured},
        positions=where[kept],
        accuracy=accuracy,
        title=title,
        time_unit="ps",
        labels=labels,
        elements=elements,
        bonded=bonded,
        forces={own.name: own.force[kept] for own in measured},
        constraints=[own[:2] for own in constraints] or None,
        notes=notes,
        periodic=system.usesPeriodicBoundaryConditions(),
        keep_rigid=keep,
    )
    if chosen is not None or engine.rounding:
        return made

    def find() -> Monodromy:
        # Where no orbit is found at once, others are not sought unasked: that takes ten times as long.
        return _oscillations(system, where, integrator, steps, "orbit", False, difference, unit=None)

    own = list(_levels(clocks))
    work = Work.of_period(columns, own, dear, "orbit")
    return replace(made, _orbit=Followed.beside(work, notes, find, f"{float(max(own)) * 1000:g} fs", "nm"))


def _instead(system: Any) -> str:
    """What to ask where dense Hessians are too much."""
    ewald = any(isinstance(own, mm.NonbondedForce) and own.getNonbondedMethod() in _EWALD for own in system.getForces())
    sparse = "" if ewald or system.getNumConstraints() else ", sparse=True"
    return f"{_BANDS}{sparse}, or atoms=[...] and minimize=False"


_BANDS = "kickdrift.openmm.bands(...) for the fastest motions"


#: Sums whose forces have no cutoff.
_EWALD = (mm.NonbondedForce.Ewald, mm.NonbondedForce.PME, mm.NonbondedForce.LJPME)


def _of_minimum(progress: Progress | bool) -> Progress | None:
    return shown(progress, "columns on the way to the minimum")


def _sparse(
    system: Any,
    engine: _Engine,
    clocks: Mapping[int, Fraction],
    where: Doubles,
    minimize: bool,
    difference: float,
    topology: Any,
    progress: Progress | None,
    integrator: Any,
) -> System:
    """Two levels with sparse Hessians, at the place where OpenMM's minimizer ends."""
    from kickdrift import _forcefield

    if minimize:
        where = _led_downhill(engine, where, tolerance=_REST)
    potentials: dict[str, tuple[Exact, Any]] = {}
    accuracy, size, pulls = 1e-12, 0.0, {}
    for step, groups in _levels(clocks).items():
        name = ", ".join(f"group {group}" for group in groups)
        # Forces in doubles allow a tenth of the difference.
        matrix, error = _forcefield.hessian(system, groups, where, difference / 10, progress)
        # No entry of the diagonal exceeds the norm.
        diagonal = matrix.diagonal()
        known = error / max(float(np.abs(diagonal).max(initial=0.0)), 1e-300)
        accuracy = max(accuracy, usable(known, name, f"{difference:g} nm", engine.smoother))
        size = max(size, float((diagonal / np.repeat(engine.masses, 3)).max(initial=0.0)))
        pulls[name] = engine.force(_mask(groups))(where)
        potentials[name] = (step, matrix)
    follow = "Orbits of so many atoms are not followed"
    notes = [*_notes(system, integrator, clocks), *unbalanced(pulls, size, engine.masses, "kJ/mol/nm", follow)]
    periodic = system.usesPeriodicBoundaryConditions()
    held = any(isinstance(force, mm.CustomExternalForce) for force in system.getForces())
    labels, elements, bonded = _named(_masses(system), topology, engine.moving)
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


def _named(
    masses: Doubles, topology: Any, kept: npt.NDArray[np.intp]
) -> tuple[list[str], list[str], list[tuple[int, int]] | None]:
    """What answers call these atoms, their elements, and who is bonded to whom; what is not known is empty or None."""
    if topology is None:
        return [f"{_symbol(masses[n])} {n}" for n in kept], [], None
    atoms = list(topology.atoms())
    if len(atoms) != len(masses):
        remedy = f"the system has {len(masses)} particles: give the topology that it was made of"
        raise KickdriftError("topology", f"{len(atoms)} atoms", remedy)
    own = [atoms[n] for n in kept]
    labels = [f"{atom.name} {atom.residue.name} {atom.residue.id}" for atom in own]
    elements = [atom.element.symbol if atom.element is not None else "atom" for atom in own]
    place = {n: k for k, n in enumerate(kept)}
    pairs = [(place.get(bond[0].index), place.get(bond[1].index)) for bond in topology.bonds()]
    bonded = [(i, j) for i, j in pairs if i is not None and j is not None]
    # A topology without bonds knows none: distances tell then.
    return labels, elements, bonded or None


@dataclass(frozen=True)
class _Later:
    """A system whose bands are looked for once it is known what is held, and how heavy hydrogens are."""

    system: Any
    asked: Mapping[str, Any]

    def advise(
        self, steps: str | Sequence[Any] = (), *, constraints: str | None, hmr: Exact | None, **rest: Any
    ) -> Advice:
        return bands(self.system, constraints=constraints, hmr=hmr, **self.asked).advise(steps, **rest)


def given(own: Any, steps: Any, made: Mapping[str, Any]) -> tuple[System | _Later, Any]:
    """The system of a ``System`` or a ``Simulation``, and the schemes asked about beside its own.

    It is asked for its bands where dense Hessians are too large, where they take long and no ``longest`` allows it, or
    where there are constraints and other than two levels with forces.
    """
    arguments = dict(made)
    if isinstance(steps, Mapping):
        arguments["steps"], steps = steps, ()
    if isinstance(own, app.Simulation):
        state = own.context.getState(getPositions=True)
        arguments = {"positions": state.getPositions(asNumpy=True), "topology": own.topology} | arguments
        if "steps" not in arguments:
            arguments.setdefault("integrator", own.integrator)
        own = own.system
    if not isinstance(own, mm.System):
        raise KickdriftError("periods", type(own).__name__, "of OpenMM give a Simulation, or a System with positions=")
    if "positions" not in arguments:
        raise KickdriftError("positions", None, "give the positions of the particles, nm")
    plain = ("positions", "topology", "integrator", "steps", "minimize")
    asked: dict[str, Any] = {key: arguments[key] for key in plain if key in arguments}
    is_plain = arguments.keys() <= asked.keys() | {"progress", "longest"}
    most = LARGEST if "longest" in arguments else _DENSE
    if is_plain and (3 * len(_moving(own)) > most or _is_held_fast(own, asked)):
        return _Later(own, asked), steps
    return system(own, arguments.pop("positions"), **arguments), steps


def _is_held_fast(own: Any, asked: Mapping[str, Any]) -> bool:
    """Whether there are constraints, and not two levels of forces on what they leave free: rigid water has no bonds."""
    if not own.getNumConstraints():
        return False
    levels = _levels(_clocks(own, asked.get("integrator"), asked.get("steps")))
    return len(levels) != 2 or not _terms_of(own, levels[min(levels)])


def _terms_of(own: Any, groups: Sequence[int]) -> int:
    """How many terms the forces of some groups have; a force that is not counted has some."""
    from kickdrift import _forcefield

    forces = [force for force in own.getForces() if force.getForceGroup() in groups and not _is_bath(force)]
    return sum(len(_forcefield._terms(force)) if _forcefield.are_bonded([force]) else 1 for force in forces)


#: Dense Hessians of so many degrees of freedom are made unasked: of more, with PME, they take minutes to hours.
_DENSE = 1200


def _symbol(mass: float) -> str:
    """The element of this mass; heavy hydrogens and atoms that gave them mass have none."""
    element = app.Element.getByMass(mass)
    near = element is not None and abs(element.mass._value - mass) < _ISOTOPES
    return str(element.symbol) if near else "atom"


#: How far, u, force fields' masses are from those of elements.
_ISOTOPES = 0.02


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
    engine: _Engine,
    clocks: Mapping[int, Fraction],
    at: tuple[Doubles, Sequence[_Constraint], Sequence[int] | None],
    frame: Doubles,
    difference: float,
    progress: Progress | None,
) -> list[_Level]:
    where, constraints, chosen = at
    found = []
    for step, groups in _levels(clocks).items():
        force = engine.force(_mask(groups))
        full, error = hessian(force, where, engine.masses, difference, chosen, progress, rounding=engine.rounding)
        matrix = full
        if constraints:
            matrix = matrix + Held(engine.masses, constraints).curvature(force(where), where, chosen)
        matrix = frame.T @ matrix @ frame
        name = ", ".join(f"group {group}" for group in groups)
        found.append(_Level(name, step, full, (matrix + matrix.T) / 2, error, force(where)))
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
    along = {own.name: (frame @ (frame.T @ (own.force.ravel()[kept] / root)) * root).reshape(-1, 3) for own in measured}
    total = np.sum([own.matrix for own in measured], axis=0)
    follow = "Ask oscillations(...) for what grows about that orbit, as a run shows it"
    return unbalanced(along, norm(total), masses[kept[::3] // 3], "kJ/mol/nm", follow)


def _is_held(system: Any, where: Doubles, masses: Doubles, frame: Doubles, measured: Sequence[_Level]) -> bool:
    """Whether there are no rigid motions: an outer field holds the atoms."""
    moved = frame.T @ rigid_motions(where, masses, rotations=False)
    total = np.sum([own.matrix for own in measured], axis=0)
    error = sum(own.error for own in measured)
    field = any(isinstance(force, mm.CustomExternalForce) for force in system.getForces())
    # The mesh of a box's Ewald sum knows places, a little.
    return field or (not system.usesPeriodicBoundaryConditions() and is_held(total, np.asarray(moved), error))


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
        of Newton's method, behind what it will take; or what is called with the columns, and then with the Hessians of
        half a period, that are done and that there are in all.
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
    >>> own, walls = openmm.System(), openmm.CustomExternalForce("200*(x^2+y^2+z^2)")
    >>> _ = own.addParticle(1.0), walls.addParticle(0), own.addForce(walls)
    >>> kickdrift.openmm.oscillations(own, [[0, 0, 0]], steps={0: "1/100"}, about="minimum")
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
    clocks = _clocks(system, integrator, steps)
    where, levels = _positions(positions, system), _levels(clocks)
    engine = _resumed(_engine(system), where, resume)
    held = Held(engine.masses, _constraints(system))
    # The mean of the groups, each of which is asked alone.
    dear = sum(seconds_of(engine.force(_mask(own)), where) for own in levels.values()) / len(levels)
    work = Work.of_period(3 * engine.count, list(levels), dear, about, SOUGHT if minimize else 0)
    work.begin(longest, progress is True, _BANDS)
    if minimize:
        where = _minimized(engine, where, held.distances, difference, progress=_of_minimum(progress))
    # Onto the held distances, to rounding: engines keep them to their tolerance.
    where = held.drift(where, np.zeros(where.size), 1.0)[0]
    forces = {str(groups): engine.force(_mask(groups)) for groups in levels.values()}
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
    >>> own, walls = openmm.System(), openmm.CustomExternalForce("200*(x^2+y^2+z^2)")
    >>> _ = own.addParticle(1.0), walls.addParticle(0), own.addForce(walls)
    >>> found = kickdrift.openmm.bands(own, [[0, 0, 0]], steps={0: "1/100"}, minimize=False)
    >>> round(found.levels[0].period), found.advise().status
    (314, 'safe')
    """
    clocks = _clocks(system, integrator, steps)
    given = _positions(positions, system)
    before, system = system, _changed(system, topology, given, constraints, hmr)
    is_small = given.size <= FOLLOWED
    engine = _engine(system, "CPU" if "CPU" in _platforms() and not is_small else "Reference")
    difference = difference or (DIFFERENCE if is_small else WIDE)
    where, held = given, Held(engine.masses, _constraints(system))
    notes = _notes(system, integrator, clocks)
    if minimize:
        where, how = _near_minimum(engine, where, held, difference, is_small)
        notes.append(how)
    atoms = _atoms(before, topology, where, engine.masses)
    found = [_band(system, engine, held, where, own, atoms, difference) for own in _levels(clocks).items()]
    return Bands(tuple(found), tuple(notes))


def _near_minimum(
    engine: _Engine, where: Doubles, held: Held, difference: float, is_small: bool
) -> tuple[Doubles, str]:
    """The minimum of few atoms, or where OpenMM's minimizer ends; and in words which."""
    if is_small:
        try:
            return _minimized(engine, where, held.distances, difference), "at the minimum beside the positions"
        except KickdriftError:
            # As where pairs cross a cutoff: no stiffness hangs on the last digits of a place.
            pass
    where = _led_downhill(engine, where, maxIterations=_MINIMIZED)
    return where, f"at the positions after {_MINIMIZED} steps of OpenMM's minimizer at most, near a minimum, not at one"


#: Steps of OpenMM's minimizer: bonds and clashes have relaxed then, and no stiffness hangs on the rest.
_MINIMIZED = 200

#: Products of Lanczos' method: of stored matrices, which cost little, and of forces.
_STORED, _ASKED = 300, 40


def _band(
    system: Any,
    engine: _Engine,
    held: Held,
    where: Doubles,
    level: tuple[Fraction, list[int]],
    atoms: Atoms,
    difference: float,
) -> Band:
    """The shortest period of the groups of one step."""
    from kickdrift import _bands, _covered, _forcefield

    step, groups = level
    name = " + ".join(f"group {group}" for group in groups)
    force = engine.force(_mask(groups))
    own = [each for each in system.getForces() if each.getForceGroup() in groups and not _moves_nothing(each)]
    pairs = (each for each in system.getForces() if isinstance(each, mm.NonbondedForce))
    reciprocal = (each.getReciprocalSpaceForceGroup() for each in pairs)
    bent, error = _bands.curvature(held, where, force(where)), 0.0
    if known := _forcefield.are_bonded(own) and not any(group in groups for group in reciprocal):
        matrix, error = _forcefield.hessian(system, groups, where, DIFFERENCE / 10)
        matrix, error = _bands.weighted(matrix, held.root) + bent, error / float(engine.masses.min())
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
            told = _bands.groups_of(modes, atoms)
            return Band(name, step, modes.largest, most, "", 0, looked, told[0].name if told else "", told)
    onto = _bands.projection(held, where)
    product, steps, forces = _bands.by_differences(force, where, held.root, difference), _ASKED, 2
    if known:
        product, steps, forces = (lambda vector: np.asarray((matrix - bent) @ vector)), _STORED, 0

    def apply(vector: Doubles) -> Doubles:
        vector = onto(vector)
        return onto(product(vector) + bent @ vector)

    found = _bands.top(apply, where.size, steps)
    if forces:
        wide = _bands.by_differences(force, where, held.root, 2 * difference)
        error = float(np.linalg.norm(onto(wide(found.vector) - product(found.vector))))
    moving = np.linalg.norm(found.vector.reshape(-1, 3), axis=1)
    who = ", ".join(atoms.labels[n] for n in np.argsort(-moving)[:2] if moving[n] > moving.max() / 10)
    looked = "the Hessian of all bonded terms"
    motion = atoms.motions(range(engine.count), [found.vector[None]], [True] * engine.count)[0] or ""
    return Band(name, step, found.found, found.most + error, who, forces * steps, looked, motion)


def _atoms(system: Any, topology: Any, where: Doubles, masses: Doubles) -> Atoms:
    """What atoms of a system are called, before any hydrogen was made heavier; ``masses`` are what they have then.

    Who is bonded to whom tells the topology, else bonds and constraints of two that are not both hydrogens.
    """
    moving = _moving(system)
    labels, elements, bonded = _named(_masses(system), topology, moving)
    symbols = elements or [label.split()[0] for label in labels]
    if bonded is None:
        place = {int(n): k for k, n in enumerate(moving)}
        bonded = [(place[i], place[j]) for i, j in _bonds(system)]
    return Atoms(labels, symbols, bonded, where, masses)


def _bonds(system: Any) -> list[tuple[int, int]]:
    forces = [force for force in system.getForces() if isinstance(force, mm.HarmonicBondForce)]
    pairs = [tuple(force.getBondParameters(n)[:2]) for force in forces for n in range(force.getNumBonds())]
    pairs += [tuple(system.getConstraintParameters(n)[:2]) for n in range(system.getNumConstraints())]
    masses = _masses(system)
    own = {(min(pair), max(pair)) for pair in pairs if masses[list(pair)].all()}
    return sorted(pair for pair in own if masses[list(pair)].max() > _HYDROGEN)


#: u: what is no heavier is a hydrogen, as files of systems have it.
_HYDROGEN = 1.1


def _changed(system: Any, topology: Any, where: Doubles, constraints: str | None, hmr: Exact | None) -> Any:
    """A copy with heavy hydrogens and held bonds of hydrogens, as :meth:`System.advise` has them; or the system itself.

    A bond is held at its length of rest, or as long as it is where it has none.
    """
    if constraints is None and hmr is None:
        return system
    if constraints not in (None, "h-bonds"):
        raise KickdriftError("constraints", str(constraints), "of OpenMM's systems write h-bonds")
    own, masses = mm.XmlSerializer.clone(system), [float(mass) for mass in _masses(system)]
    named = _named(np.array(masses), topology, np.arange(len(masses)))[2] or _bonds(system)
    light = [pair if masses[pair[0]] <= _HYDROGEN else pair[::-1] for pair in named]
    light = [(i, j) for i, j in light if 0 < masses[i] <= _HYDROGEN < masses[j]]
    if not light:
        raise KickdriftError("system", "no hydrogen", f"no mass is up to {_HYDROGEN} u: leave constraints and hmr out")
    if hmr is not None:
        heavy = float(rational("hmr", str(hmr).removesuffix("u").removesuffix("am").strip()))
        moved = list(masses)
        for i, j in light:
            moved[i], moved[j] = heavy, moved[j] - (heavy - masses[i])
        least = min((int(n) for n in _moving(system)), key=lambda n: moved[n])
        if moved[least] <= 0 or heavy < max(masses[i] for i, _ in light):
            remedy = f"leaves particle {least} a mass of {moved[least]:.3g} u: give hydrogens 3.024 or so"
            raise KickdriftError("hmr", str(hmr), remedy)
        for n, mass in enumerate(moved):
            own.setParticleMass(n, mass)
    if constraints is not None:
        place = {int(n): k for k, n in enumerate(_moving(system))}
        there = {frozenset(own.getConstraintParameters(n)[:2]) for n in range(own.getNumConstraints())}
        rest: dict[frozenset[int], float] = {}
        for force in own.getForces():
            if isinstance(force, mm.HarmonicBondForce):
                terms = (force.getBondParameters(n) for n in range(force.getNumBonds()))
                rest |= {frozenset(term[:2]): term[2]._value for term in terms}
        for i, j in light:
            if frozenset((i, j)) not in there:
                apart = float(np.linalg.norm(where[place[i]] - where[place[j]]))
                own.addConstraint(i, j, rest.get(frozenset((i, j)), apart))
    return own


def _mask(groups: Sequence[int]) -> int:
    """The bits by which OpenMM knows some groups."""
    return sum(1 << group for group in groups)


def _levels(clocks: Mapping[int, Fraction]) -> dict[Fraction, list[int]]:
    """The groups of each step, the smallest first."""
    levels: dict[Fraction, list[int]] = {}
    for group, step in sorted(clocks.items(), key=lambda item: (item[1], item[0])):
        levels.setdefault(step, []).append(group)
    return levels


def _clocks(system: Any, integrator: Any, steps: Mapping[int, Any] | None) -> dict[int, Fraction]:
    """The step of each force group, ps; all groups of the system are there."""
    if (steps is None) == (integrator is None):
        remedy = "of OpenMM give either steps={group: step} or an integrator"
        raise KickdriftError("steps", "both" if steps is not None else None, remedy)
    acting = _acting(system)
    for group in steps or ():
        if not isinstance(group, int | np.integer):
            raise KickdriftError("steps", str(group), "is no number of a force group: write steps={0: ..., 1: ...}")
    if steps is None:
        clocks = _of_integrator(integrator, set(acting))
    else:
        clocks = {group: duration(f"steps[{group}]", _plain(own), "ps") for group, own in steps.items()}
    missing = sorted(acting.keys() - clocks.keys())
    if missing:
        remedy = f"is never integrated ({', '.join(acting[missing[0]])}): give it a step"
        raise KickdriftError("steps", f"group {missing[0]}", remedy)
    idle = sorted(clocks.keys() - acting.keys())
    if idle and steps is not None:
        there = ", ".join(str(group) for group in sorted(acting))
        raise KickdriftError("steps", f"group {idle[0]}", f"has no force: forces are in {there}; leave its step out")
    return {group: step for group, step in clocks.items() if group in acting}


def _acting(system: Any) -> dict[int, list[str]]:
    """The names of the forces by group; the reciprocal space of an Ewald sum has one of its own where it is set."""
    acting: dict[int, list[str]] = {}
    for force in system.getForces():
        if _moves_nothing(force):
            continue
        acting.setdefault(force.getForceGroup(), []).append(force.getName())
        own = getattr(force, "getReciprocalSpaceForceGroup", lambda: -1)()
        if own >= 0 and force.getNonbondedMethod() in _EWALD:
            acting.setdefault(own, []).append(f"reciprocal space of {force.getName()}")
    return acting


def _moves_nothing(force: Any) -> bool:
    return isinstance(force, mm.CMMotionRemover) or _is_bath(force)


def _is_bath(force: Any) -> bool:
    return "Barostat" in type(force).__name__ or isinstance(force, mm.AndersenThermostat)


def _plain(value: Any) -> Exact:
    """A quantity as a text in ps: its number as it prints, and the unit's factor, a power of ten or near one."""
    if not unit.is_quantity(value):
        return value
    factor = simplest(value.unit.conversion_factor_to(unit.picosecond), ulps=2)
    return f"{rational('steps', value._value) * factor}ps"


#: How OpenMM's multiple-time-step integrators write a kick of group G, N times a step.
_KICK = re.compile(r"v\+(?P<half>0?\.5\*)?\(?dt(?:/(?P<parts>\d+))?\)?\*f(?P<group>\d*)/m$")


def _of_integrator(integrator: Any, groups: set[int]) -> dict[int, Fraction]:
    step = simplest(integrator.getStepSize()._value, ulps=2)
    plain = (mm.VerletIntegrator, mm.LangevinIntegrator, mm.LangevinMiddleIntegrator)
    if isinstance(integrator, plain):
        mask = integrator.getIntegrationForceGroups()
        return {group: step for group in groups if mask >> group & 1}
    clocks: dict[int, Fraction] = {}
    if isinstance(integrator, mm.CustomIntegrator):
        for number_ in range(integrator.getNumComputations()):
            _, variable, expression = integrator.getComputationStep(number_)
            found = _KICK.match(expression.replace(" ", "")) if variable == "v" else None
            if found:
                own = [int(found["group"])] if found["group"] else sorted(groups)
                clocks |= dict.fromkeys(own, step / int(found["parts"] or 1))
    if not clocks:
        remedy = "its steps are not known from its form: give steps={group: step} instead"
        raise KickdriftError("integrator", type(integrator).__name__, remedy)
    return clocks


def _platforms() -> list[str]:
    return [mm.Platform.getPlatform(n).getName() for n in range(mm.Platform.getNumPlatforms())]


def _resumed(engine: _Engine, where: Doubles, resume: str | PathLike[str] | None) -> _Engine:
    """With the journal of this system at these positions."""
    platform, xml = engine.context.getPlatform().getName(), mm.XmlSerializer.serialize(engine.context.getSystem())
    return replace(engine, journal=Journal.at(resume, mm.version.full_version, platform, xml, where))


def _engine(system: Any, platform: str = "Reference") -> _Engine:
    masses, moving = _masses(system), _moving(system)
    if (masses[moving] <= 0).any():
        remedy = (
            "has no mass and is no virtual site, so it stands still: give it any mass, and atoms=[...] with those that "
            "move"
        )
        raise KickdriftError("system", f"particle {moving[np.argmin(masses[moving])]}", remedy)
    turned = (n for n in range(len(masses)) if system.isVirtualSite(n))
    if any(isinstance(system.getVirtualSite(n), mm.SymmetrySite) for n in turned):
        raise KickdriftError("system", "a SymmetrySite", "turns against the others, so no whole is free: not handled")
    # The Reference platform computes in doubles: differences of its forces are good to ten digits.
    integrator = mm.VerletIntegrator(0.001)
    if platform not in _platforms():
        raise KickdriftError("platform", platform, f"is not here: give one of {', '.join(_platforms())}")
    try:
        context = mm.Context(system, integrator, mm.Platform.getPlatformByName(platform))
    except mm.OpenMMException as error:
        raise KickdriftError("system", "refused by OpenMM", str(error)) from error
    return _Engine(context, masses[moving], moving)


def _masses(system: Any) -> Doubles:
    """Of all particles, u."""
    return np.array([system.getParticleMass(n)._value for n in range(system.getNumParticles())], dtype=np.float64)


def _moving(system: Any) -> npt.NDArray[np.intp]:
    """The numbers of the particles that are no virtual sites."""
    return np.array([n for n in range(system.getNumParticles()) if not system.isVirtualSite(n)], dtype=np.intp)


def _places(system: Any, atoms: Sequence[int]) -> list[int]:
    """Where atoms stand among the particles that are no virtual sites.

    Raises
    ------
    KickdriftError
        Where one is none of these.
    """
    place = {int(n): k for k, n in enumerate(_moving(system))}
    for atom in atoms:
        if atom not in place:
            is_site = 0 <= atom < system.getNumParticles()
            remedy = "is a virtual site: give the atoms that it follows" if is_site else "is no particle of the system"
            raise KickdriftError("atoms", str(atom), remedy)
    return [place[int(atom)] for atom in atoms]


def _stretch(system: Any, at: Doubles) -> float:
    """How many times farther than particles a virtual site moves at most, to first order, with all particles here; 1 at
    least."""
    known = np.ones(system.getNumParticles())
    for n in range(system.getNumParticles()):
        if system.isVirtualSite(n):
            site = system.getVirtualSite(n)
            parents = [site.getParticle(k) for k in range(site.getNumParticles())]
            known[n] = _turned(site, at[parents]) * max(known[parents])
    return max(1.0, float(known.max(initial=1.0)))


def _turned(site: Any, at: Doubles) -> float:
    """How far a site moves where its parents, which are here, move by 1 each: by the norms of its derivatives."""
    if isinstance(site, mm.OutOfPlaneSite):
        first, second, cross = (float(own) for own in (site.getWeight12(), site.getWeight13(), site.getWeightCross()))
        one, two = float(np.linalg.norm(at[1] - at[0])), float(np.linalg.norm(at[2] - at[0]))
        return abs(1 - first - second) + abs(first) + abs(second) + 2 * abs(cross) * (one + two)
    if isinstance(site, mm.LocalCoordinatesSite):
        origin, along, beside = map(np.array, (site.getOriginWeights(), site.getXWeights(), site.getYWeights()))
        x, y = along @ at, beside @ at
        # The frame turns as its first axis does, and about that.
        length = float(np.linalg.norm(x))
        across = float(np.linalg.norm(np.cross(x, y))) / length
        turn = np.abs(along).sum() / length * (1 + abs(x @ y) / length / across) + np.abs(beside).sum() / across
        return float(np.abs(origin).sum() + np.linalg.norm(site.getLocalPosition()._value) * turn)
    return sum(abs(float(site.getWeight(k))) for k in range(site.getNumParticles()))


def _positions(positions: Any, system: Any) -> Doubles:
    """Of the particles that are no virtual sites, nm; sites are placed anew, whether they are given or not."""
    own = positions.value_in_unit(unit.nanometer) if unit.is_quantity(positions) else positions
    array = doubles("positions", own if isinstance(own, np.ndarray) else [list(row) for row in own])
    count, moving = system.getNumParticles(), _moving(system)
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
    place = {int(n): k for k, n in enumerate(_moving(system))}
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


def _notes(system: Any, integrator: Any, clocks: Mapping[int, Fraction]) -> list[str]:
    notes = [f"{force.getName()} is left out" for force in system.getForces() if _is_bath(force)]
    if integrator is not None:
        idle = sorted(_of_integrator(integrator, set(clocks)).keys() - clocks.keys())
        notes += [f"group {group} of the integrator has no force" for group in idle]
    if integrator is not None and "Langevin" in type(integrator).__name__:
        notes.append("friction and noise of the integrator are left out")
    if sites := system.getNumParticles() - len(_moving(system)):
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


def _constraints(system: Any) -> list[_Constraint]:
    """By the places of the particles that are no virtual sites."""
    place = {int(n): k for k, n in enumerate(_moving(system))}
    every = (system.getConstraintParameters(n) for n in range(system.getNumConstraints()))
    return [(place[i], place[j], float(distance._value)) for i, j, distance in every]


def _minimized(
    engine: _Engine,
    where: Doubles,
    constraints: Sequence[_Constraint],
    difference: float,
    chosen: Sequence[int] | None = None,
    progress: Progress | None = None,
) -> Doubles:
    """:func:`_at_rest`, the positions alone."""
    return _at_rest(engine, where, constraints, difference, chosen, progress)[0]


def _at_rest(
    engine: _Engine,
    where: Doubles,
    constraints: Sequence[_Constraint],
    difference: float,
    chosen: Sequence[int] | None = None,
    progress: Progress | None = None,
) -> tuple[Doubles, list[str]]:
    """The minimum in the engine's own context: the system given and its contexts stay as they are; and what to know of
    it.

    Newton's method first, since OpenMM's minimizer leaves a minimum that it is given; after the minimizer where that
    does not arrive close by. All but the chosen coordinates stand still. Of forces that jump at a cutoff the minimum
    need not be one: then a note says so.

    Raises
    ------
    KickdriftError
        Where no minimum is found.
    """
    force, held = engine.force(-1), Held(engine.masses, constraints)
    is_boxed = engine.is_boxed and chosen is None

    def newton(near: Doubles, far: float) -> tuple[Doubles, Force]:
        reach = _REACH if engine.cuts else np.inf
        return minimum(force, near, held, difference, chosen, is_boxed, reach, far, progress)

    try:
        found, smooth = newton(where, _CLOSE)
    except (KickdriftError, mm.OpenMMException, np.linalg.LinAlgError):
        near = _relaxed(engine, where, chosen)
        # A step of the minimizer may leave what bonds allow, as those of FENE, and has no way back.
        is_lost = not engine.energy(near) <= engine.energy(where)
        try:
            if is_lost:
                near = cooled(force, where, held, difference) if chosen is None else where
            try:
                found, smooth = newton(near, _CLOSE if engine.cuts and chosen is None else np.inf)
            except KickdriftError:
                # Thousands of forces, where energies that jump stopped the minimizer far from rest.
                if not engine.cuts or chosen is not None:
                    raise
                found, smooth = newton(cooled(force, near, held, difference), np.inf)
        except KickdriftError as error:
            if not engine.cuts:
                remedy = "lead to no minimum: minimize them first, if they are in nm"
                raise KickdriftError("positions", error.value, remedy) from error
            remedy = (
                f"is the least that was found, no minimum: forces jump at a cutoff; take {engine.smoother}; "
                "or minimize=False"
            )
            raise KickdriftError("positions", error.value, remedy) from error
    note = smooth.note(found) if isinstance(smooth, _Smooth) else None
    return found, [note] if note else []


def _relaxed(engine: _Engine, where: Doubles, chosen: Sequence[int] | None) -> Doubles:
    """Where OpenMM's minimizer ends; what has no mass stands still for it."""
    context = engine.context
    if chosen is not None:
        own = mm.XmlSerializer.clone(context.getSystem())
        still = {int(n) for n in np.delete(engine.moving, sorted({column // 3 for column in chosen}))}
        for n in still:
            own.setParticleMass(n, 0.0)
        # Held distances to what stands still are the next step's: the minimizer knows none of massless particles.
        for n in reversed(range(own.getNumConstraints())):
            if set(own.getConstraintParameters(n)[:2]) & still:
                own.removeConstraint(n)
        context = mm.Context(own, mm.VerletIntegrator(0.001), context.getPlatform())
    return _led_downhill(engine, where, context, tolerance=1e-4)


def _led_downhill(engine: _Engine, where: Doubles, context: Any = None, **how: float) -> Doubles:
    """Where OpenMM's minimizer ends; of an energy that is no number it would not."""
    context = context or engine.context
    if engine.journal is not None:
        # Threads add up forces in any order: it need not end at the same place again.
        own, xml = replace(engine, journal=None), mm.XmlSerializer.serialize(context.getSystem())
        return engine.journal.kept(lambda: _led_downhill(own, where, context, **how), "downhill", str(how), xml, where)
    engine.place(where, context)
    energy = context.getState(getEnergy=True).getPotentialEnergy()._value
    if not np.isfinite(energy):
        remedy = "is their energy: do two particles share a place, or does a bond exceed its longest length?"
        raise KickdriftError("positions", f"{energy} kJ/mol", remedy)
    mm.LocalEnergyMinimizer.minimize(context, **how)
    return np.array(context.getState(getPositions=True).getPositions(asNumpy=True)._value)[engine.moving]


#: How far, nm, Newton's method alone may go: half a bond; and within which pairs are kept on their side of a cutoff.
_CLOSE, _REACH = 0.05, 0.04
