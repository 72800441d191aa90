"""Groups of forces with a step each, as ASE and LAMMPS give them: their Hessians at a minimum, and along the orbit."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from kickdrift._cost import SOUGHT, Work, seconds_of
from kickdrift._errors import KickdriftError
from kickdrift._held import Held
from kickdrift._hessians import Force, hessian, seen
from kickdrift._minimum import cooled, minimum
from kickdrift._monodromy import Followed, Monodromy, unbalanced
from kickdrift._orbit import monodromy
from kickdrift._progress import Progress, shown
from kickdrift._rigid import Doubles, is_held, norm, off_the_mesh, rigid_motions
from kickdrift._system import System


@dataclass(frozen=True, eq=False)
class Groups:
    """Forces of particles without held distances, mass·length/time² at positions (n, 3), and what they are in.

    Attributes
    ----------
    forces : mapping of str to callable
        By name.
    steps : sequence of Fraction
        One for each force.
    masses, where : array, shape (n,) and (n, 3)
        Where they stand, or the minimum is sought from.
    time, length : str
        The units of the steps and of positions.
    force : (str, float)
        The unit of forces, and how many of it a mass·length/time² is.
    labels : sequence of str
        One for each particle.
    is_boxed : bool
        Whether the cell is periodic.
    has_mesh : bool
        Whether some force is summed on a mesh, which pulls a little at the whole: no field.
    session : callable
        The context in which forces are asked for.
    """

    forces: Mapping[str, Force]
    steps: Sequence[Fraction]
    masses: Doubles
    where: Doubles
    time: str
    length: str
    force: tuple[str, float]
    labels: Sequence[str] = ()
    is_boxed: bool = False
    has_mesh: bool = False
    session: Callable[[], AbstractContextManager[None]] = nullcontext

    def system(
        self,
        minimize: bool,
        difference: float,
        progress: Progress | bool,
        symmetric: bool,
        longest: float,
        notes: Sequence[str] = (),
    ) -> System:
        """The Hessian of each group at the minimum of all, with its measured error."""
        sought = SOUGHT * len(self.forces) if minimize else 0
        with self.session():
            evaluation = self._evaluation()
            Work(self.where.size, len(self.forces), evaluation, sought).begin(longest, progress is True, "fewer atoms")
            where = self._start(minimize, difference, progress)
            seen_by = shown(progress)
            measured = {
                name: hessian(force, where, self.masses, difference, None, seen_by, symmetric)
                for name, force in self.forces.items()
            }
            forces = {name: force(where) for name, force in self.forces.items()}
        width = f"{difference:g} {self.length}"
        accuracy = max(seen(*pair, name, width) for name, pair in measured.items())
        unit, scale = self.force
        pulls = {name: force * scale for name, force in forces.items()}
        total = np.sum([matrix for matrix, _ in measured.values()], axis=0)
        follow = "Ask oscillations(...) for what grows about that orbit, as a run shows it"
        beside = unbalanced(pulls, norm(total) * scale, self.masses, unit, follow)
        moved = rigid_motions(where, self.masses, rotations=False)
        matrices = [matrix for matrix, _ in measured.values()]
        held = not self.has_mesh and is_held(matrices, moved, sum(error for _, error in measured.values()))
        root = np.sqrt(np.repeat(self.masses, 3))
        potentials, beside = {}, list(beside)
        for (name, (matrix, _)), step in zip(measured.items(), self.steps, strict=True):
            kept = (matrix + matrix.T) / 2 if symmetric else matrix
            if self.has_mesh:
                kept = off_the_mesh(kept, moved, name, accuracy, beside)
            potentials[name] = (step, kept * np.outer(root, root))
        made = System.from_hessians(
            self.masses,
            potentials,
            positions=None if held else where,
            accuracy=accuracy,
            title=f"{len(self.masses)} atoms, {self.time or 'time'} and {self.length}",
            time_unit=self.time,
            labels=self.labels,
            forces=None if held else forces,
            notes=[*notes, *beside],
            periodic=self.is_boxed,
            keep_rigid=held,
            symmetric=symmetric,
        )
        if not symmetric:
            return made

        def find() -> Monodromy:
            return replace(self, where=where).oscillations("orbit", False, difference, None)

        work = Work.of_period(self.where.size, self.steps, evaluation, "orbit")
        outer = f"{float(max(self.steps)):g} {self.time}".rstrip()
        return replace(made, _orbit=Followed.beside(work, beside, find, outer, self.length))

    def oscillations(
        self,
        about: str,
        minimize: bool,
        difference: float,
        unit: str | None,
        progress: Progress | bool = False,
        longest: float = np.inf,
    ) -> Monodromy:
        """What small deviations do over a period; without a ``unit`` an orbit that is not found at once is not followed
        from shorter steps."""
        sought = SOUGHT * len(self.forces) if minimize else 0
        with self.session():
            work = Work.of_period(self.where.size, self.steps, self._evaluation(), about, sought)
            work.begin(longest, progress is True, "fewer atoms")
            return monodromy(
                self.forces,
                self.steps,
                self._start(minimize, difference, progress),
                Held(self.masses),
                difference,
                about,
                unit,
                shown(progress, "Hessians of half a period"),
                time_unit=self.time,
                is_boxed=self.is_boxed,
                has_mesh=self.has_mesh,
            )

    def _evaluation(self) -> float:
        """Seconds that a group's force takes, their mean."""
        return sum(seconds_of(force, self.where) for force in self.forces.values()) / len(self.forces)

    def _start(self, minimize: bool, difference: float, progress: Progress | bool) -> Doubles:
        if not minimize:
            return self.where
        every, seen_by = list(self.forces.values()), shown(progress, "columns on the way to the minimum")

        def whole(at: Doubles) -> Doubles:
            return np.asarray(np.sum([force(at) for force in every], axis=0))

        held = Held(self.masses)

        def newton(near: Doubles, far: float) -> Doubles:
            return minimum(whole, near, held, difference, is_boxed=self.has_mesh, far=far, progress=seen_by)[0]

        try:
            return newton(self.where, _CLOSE * difference)
        except (KickdriftError, np.linalg.LinAlgError):
            return newton(cooled(whole, self.where, held, difference), np.inf)


#: How many differences of positions Newton's method alone may go: 0.5 Å.
_CLOSE = 500
