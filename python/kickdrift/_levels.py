"""The shortest period of each level of forces, of any number of atoms, and which steps are safe with them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import numpy as np

from kickdrift._advice import Advice, Engine, Time
from kickdrift._covered import Modes
from kickdrift._errors import KickdriftError
from kickdrift._lanczos import FAILS
from kickdrift._native import motions
from kickdrift._numbers import Exact
from kickdrift._periods import advise_periods
from kickdrift._rigid import Doubles

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
        labels = [
            self.labels[n] if is_numbered else _kind(self.labels[n])
            for n, is_numbered in zip(kept, numbered, strict=True)
        ]
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
    kept = sorted({int(atom) for molecule in modes.shown.values() for atom in molecule.atoms})
    alone = {int(atom) for molecule in modes.shown.values() if molecule.count == 1 for atom in molecule.atoms}
    places = {atom: 3 * k for k, atom in enumerate(kept)}
    stacks, begin = [], 0
    for end in ends:
        rows = []
        for molecule in modes.shown.values():
            chosen = (molecule.values <= values[begin]) & (molecule.values >= values[end - 1])
            columns = np.array([places[int(atom)] for atom in molecule.atoms])[:, None] + np.arange(3)
            stack = np.zeros((int(chosen.sum()), 3 * len(kept)))
            stack[:, columns.ravel()] = molecule.vectors[:, chosen].T
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
        if named := [str(group) for group in self.groups if group.name]:
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
        kicked = [level for level in self.levels if level.period is not None]
        if not kicked:
            raise KickdriftError("system", "no force", "nothing vibrates: give forces on what constraints leave free")
        scheme = [f"{1000 * level.step}fs" for level in kicked]
        is_one = isinstance(steps, str) or not all(isinstance(step, list | tuple) for step in steps)
        alone = steps.split(",") if isinstance(steps, str) else steps
        beside = [] if not steps else [alone] if is_one else list(steps)
        found = advise_periods(
            # Down to the digits that are written.
            {level.title: f"{np.floor(1e5 * (level.period or 0.0)) / 1e5:.5f}fs" for level in kicked},
            [scheme, *beside],
            engine,
            (band, length, friction, None, None),
            on={level.title: place + 1 for place, level in enumerate(kicked)},
            levers=levers,
            harmonic=harmonic,
            # All, but for the probability that stands above.
            all_modes=True,
        )
        looked = [f"  looked at  {level}" for level in self.levels]
        notes = [f"  note       {note}" for note in self.notes]
        before = "\n".join([self._told(), *looked, *notes, ""])
        told: Advice = replace(found, _text=before + str(found), _details=before + found.details)
        return told
