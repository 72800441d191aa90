"""The stiffest motions of each level of forces, of any number of atoms: of bonded terms all of them, molecule by
molecule, of other forces the stiffest by Lanczos' method, without a Hessian.

Mass-weighted. Of a symmetric matrix with eigenvalues from a to b, k steps from a random direction find a largest Ritz
value t with b - t <= e (b - a), but for a probability of at most 1.648 sqrt(n) exp(-(2 k - 1) sqrt(e)) (Kuczynski and
Wozniakowski, SIAM J. Matrix Anal. Appl. 13, 1992, theorem 4.2, whose matrices are definite; adding a multiple of 1
changes no step). The same holds at the lower end.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np

from kickdrift._advise import Advice, Engine, Time, advise
from kickdrift._errors import KickdriftError, needs
from kickdrift._held import Held
from kickdrift._hessians import Force, smooth
from kickdrift._native import motions
from kickdrift._numbers import Exact
from kickdrift._rigid import Doubles

if TYPE_CHECKING:
    from kickdrift._covered import Modes

Product = Callable[[Doubles], Doubles]

#: How often Lanczos' bound may fail.
FAILS = 1e-3


@dataclass(frozen=True)
class Top:
    """The upper end of a spectrum: at most ``most``, but for a probability of :data:`FAILS`; at least ``found``."""

    found: float
    most: float
    vector: Doubles


def top(apply: Product, size: int, steps: int) -> Top:
    """The upper end of a symmetric matrix's spectrum by so many products with it, from one random direction."""
    vector = np.random.default_rng(1).normal(size=size)
    basis, diagonal, beside = [vector / np.linalg.norm(vector)], [], []
    for _ in range(min(steps, size)):
        image = apply(basis[-1])
        diagonal.append(float(image @ basis[-1]))
        known = np.array(basis)
        # Twice, so that rounding leaves them orthogonal.
        for _ in range(2):
            image = image - known.T @ (known @ image)
        length = float(np.linalg.norm(image))
        if length <= 1e-12 * max(np.abs(diagonal)):
            break
        beside.append(length)
        basis.append(image / length)
    count = len(diagonal)
    inner = np.diag(diagonal) + sum(np.diag(beside[: count - 1], side) for side in (-1, 1))
    values, vectors = np.linalg.eigh(inner)
    # Each end fails half as often as both may.
    missed = (np.log(1.648 * np.sqrt(size) * 2 / FAILS) / (2 * count - 1)) ** 2
    if len(beside) < count:
        # What the products reach from a random direction is all there is.
        missed = 0.0
    if missed >= 0.25:
        raise KickdriftError("steps", str(count), "of Lanczos' method are too few to bound anything")
    beyond = missed * float(values[-1] - values[0]) / (1 - 2 * missed)
    return Top(float(values[-1]), float(values[-1]) + beyond, np.array(basis[:count]).T @ vectors[:, -1])


def _sparse() -> tuple[Any, Any]:
    """SciPy's sparse matrices and their factors, which nothing but held distances asks for."""
    try:
        import scipy.sparse as sparse
        from scipy.sparse.linalg import splu
    except ImportError:
        raise needs("scipy") from None
    return sparse, splu


def projection(held: Held, where: Doubles) -> Product:
    """Onto the deviations that held distances leave free, by sparse factors: thousands of them are no matter."""
    if not held.distances:
        return lambda vector: vector
    gradients, solve = _gradients(held, where)
    return lambda vector: np.asarray(vector - gradients.T @ solve(gradients @ vector))


def _gradients(held: Held, where: Doubles) -> tuple[Any, Product]:
    """The gradients of held distances, one a row, and what solves with them times their transpose."""
    sparse, splu = _sparse()
    i, j = (np.array([own[k] for own in held.distances]) for k in (0, 1))
    apart, axes, rows = where[i] - where[j], np.tile(np.arange(3), len(i)), np.repeat(np.arange(len(i)), 3)
    places = np.concatenate([3 * i.repeat(3) + axes, 3 * j.repeat(3) + axes])
    values = np.concatenate([apart.ravel(), -apart.ravel()]) / held.root[places]
    gradients = sparse.csr_matrix((values, (np.concatenate([rows, rows]), places)), shape=(len(i), where.size))
    try:
        return gradients, splu((gradients @ gradients.T).tocsc()).solve
    except RuntimeError as cause:
        raise KickdriftError("system", f"{len(i)} constraints", "depend on each other: leave those out") from cause


def curvature(held: Held, where: Doubles, force: Doubles) -> Any:
    """What held distances add to a Hessian, as :meth:`Held.curvature` says: a sparse matrix, 0 where none are held."""
    sparse, _ = _sparse()
    if not held.distances:
        return sparse.csr_matrix((where.size, where.size))
    gradients, solve = _gradients(held, where)
    factors = solve(gradients @ (force.ravel() / held.root))
    i, j = (np.array([own[k] for own in held.distances]) for k in (0, 1))
    values, places = [factors, factors, -factors, -factors], ([i, j, i, j], [i, j, j, i])
    rows, columns = (np.concatenate(own) for own in places)
    blocks = sparse.csr_matrix((np.concatenate(values), (rows, columns)), shape=(len(where), len(where)))
    weights = sparse.diags(1 / held.root)
    return (weights @ sparse.kron(blocks, sparse.identity(3)) @ weights).tocsr()


def weighted(matrix: Any, root: Doubles) -> Any:
    """The mass-weighted matrix of one that is not."""
    weights = _sparse()[0].diags(1 / root)
    return (weights @ matrix @ weights).tocsr()


def by_differences(force: Force, where: Doubles, root: Doubles, difference: float) -> Product:
    """The product of a mass-weighted Hessian by two forces, no atom displaced by more than ``difference``."""
    # Both atoms of a pair may go their own way.
    force = smooth(force, where, 2 * difference)

    def product(vector: Doubles) -> Doubles:
        moved = (vector / root).reshape(where.shape)
        size = float(np.linalg.norm(moved, axis=1).max())
        step = difference / size * moved
        apart = (force(where - step) - force(where + step)).ravel() / root
        return np.asarray(apart * size / (2 * difference))

    return product


_COVERED = (
    "steps below the first unstable interval hold for all motions of these levels together, at a minimum of all "
    "forces (proofs/REGION.md); an unstable interval is one of two single motions, and need not be one of this system"
)

#: Modes are told as one where each period is within this of the next, up to so many; those whose frequency is below
#: this part of the highest are none of the level. As :meth:`System.advise` tells them.
_NEIGHBOUR, _MOST_GROUPS, _NO_MODE = 1.03, 12, 1e-2


@dataclass(frozen=True)
class Group:
    """Modes of nearly one period, fs, and what they are called: nothing where neither bonds nor angles have most of
    them."""

    name: str
    count: int
    shortest: float
    longest: float

    def __str__(self) -> str:
        ends = dict.fromkeys(f"{period:.4g}" for period in (self.shortest, self.longest))
        count = f"{self.count:,} modes, " if self.count != 1 else ""
        return f"{self.name} ({count}{'-'.join(ends)} fs)"


@dataclass(frozen=True)
class Atoms:
    """What atoms are called, where they are, and who is bonded to whom: by which motions have their names."""

    labels: Sequence[str]
    elements: Sequence[str]
    bonds: Sequence[tuple[int, int]]
    where: Doubles
    masses: Doubles

    def kinds(self) -> list[str]:
        """Each atom's label without the number of its residue."""
        return [_kind(label) for label in self.labels]

    def motions(self, kept: Sequence[int], groups: Sequence[Doubles], numbered: Sequence[bool]) -> list[str | None]:
        """The names of groups of modes, a row each, of these atoms; of others than ``numbered`` residues none tells
        which."""
        place = {int(atom): k for k, atom in enumerate(kept)}
        bonds = [[place[i], place[j]] for i, j in self.bonds if i in place and j in place]
        labels = [self.labels[n] if own else _kind(self.labels[n]) for n, own in zip(kept, numbered, strict=True)]
        elements = [self.elements[n] for n in kept] if self.elements else []
        return motions(labels, elements, bonds, self.where[list(kept)], self.masses[list(kept)], list(groups))


def _kind(label: str) -> str:
    words = label.split()
    return " ".join(words[:2]) if len(words) == 3 else words[0] if words else ""


def groups_of(modes: Modes, atoms: Atoms) -> tuple[Group, ...]:
    """The modes of nearly one period, the fastest first, by the stiffest molecule of each kind."""
    if not modes.shown:
        return ()
    values = np.sort(modes.values)[::-1]
    values = values[values > _NO_MODE**2 * modes.largest]
    periods = 2000 * np.pi / np.sqrt(values)
    ends = [*np.flatnonzero(periods[1:] > _NEIGHBOUR * periods[:-1]) + 1, len(periods)][:_MOST_GROUPS]
    kept = sorted({int(atom) for own in modes.shown.values() for atom in own.atoms})
    alone = {int(atom) for own in modes.shown.values() if own.count == 1 for atom in own.atoms}
    places = {atom: 3 * k for k, atom in enumerate(kept)}
    stacks, begin = [], 0
    for end in ends:
        rows = []
        for own in modes.shown.values():
            chosen = (own.values <= values[begin]) & (own.values >= values[end - 1])
            columns = np.array([places[int(atom)] for atom in own.atoms])[:, None] + np.arange(3)
            stack = np.zeros((int(chosen.sum()), 3 * len(kept)))
            stack[:, columns.ravel()] = own.vectors[:, chosen].T
            rows.append(stack)
        stacks.append(np.concatenate(rows)[:_NAMED])
        begin = end
    names = atoms.motions(kept, stacks, [atom in alone for atom in kept])
    begins = [0, *ends[:-1]]
    return tuple(
        Group(name or "", modes.count(values[end - 1], values[begin]), float(periods[begin]), float(periods[end - 1]))
        for name, begin, end in zip(names, begins, ends, strict=True)
    )


#: So many of a group's modes give it its name.
_NAMED = 300


@dataclass(frozen=True)
class Band:
    """A level of forces: its step, and the shortest period that is found in it.

    Attributes
    ----------
    stiffness, most : float
        What the stiffest motion has at least and at most, 1/ps²: by windows, by the probability's theorem, and by what
        differences leave; of molecules that are seen whole but for rounding the same.
    atoms : str
        Who moves most in it.
    forces : int
        How many were asked for; 0 where the level's Hessian is known.
    looked : str
        What else was looked at.
    motion : str
        What the stiffest motion is called.
    groups : tuple of Group
        All modes of a level of bonded terms, the fastest first; empty where Lanczos' method found the stiffest alone.
    """

    name: str
    step: Fraction
    stiffness: float
    most: float
    atoms: str
    forces: int
    looked: str = "the Hessian of all bonded terms"
    motion: str = ""
    groups: tuple[Group, ...] = ()

    @property
    def period(self) -> float | None:
        """fs, no shorter one; of Lanczos' method but for a probability of :data:`FAILS`. None where no force acts on
        what is free."""
        return 2000 * np.pi / np.sqrt(self.most) if self.most > 0 else None

    @property
    def is_whole(self) -> bool:
        """Whether all modes are known, so that no probability stands in the way."""
        return bool(self.groups)

    def __str__(self) -> str:
        if self.period is None:
            return f"{self.name}, every {1000 * float(self.step):g} fs: no force on what is free"
        known = 100 * (self.most / self.stiffness - 1) if self.stiffness > 0 else np.inf
        how = f"{self.forces} forces on all atoms" if self.forces else self.looked
        period = f"T >= {self.period:.5g} fs by {how}, the stiffness known to {known:.2g} %"
        begin = f"{self.name}, every {1000 * float(self.step):g} fs: {period}"
        if named := [str(own) for own in self.groups if own.name]:
            return f"{begin}: {'; '.join(named[:_TOLD])}"
        told = [self.motion, f"{self.atoms} moving most" if self.atoms else ""]
        return "; ".join([begin, *filter(None, told)])

    @property
    def title(self) -> str:
        """What the stiffest motion is called in advice, without the signs that part names there."""
        motion = self.motion.replace(", ", "/").translate(_PARTING)
        return f"{motion} in {self.name}" if motion else self.name


#: Groups that a line of text has, and what no name may have.
_TOLD, _PARTING = 4, str.maketrans("=:,", "   ")


@dataclass(frozen=True)
class Bands:
    """The shortest period of each level of a system of any size; :func:`kickdrift.openmm.bands` finds them.

    What follows for steps is proven for the periods, and these are estimated: so is the advice. The region below the
    first unstable step of one mass under the stiffest force of each level holds for any number of coupled motions whose
    forces are no stiffer, at a minimum of all forces, whatever their couplings (proofs/REGION.md).

    Attributes
    ----------
    levels : tuple of Band
        The innermost first.
    notes : tuple of str
        What is left out, and what was looked at.
    """

    levels: tuple[Band, ...]
    notes: tuple[str, ...] = ()

    def _told(self) -> str:
        """What the advice rests on."""
        asked = [level.name for level in self.levels if not level.is_whole and level.period is not None]
        if not asked:
            return f"estimated: all modes of each level, in doubles; {_COVERED}"
        who = " and ".join(asked)
        how = f"by Lanczos' method, which misses it with a probability of {FAILS:.1%} at most"
        return f"estimated: the stiffest motion of {who} {how}; {_COVERED}"

    def advise(
        self,
        steps: str | Sequence[Any] = (),
        *,
        engine: Engine | None = None,
        band: Exact = "5%",
        length: Time | None = None,
        friction: Exact | None = None,
        constraints: str | None = None,
        hmr: Exact | None = None,
        levers: bool = False,
        harmonic: bool = False,
    ) -> Advice:
        """Which outer steps are safe for these bands, as :func:`kickdrift.advise` of periods says.

        With an ``engine``'s input its steps are the first scheme.

        Raises
        ------
        KickdriftError
            ``constraints`` and ``hmr``, which change the motions themselves: they belong to what finds these.
        """
        for field, value in {"constraints": constraints, "hmr": hmr}.items():
            if value is not None:
                remedy = (
                    "changes the motions: give it to kickdrift.openmm.bands, or to kickdrift.advise of OpenMM's system"
                )
                raise KickdriftError(field, str(value), remedy)
        # Kicks of no force are none.
        own = [level for level in self.levels if level.period is not None]
        if not own:
            raise KickdriftError("system", "no force", "nothing vibrates: give forces on what constraints leave free")
        scheme = [f"{1000 * level.step}fs" for level in own]
        is_one = isinstance(steps, str) or not all(isinstance(own, list | tuple) for own in steps)
        alone = steps.split(",") if isinstance(steps, str) else steps
        beside = [] if not steps else [alone] if is_one else list(steps)
        found = advise(
            # Down to the digits that are written.
            {level.title: f"{np.floor(1e5 * (level.period or 0.0)) / 1e5:.5f}fs" for level in own},
            steps=[scheme, *beside],
            on={level.title: place + 1 for place, level in enumerate(own)},
            engine=engine,
            band=band,
            length=length,
            friction=friction,
            levers=levers,
            harmonic=harmonic,
            # All, but for the probability that stands above.
            all_modes=True,
        )
        looked = [f"  looked at  {level}" for level in self.levels]
        notes = [f"  note       {note}" for note in self.notes]
        told: Advice = replace(found, _text="\n".join([self._told(), *looked, *notes, str(found)]))
        return told
