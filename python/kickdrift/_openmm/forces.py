"""OpenMM's contexts as forces of groups, on the particles that move by themselves."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from os import PathLike
from typing import Any

import numpy as np
import numpy.typing as npt

from kickdrift import _forcefield
from kickdrift._errors import KickdriftError
from kickdrift._hessians import Force
from kickdrift._journal import Journal
from kickdrift._openmm import mm
from kickdrift._rigid import Doubles

#: Forces that end at a cutoff.
_CUT = (mm.NonbondedForce, mm.CustomNonbondedForce)


@dataclass(frozen=True)
class Engine:
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
        copy, pull = mm.XmlSerializer.clone(self.context.getSystem()), mm.CustomExternalForce("-(fx*x+fy*y+fz*z)")
        for n in reversed(range(copy.getNumForces())):
            copy.removeForce(n)
        for axis in "xyz":
            pull.addPerParticleParameter(f"f{axis}")
        for n in self.sites:
            pull.addParticle(int(n), [0.0, 0.0, 0.0])
        copy.addForce(pull)
        context = mm.Context(copy, mm.VerletIntegrator(0.001), mm.Platform.getPlatformByName("Reference"))
        engine = Engine(context, self.masses, self.moving)

        def shared(positions: Doubles, forces: Doubles) -> Doubles:
            for k, n in enumerate(self.sites):
                pull.setParticleParameters(k, int(n), list(forces[n]))
            pull.updateParametersInContext(context)
            return forces[self.moving] + engine.force(-1)(positions)

        return shared

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
        methods = [
            force.getNonbondedMethod() for force in self.context.getSystem().getForces() if isinstance(force, _CUT)
        ]
        takes = set(methods) - {mm.NonbondedForce.NoCutoff, mm.NonbondedForce.LJPME}
        tuned = "a smaller Ewald tolerance or a longer cutoff"
        if mm.NonbondedForce.LJPME in methods and not takes:
            return f"{tuned} (OpenMM takes no switching function with LJPME, but with PME)"
        return f"a switching function, {tuned}"

    def force(self, groups: int) -> Forces:
        """The forces of some groups, bits of a mask."""
        return Forces(self, groups)

    def energy(self, where: Doubles) -> float:
        """The energy of all forces, kJ/mol."""
        self.place(where)
        return float(self.context.getState(getEnergy=True).getPotentialEnergy()._value)

    @cached_property
    def cuts(self) -> dict[int, list[Any]]:
        """What is cut off of each group: pairs whose forces are known."""
        found: dict[int, list[Any]] = {}
        for force in self.context.getSystem().getForces():
            if isinstance(force, _CUT) and (cut := _forcefield.cut(force, self.context)) is not None:
                found.setdefault(force.getForceGroup(), []).append(cut)
        return found


@dataclass(frozen=True)
class Forces:
    """The forces of some groups, bits of a mask, at positions in nm, in kJ/mol/nm."""

    engine: Engine
    groups: int

    def __call__(self, positions: Doubles) -> Doubles:
        self.engine.place(positions)
        state = self.engine.context.getState(getForces=True, groups=self.groups)
        return np.asarray(state.getForces(asNumpy=True)._value, dtype=np.float64)[self.engine.moving]

    @property
    def journal(self) -> Journal | None:
        return self.engine.journal and self.engine.journal.under("forces", float(self.groups))

    def smooth(self, positions: Doubles, reach: float) -> Force:
        """With each pair kept on that side of the cutoff on which it is at these positions."""
        acting = [cut for group, cuts in self.engine.cuts.items() if self.groups >> group & 1 for cut in cuts]
        if not acting:
            return self
        every, about = self.engine.placed(positions), (positions, reach)
        reach *= stretch_of(self.engine.context.getSystem(), every)
        kept = [found for cut in acting if (found := cut.kept(every, reach)) is not None]
        return Smooth(self, kept, about) if kept else self


@dataclass(frozen=True)
class Smooth:
    """The forces of some groups with pairs kept on a side of the cutoff, while they are near it: ``about`` which
    positions, and within which reach."""

    force: Forces
    kept: Sequence[Any]
    about: tuple[Doubles, float]

    @property
    def journal(self) -> Journal | None:
        journal = self.force.journal
        return journal and journal.under("smooth", *self.about)

    def __call__(self, positions: Doubles) -> Doubles:
        engine = self.force.engine
        every = engine.placed(positions)
        added = np.sum([cut(every) for cut in self.kept], axis=0)
        return np.asarray(self.force(positions) + (engine.shared(positions, added) if added.any() else 0.0))

    def note(self, positions: Doubles) -> str | None:
        """What to know of a minimum of this where it is none of the forces as they are: pairs beyond their side."""
        every = self.force.engine.placed(positions)
        crossed = [cut.crossed(every) for cut in self.kept]
        pairs = [pair for pairs, _ in crossed for pair in pairs]
        if not pairs:
            return None
        off = max(float(depths.max(initial=0.0)) for _, depths in crossed)
        jump = float(np.linalg.norm(self(positions) - self.force(positions), axis=1).max())
        who = f"{len(pairs)} pair{'s' * (len(pairs) > 1)} (as particles {pairs[0][0]} and {pairs[0][1]})"
        return (
            f"forces jump at a cutoff, and no minimum of them as they are was found near: {who} kept on one side of it "
            f"come to rest on the other, up to {off:.1g} nm beyond it, where forces jump by up to {jump:.2g} "
            "kJ/mol/nm; the positions are the minimum with these kept so. The jump is smaller with "
            f"{self.force.engine.smoother}"
        )


def platforms() -> list[str]:
    return [mm.Platform.getPlatform(n).getName() for n in range(mm.Platform.getNumPlatforms())]


def resumed(engine: Engine, where: Doubles, resume: str | PathLike[str] | None) -> Engine:
    """With the journal of this system at these positions."""
    platform, xml = engine.context.getPlatform().getName(), mm.XmlSerializer.serialize(engine.context.getSystem())
    return replace(engine, journal=Journal.at(resume, mm.version.full_version, platform, xml, where))


def engine_of(system: Any, platform: str = "Reference") -> Engine:
    masses, moving = masses_of(system), moving_of(system)
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
    if platform not in platforms():
        raise KickdriftError("platform", platform, f"is not here: give one of {', '.join(platforms())}")
    try:
        context = mm.Context(system, integrator, mm.Platform.getPlatformByName(platform))
    except mm.OpenMMException as error:
        raise KickdriftError("system", "refused by OpenMM", str(error)) from error
    return Engine(context, masses[moving], moving)


def masses_of(system: Any) -> Doubles:
    """The masses of all particles, u."""
    return np.array([system.getParticleMass(n)._value for n in range(system.getNumParticles())], dtype=np.float64)


def moving_of(system: Any) -> npt.NDArray[np.intp]:
    """The numbers of the particles that are no virtual sites."""
    return np.array([n for n in range(system.getNumParticles()) if not system.isVirtualSite(n)], dtype=np.intp)


def stretch_of(system: Any, at: Doubles) -> float:
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
        first, second, cross = (
            float(weight) for weight in (site.getWeight12(), site.getWeight13(), site.getWeightCross())
        )
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


def led_downhill(engine: Engine, where: Doubles, context: Any = None, **how: float) -> Doubles:
    """Where OpenMM's minimizer ends; of an energy that is no number it would not."""
    context = context or engine.context
    if engine.journal is not None:
        # Threads add up forces in any order: it need not end at the same place again.
        unkept, xml = replace(engine, journal=None), mm.XmlSerializer.serialize(context.getSystem())
        return engine.journal.kept(
            lambda: led_downhill(unkept, where, context, **how), "downhill", str(how), xml, where
        )
    engine.place(where, context)
    energy = context.getState(getEnergy=True).getPotentialEnergy()._value
    if not np.isfinite(energy):
        remedy = "is their energy: do two particles share a place, or does a bond exceed its longest length?"
        raise KickdriftError("positions", f"{energy} kJ/mol", remedy)
    mm.LocalEnergyMinimizer.minimize(context, **how)
    return np.array(context.getState(getPositions=True).getPositions(asNumpy=True)._value)[engine.moving]
