"""Sparse Hessians of OpenMM's force groups: bonds, angles, torsions and pairs by their formulas, the rest of what is
bonded by coloured differences.

A bonded term reaches a few atoms. Atoms of one colour share no term with any third atom, so one difference of forces
gives the columns of all of them: a few dozen evaluations, whatever the number of atoms. Pairs within a cutoff have
second derivatives in closed form, E'' along the pair and E'/r across. Units: nm, ps, u, kJ/mol; not mass-weighted.
"""

from __future__ import annotations

from collections.abc import Sequence
from copy import deepcopy
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from kickdrift import _terms as _terms_of
from kickdrift._errors import KickdriftError
from kickdrift._hessians import Force
from kickdrift._openmm import mm
from kickdrift._progress import Progress
from kickdrift._rigid import Doubles
from kickdrift._scipy import sparse, spatial, special

_Indices = npt.NDArray[np.int64]
_Mask = npt.NDArray[np.bool_]

#: The terms of each bonded force: how many there are, how one is read, and where its atoms stand in that.
_BONDED: dict[str, tuple[str, str, slice]] = {
    "HarmonicBondForce": ("getNumBonds", "getBondParameters", slice(0, 2)),
    "CustomBondForce": ("getNumBonds", "getBondParameters", slice(0, 2)),
    "HarmonicAngleForce": ("getNumAngles", "getAngleParameters", slice(0, 3)),
    "CustomAngleForce": ("getNumAngles", "getAngleParameters", slice(0, 3)),
    "PeriodicTorsionForce": ("getNumTorsions", "getTorsionParameters", slice(0, 4)),
    "RBTorsionForce": ("getNumTorsions", "getTorsionParameters", slice(0, 4)),
    "CustomTorsionForce": ("getNumTorsions", "getTorsionParameters", slice(0, 4)),
    "CMAPTorsionForce": ("getNumTorsions", "getTorsionParameters", slice(1, 9)),
    "CustomExternalForce": ("getNumParticles", "getParticleParameters", slice(0, 1)),
}

#: kJ/mol nm per elementary charge squared: OpenMM's own constant.
_COULOMB = 138.93545764438198


def hessian(
    system: Any,
    groups: Sequence[int],
    positions: Doubles,
    difference: float,
    progress: Progress | None = None,
) -> tuple[Any, float]:
    """The Hessian of some force groups as compressed rows, kJ/mol/nm², and an estimate of its error.

    Raises
    ------
    KickdriftError
        A force whose terms are not known here: Ewald sums, custom pairs, bonds of many bodies; pairs of virtual sites
        that are no averages of their atoms.
    """
    forces = [force for force in system.getForces() if force.getForceGroup() in groups]
    bonded = [force for force in forces if type(force).__name__ in _BONDED]
    pairs = [force for force in forces if isinstance(force, mm.NonbondedForce)]
    others = [force for force in forces if force not in bonded + pairs and not isinstance(force, mm.CMMotionRemover)]
    if others:
        name = type(others[0]).__name__
        remedy = "has no sparse Hessian here: leave sparse=True out, or give Hessians to System.from_hessians"
        raise KickdriftError("system", name, remedy)
    onto = _placing(system, bonded + pairs)
    positions = np.asarray(onto @ positions.ravel()).reshape(-1, 3)
    total = sparse.csr_matrix((positions.size, positions.size))
    error = 0.0
    formal = [force for force in bonded if type(force).__name__ in _terms_of.LAWS and _is_plain(force)]
    if formal:
        matrix = by_formulas(formal, positions)
        if np.isfinite(matrix.data).all():
            error += _seen(matrix, _alone(system, formal), positions, np.ones(len(positions), dtype=bool))
            bonded, total = [force for force in bonded if force not in formal], total + matrix
    if bonded:
        terms = [atoms for force in bonded for atoms in _terms(force)]
        force = _alone(system, bonded)
        matrix, known = coloured(force, positions, _neighbours(terms, len(positions)), difference, progress)
        error, total = error + known, total + matrix
    for force in pairs:
        matrix, smooth = nonbonded(force, system, positions)
        error += _seen(matrix, _alone(system, [force]), positions, smooth)
        total = total + matrix
    # No vector is stretched by more than the root of the largest sums of a row and of a column.
    return (onto.T @ total @ onto).tocsr(), error * _largest_row(onto) * _largest_row(onto.T)


def _placing(system: Any, forces: Sequence[Any]) -> Any:
    """The coordinates of all particles by those of the particles that are no virtual sites.

    Sites that are averages of their atoms are linear in these, so a Hessian of all is one of the atoms by it. Other
    sites are left at 0 where no term of the forces knows them.

    Raises
    ------
    KickdriftError
        Where such a site has forces.
    """
    count = system.getNumParticles()
    moving = [n for n in range(count) if not system.isVirtualSite(n)]
    place, entries, bent = {n: k for k, n in enumerate(moving)}, [(n, k, 1.0) for k, n in enumerate(moving)], set()
    for n in sorted(set(range(count)) - set(moving)):
        site = system.getVirtualSite(n)
        parents = [site.getParticle(k) for k in range(site.getNumParticles())]
        if hasattr(site, "getWeight") and place.keys() >= set(parents):
            entries += [(n, place[parent], site.getWeight(k)) for k, parent in enumerate(parents)]
        else:
            bent.add(n)
    is_known = are_bonded(forces) and not any(bent & set(atoms) for force in forces for atoms in _terms(force))
    if bent and not is_known:
        site = system.getVirtualSite(min(bent))
        remedy = "is no average of its atoms, and has no sparse Hessian here: leave sparse=True out"
        raise KickdriftError("system", f"particle {min(bent)}, a {type(site).__name__}", remedy)
    rows, columns, weights = np.array(entries).reshape(-1, 3).T
    one = sparse.csr_matrix((weights, (rows.astype(np.int64), columns.astype(np.int64))), shape=(count, len(moving)))
    return sparse.kron(one, sparse.identity(3), format="csr")


def are_bonded(forces: Sequence[Any]) -> bool:
    """Whether each term of all of these is one of a few atoms, which is known here."""
    return all(type(force).__name__ in _BONDED for force in forces)


def _terms(force: Any) -> list[list[int]]:
    count, read, atoms = _BONDED[type(force).__name__]
    return [list(getattr(force, read)(n)[atoms]) for n in range(getattr(force, count)())]


def _is_plain(force: Any) -> bool:
    """Whether its terms are of the positions as they stand."""
    return not force.usesPeriodicBoundaryConditions()


def by_formulas(forces: Sequence[Any], positions: Doubles) -> Any:
    """The Hessian of bonds, angles and torsions by their formulas, to rounding; not finite where a term has none."""
    size, entries = positions.size, [np.zeros((3, 0))]
    for force in forces:
        kind = type(force).__name__
        count, read, atoms = _BONDED[kind]
        terms = [getattr(force, read)(n) for n in range(getattr(force, count)())]
        if not terms:
            continue
        numbers = np.array([[float(getattr(x, "_value", x)) for x in term[atoms.stop :]] for term in terms])
        places, bends = _terms_of.blocks(kind, [term[atoms] for term in terms], numbers, positions)
        rows, columns = np.broadcast_arrays(places[:, :, None], places[:, None, :])
        entries.append(np.array([rows.ravel(), columns.ravel(), bends.ravel()]))
    rows, columns, values = np.concatenate(entries, axis=1)
    return sparse.csr_matrix((values, (rows.astype(np.int64), columns.astype(np.int64))), shape=(size, size))


def _alone(system: Any, forces: Sequence[Any]) -> Force:
    """The forces of these alone, in doubles."""
    copy = mm.System()
    for n in range(system.getNumParticles()):
        copy.addParticle(system.getParticleMass(n))
    copy.setDefaultPeriodicBoxVectors(*system.getDefaultPeriodicBoxVectors())
    for force in forces:
        copy.addForce(deepcopy(force))
    context = mm.Context(copy, mm.VerletIntegrator(0.001), mm.Platform.getPlatformByName("Reference"))

    def alone(positions: Doubles) -> Doubles:
        context.setPositions(positions)
        return np.asarray(context.getState(getForces=True).getForces(asNumpy=True)._value, dtype=np.float64)

    return alone


def _neighbours(terms: Sequence[Sequence[int]], count: int) -> Any:
    """Which atoms stand in one term, each with itself."""
    places = [(n, atom) for n, atoms in enumerate(terms) for atom in atoms]
    rows, columns = np.array(places, dtype=np.int64).reshape(-1, 2).T
    member = sparse.csr_matrix((np.ones(len(rows)), (rows, columns)), shape=(len(terms), count))
    return ((member.T @ member + sparse.identity(count)) != 0).tocsr()


def _colours(neighbours: Any) -> list[_Indices]:
    """The atoms of each colour, which no third atom is a neighbour of twice."""
    near = (neighbours @ neighbours).tocsr()
    colours = np.full(near.shape[0], -1)
    for atom in range(near.shape[0]):
        taken = set(colours[near.indices[near.indptr[atom] : near.indptr[atom + 1]]])
        colours[atom] = next(colour for colour in range(len(taken) + 1) if colour not in taken)
    return [np.flatnonzero(colours == colour) for colour in range(colours.max(initial=-1) + 1)]


def coloured(
    force: Force, positions: Doubles, neighbours: Any, difference: float, progress: Progress | None = None
) -> tuple[Any, float]:
    """A Hessian by central differences of fourth order, all atoms of a colour displaced at once; and its error.

    That is the largest sum of a row: of the correction from second to fourth order, plus of the antisymmetric part.
    """
    colours = _colours(neighbours)
    entries: list[tuple[_Indices, _Indices, Doubles, Doubles]] = []
    for done, atoms in enumerate(colours):
        joined = neighbours[atoms].tocoo()
        reached, moved = joined.col, atoms[joined.row]
        for axis in range(3):
            near, far = (_difference(force, positions, atoms, axis, width) for width in (difference, 2 * difference))
            for to in range(3):
                second, fourth = near[reached, to], (4 * near[reached, to] - far[reached, to]) / 3
                entries.append((3 * reached + to, 3 * moved + axis, -second, -fourth))
        if progress is not None:
            progress(done + 1, len(colours))
    rows, columns, second, fourth = (np.concatenate(part) for part in zip(*entries, strict=True))
    size = positions.size
    matrix = sparse.csr_matrix((fourth, (rows, columns)), shape=(size, size))
    lower = sparse.csr_matrix((second, (rows, columns)), shape=(size, size))
    mean = ((matrix + matrix.T) / 2).tocsr()
    return mean, _largest_row(matrix - lower) + _largest_row(matrix - mean)


def _difference(force: Force, positions: Doubles, atoms: _Indices, axis: int, width: float) -> Doubles:
    moved = positions.copy()
    moved[atoms, axis] += width
    ahead = force(moved)
    moved[atoms, axis] -= 2 * width
    return (ahead - force(moved)) / (2 * width)


def _largest_row(matrix: Any) -> float:
    return float(abs(matrix).sum(axis=1).max()) if matrix.nnz else 0.0


def nonbonded(force: Any, system: Any, positions: Doubles) -> tuple[Any, _Mask]:
    """The Hessian of a NonbondedForce without Ewald sums, and which atoms have no pair that a look takes across.

    Lennard-Jones with its switching, Coulomb with the reaction field, and exceptions, which know neither.

    Raises
    ------
    KickdriftError
        Ewald sums, offsets of parameters, a box that is not rectangular.
    """
    method = force.getNonbondedMethod()
    if method not in (force.NoCutoff, force.CutoffNonPeriodic, force.CutoffPeriodic):
        remedy = "reaches all pairs at once: choose a cutoff, or leave sparse=True out"
        raise KickdriftError("system", "an Ewald sum", remedy)
    if force.getNumGlobalParameters():
        raise KickdriftError(
            "system", "offsets of parameters", "have no sparse Hessian here: give the values themselves"
        )
    count = len(positions)
    charge, sigma, epsilon = np.array([_plain(force.getParticleParameters(n)) for n in range(count)]).T
    given = [force.getExceptionParameters(n) for n in range(force.getNumExceptions())]
    held = np.array([exception[:2] for exception in given], dtype=np.int64).reshape(-1, 2)
    special = np.array([_plain(exception[2:]) for exception in given]).reshape(-1, 3)
    box = _box(system) if method == force.CutoffPeriodic else None
    pairs = _pairs(force, positions, box)
    pairs = pairs[~np.isin(_key(pairs, count), _key(held, count))]
    i, j = pairs.T
    scale = _COULOMB * charge[i] * charge[j]
    apart, r = _apart(positions, pairs, box)
    first, second = _lennard_jones((sigma[i] + sigma[j]) / 2, np.sqrt(epsilon[i] * epsilon[j]), r, _switch(force, r))
    field, smooth = 0.0, np.ones(count, dtype=bool)
    if method != force.NoCutoff:
        end, dielectric = force.getCutoffDistance()._value, force.getReactionFieldDielectric()
        field = (dielectric - 1) / (2 * dielectric + 1) / end**3
        smooth[pairs[r > end - _CROSSED].ravel()] = False
        beyond = _pairs(force, positions, box, _CROSSED)
        smooth[beyond[_apart(positions, beyond, box)[1] > end].ravel()] = False
    first, second = first + scale * (2 * field * r - r**-2), second + scale * (2 * r**-3 + 2 * field)
    if len(held):
        wrapped = box if force.getExceptionsUsePeriodicBoundaryConditions() else None
        near, close = _apart(positions, held, wrapped)
        slope, bend = _lennard_jones(special[:, 1], special[:, 2], close, None)
        strength = _COULOMB * special[:, 0]
        pairs, apart, r = np.vstack([pairs, held]), np.vstack([apart, near]), np.concatenate([r, close])
        first = np.concatenate([first, slope - strength * close**-2])
        second = np.concatenate([second, bend + 2 * strength * close**-3])
    return _assembled(pairs, apart, r, first, second, count), smooth


@dataclass(frozen=True)
class Cut:
    """A NonbondedForce's pairs within its cutoff, whose forces jump where a pair crosses that: the parameters.

    ``box`` has the vectors of a periodic box by rows, ``field`` is that of the reaction field, ``ewald`` the parameter
    of direct space; one of the two at most is not 0. ``dispersion`` is the parameter of Ewald's sum of dispersion, 0
    where there is none.
    """

    force: Any
    end: float
    box: Doubles | None
    charge: Doubles
    sigma: Doubles
    epsilon: Doubles
    special: _Indices
    field: float
    ewald: float
    dispersion: float = 0.0

    def slope(self, pairs: _Indices, r: Doubles) -> Doubles:
        """E' of pairs as far apart as this, whether within the cutoff or somewhat beyond."""
        i, j = pairs.T
        sigma, epsilon = (self.sigma[i] + self.sigma[j]) / 2, np.sqrt(self.epsilon[i] * self.epsilon[j])
        found, _ = _lennard_jones(sigma, epsilon, r, _switch(self.force, r))
        gauss = 2 / np.sqrt(np.pi) * self.ewald * r * np.exp(-((self.ewald * r) ** 2))
        scale = _COULOMB * self.charge[i] * self.charge[j]
        if self.dispersion:
            # What the mesh has of it, by geometric means, is taken out: C (1 - exp(-y) (1 + y + y²/2))/r⁶, y = (b r)².
            y = (self.dispersion * r) ** 2
            taken = 4 * np.sqrt(self.epsilon[i] * self.epsilon[j]) * (self.sigma[i] * self.sigma[j]) ** 3
            part = 1 - np.exp(-y) * (1 + y + y**2 / 2)
            found = found + taken * (np.exp(-y) * y**3 - 6 * part) / r**7
        return np.asarray(found + scale * (2 * self.field * r - (special.erfc(self.ewald * r) + gauss) / r**2))

    def kept(self, positions: Doubles, reach: float) -> Kept | None:
        """What keeps each pair on its side of the cutoff while its distance changes by less than ``reach``. None where
        no pair is so near."""
        pairs = _shell(positions, self.box, self.end - reach, self.end + reach)
        pairs = pairs[~np.isin(_key(pairs, len(positions)), self.special)]
        if not len(pairs):
            return None
        was = _nearest(positions, pairs, self.box)[1] < self.end
        return _ByFormulas(self.box, self.end, pairs, was, self)


@dataclass(frozen=True)
class CustomCut:
    """A CustomNonbondedForce's pairs within its cutoff: what keeps them on their side is the force itself with a longer
    cutoff and without the pairs that stand outside."""

    force: Any
    system: Any
    end: float
    box: Doubles | None

    def kept(self, positions: Doubles, reach: float) -> Kept | None:
        """As :meth:`Cut.kept`; None, too, where a box is too narrow for a longer cutoff."""
        most = self.end + reach
        if self.box is not None and most > np.diag(self.box).min() / 2:
            return None
        # What stands within twice that beyond may come into the longer cutoff.
        pairs = _shell(positions, self.box, self.end - reach, most + reach)
        given = [self.force.getExclusionParticles(n) for n in range(self.force.getNumExclusions())]
        special = _key(np.array(given, dtype=np.int64).reshape(-1, 2), len(positions))
        pairs = pairs[~np.isin(_key(pairs, len(positions)), special)]
        apart = _nearest(positions, pairs, self.box)[1]
        if not (apart < most).any():
            return None
        longer = deepcopy(self.force)
        longer.setCutoffDistance(most)
        for i, j in pairs[apart >= self.end]:
            longer.addExclusion(int(i), int(j))
        forces = _alone(self.system, [longer]), _alone(self.system, [self.force])
        return _ByItself(self.box, self.end, pairs, apart < self.end, *forces)


@dataclass(frozen=True)
class Kept:
    """Pairs near a cutoff, and on which side of it they are kept; ``was`` says which are within.

    A call gives the force of those that have left, less that of those that have come in: with it forces are smooth, and
    their derivative at the positions is the Hessian of what acts there.
    """

    box: Doubles | None
    end: float
    pairs: _Indices
    was: _Mask

    def __call__(self, at: Doubles) -> Doubles:
        raise NotImplementedError

    def crossed(self, at: Doubles) -> tuple[list[tuple[int, int]], Doubles]:
        """The pairs that are kept on a side where they are not, and how far they are from it."""
        _, r = _nearest(at, self.pairs, self.box)
        off = (r < self.end) != self.was
        return [(int(i), int(j)) for i, j in self.pairs[off]], np.abs(r[off] - self.end)


@dataclass(frozen=True)
class _ByFormulas(Kept):
    cut: Cut

    def __call__(self, at: Doubles) -> Doubles:
        apart, r = _nearest(at, self.pairs, self.box)
        crossed = (r < self.end) != self.was
        pairs, r = self.pairs[crossed], r[crossed]
        size = np.where(self.was[crossed], 1.0, -1.0) * self.cut.slope(pairs, r) / r
        added = np.zeros_like(at)
        np.add.at(added, pairs[:, 0], -size[:, None] * apart[crossed])
        np.add.at(added, pairs[:, 1], size[:, None] * apart[crossed])
        return added


@dataclass(frozen=True)
class _ByItself(Kept):
    longer: Force
    plain: Force

    def __call__(self, at: Doubles) -> Doubles:
        return self.longer(at) - self.plain(at)


def _nearest(positions: Doubles, pairs: _Indices, box: Doubles | None) -> tuple[Doubles, Doubles]:
    """Between nearest images, as OpenMM has them: along the last vector of the box first."""
    apart = positions[pairs[:, 0]] - positions[pairs[:, 1]]
    if box is not None:
        for k in (2, 1, 0):
            apart = apart - np.round(apart[:, k] / box[k, k])[:, None] * box[k]
    return apart, np.linalg.norm(apart, axis=1)


def cut(force: Any, context: Any) -> Cut | CustomCut | None:
    """The cutoff of a NonbondedForce or CustomNonbondedForce. None if it has none, if it goes to 0 smoothly, or if its
    pairs are not known here, as with offsets of parameters."""
    system, method = context.getSystem(), force.getNonbondedMethod()
    vectors = np.array([list(vector._value) for vector in context.getState().getPeriodicBoxVectors()])
    is_periodic = method != force.CutoffNonPeriodic
    if method == force.NoCutoff:
        return None
    if isinstance(force, mm.CustomNonbondedForce):
        # A switching function leaves neither a force nor a stiffness at the cutoff.
        is_switched = force.getUseSwitchingFunction()
        end = force.getCutoffDistance()._value
        return None if is_switched else CustomCut(force, system, end, vectors if is_periodic else None)
    if force.getNumGlobalParameters():
        return None
    count, end = system.getNumParticles(), force.getCutoffDistance()._value
    charge, sigma, epsilon = np.array([_plain(force.getParticleParameters(n)) for n in range(count)]).T
    given = [force.getExceptionParameters(n)[:2] for n in range(force.getNumExceptions())]
    special = _key(np.array(given, dtype=np.int64).reshape(-1, 2), count)
    field, ewald = 0.0, 0.0
    if method in (force.CutoffNonPeriodic, force.CutoffPeriodic):
        dielectric = force.getReactionFieldDielectric()
        field = (dielectric - 1) / (2 * dielectric + 1) / end**3
    elif method in (force.PME, force.LJPME):
        ewald = float(force.getPMEParametersInContext(context)[0])
    else:
        ewald = float(np.sqrt(-np.log(2 * force.getEwaldErrorTolerance())) / end)
    dispersion = float(force.getLJPMEParametersInContext(context)[0]) if method == force.LJPME else 0.0
    return Cut(force, end, vectors if is_periodic else None, charge, sigma, epsilon, special, field, ewald, dispersion)


def _shell(positions: Doubles, box: Doubles | None, least: float, most: float) -> _Indices:
    """All pairs as far apart as that, the smaller number first, of images in a box of these vectors."""
    names, places = np.arange(len(positions)), positions
    inside: _Mask = np.ones(len(positions), dtype=bool)
    if box is not None:
        # Images that stand no farther outside the cell than a pair reaches.
        part = positions @ np.linalg.inv(box)
        part -= np.floor(part)
        margin = most * np.linalg.norm(np.linalg.inv(box), axis=0)
        images = [part + shift for shift in np.indices((3, 3, 3)).reshape(3, -1).T - 1]
        kept = [np.flatnonzero(((image > -margin) & (image < 1 + margin)).all(axis=1)) for image in images]
        names = np.concatenate(kept)
        parts = np.concatenate([image[each] for image, each in zip(images, kept, strict=True)])
        places, inside = parts @ box, np.asarray(((parts >= 0) & (parts < 1)).all(axis=1))
    pairs = spatial.cKDTree(places).query_pairs(most, output_type="ndarray")
    pairs = pairs[inside[pairs].any(axis=1)]
    pairs = pairs[np.linalg.norm(places[pairs[:, 0]] - places[pairs[:, 1]], axis=1) > least]
    pairs = np.sort(names[pairs], axis=1).astype(np.int64)
    return np.unique(pairs[pairs[:, 0] < pairs[:, 1]], axis=0)


def _plain(quantities: Sequence[Any]) -> list[float]:
    return [float(quantity._value) for quantity in quantities]


def _box(system: Any) -> Doubles:
    """The edges of a rectangular box, nm."""
    vectors = np.array([list(vector._value) for vector in system.getDefaultPeriodicBoxVectors()])
    if np.any(vectors != np.diag(np.diag(vectors))):
        raise KickdriftError("system", "a triclinic box", "has no sparse Hessian here: choose a rectangular one")
    return np.diag(vectors).copy()


def _key(pairs: _Indices, count: int) -> _Indices:
    return np.asarray(pairs.min(axis=1, initial=count) * count + pairs.max(axis=1, initial=0))


def _pairs(force: Any, positions: Doubles, box: Doubles | None, beyond: float = 0.0) -> _Indices:
    """All pairs within the cutoff, or so far beyond it."""
    if force.getNonbondedMethod() == force.NoCutoff:
        return np.column_stack(np.triu_indices(len(positions), 1)).astype(np.int64)
    places = positions if box is None else np.mod(positions, box)
    tree = spatial.cKDTree(places, boxsize=box)
    return np.asarray(
        tree.query_pairs(force.getCutoffDistance()._value + beyond, output_type="ndarray"), dtype=np.int64
    )


def _apart(positions: Doubles, pairs: _Indices, box: Doubles | None) -> tuple[Doubles, Doubles]:
    apart = positions[pairs[:, 0]] - positions[pairs[:, 1]]
    if box is not None:
        apart -= box * np.round(apart / box)
    return apart, np.linalg.norm(apart, axis=1)


_Switch = tuple[Doubles, Doubles, Doubles]


def _switch(force: Any, r: Doubles) -> _Switch | None:
    """1 - 10 x³ + 15 x⁴ - 6 x⁵ and its two derivatives by r, x from 0 where the switching begins to 1 at the cutoff."""
    # OpenMM 8 sums dispersion by Ewald's method without the switching function, whatever is set.
    is_without = force.getNonbondedMethod() in (force.NoCutoff, force.LJPME)
    if is_without or not force.getUseSwitchingFunction():
        return None
    begin, end = force.getSwitchingDistance()._value, force.getCutoffDistance()._value
    x, width = np.clip((r - begin) / (end - begin), 0.0, 1.0), end - begin
    first = -30 * x**2 * (1 - x) ** 2 / width
    second = -60 * x * (1 - x) * (1 - 2 * x) / width**2
    return 1 - x**3 * (10 - 15 * x + 6 * x**2), first, second


def _lennard_jones(sigma: Doubles, epsilon: Doubles, r: Doubles, switch: _Switch | None) -> tuple[Doubles, Doubles]:
    """E' and E''."""
    sixth = (sigma / r) ** 6
    energy = 4 * epsilon * sixth * (sixth - 1)
    first = 4 * epsilon * sixth * (6 - 12 * sixth) / r
    second = 4 * epsilon * sixth * (156 * sixth - 42) / r**2
    if switch is None:
        return first, second
    value, slope, bend = switch
    return value * first + slope * energy, value * second + 2 * slope * first + bend * energy


def _assembled(pairs: _Indices, apart: Doubles, r: Doubles, first: Doubles, second: Doubles, count: int) -> Any:
    """The sum of pair blocks (E'' - E'/r) e eᵀ + E'/r."""
    along = (second - first / r) / r**2
    kept = (along != 0) | (first != 0)
    pairs, apart, along, across = pairs[kept], apart[kept], along[kept], (first / r)[kept]
    blocks = along[:, None, None] * apart[:, :, None] * apart[:, None, :] + across[:, None, None] * np.eye(3)
    i, j = pairs.T
    # Places of blocks, in the order of rows: -block at (i, j) and (j, i); numbers from 1, since no entry may be 0.
    numbers = np.arange(1, len(i) + 1)
    places = sparse.csr_matrix(
        (np.concatenate([numbers, numbers]), (np.concatenate([i, j]), np.concatenate([j, i]))), shape=(count, count)
    )
    places.sort_indices()
    beside = sparse.bsr_matrix((-blocks[places.data - 1], places.indices, places.indptr), shape=(3 * count, 3 * count))
    corners = np.empty((count, 3, 3))
    for a in range(3):
        for b in range(3):
            corners[:, a, b] = sum(np.bincount(side, weights=blocks[:, a, b], minlength=count) for side in (i, j))
    diagonal = sparse.bsr_matrix((corners, np.arange(count), np.arange(count + 1)), shape=(3 * count, 3 * count))
    return (beside + diagonal).tocsr()


#: How many random displacements a Hessian by formulas is compared with differences for, and how long they are, nm: of
#: forces of 1e4 kJ/mol/nm doubles leave 1e-5 kJ/mol/nm² unknown then, and few pairs are so near a cutoff.
_LOOKS, _LOOK = 3, 1e-6

#: Two atoms displaced by 2 looks in each coordinate come nearer by less.
_CROSSED = 8 * _LOOK


def _seen(matrix: Any, force: Force, positions: Doubles, smooth: _Mask) -> float:
    """How far differences of forces are from the matrix where each coordinate is displaced by ± a look.

    The largest distance of an atom's force from that of the matrix, over the look.

    Forces jump where a pair crosses the cutoff, which no Hessian knows: atoms of such pairs are left out.
    """
    random = np.random.default_rng(1)
    worst = 0.0
    for _ in range(_LOOKS):
        signs = random.choice([-1.0, 1.0], size=positions.shape)
        near, far = (
            (force(positions - part * _LOOK * signs) - force(positions + part * _LOOK * signs)) / (2 * part)
            for part in (1, 2)
        )
        product = (matrix @ signs.ravel()).reshape(positions.shape)
        measured = (4 * near - far) / (3 * _LOOK)
        worst = max(worst, float(np.linalg.norm((measured - product)[smooth], axis=1).max(initial=0.0)))
    return worst
