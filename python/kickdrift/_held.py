"""Held distances: what they leave free, the curvature they bring, and drifts that keep them.

Mass-weighted, y = M^½ r. A held distance is g = (|r_i - r_j|² - d²)/2 = 0, which is quadratic: its second derivatives
are the same everywhere, so a drift that holds it has exact derivatives, without differences.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from kickdrift._errors import KickdriftError
from kickdrift._rigid import Doubles


@dataclass(frozen=True, eq=False)
class Held:
    """Distances (i, j, d) held among particles of these masses; there may be none."""

    masses: Doubles
    distances: Sequence[tuple[int, int, float]] = ()

    @cached_property
    def root(self) -> Doubles:
        """The root of each coordinate's mass."""
        return np.asarray(np.sqrt(np.repeat(self.masses, 3)), dtype=np.float64)

    def gradients(self, where: Doubles) -> Doubles:
        """The gradients of g by y, one a row."""
        rows = np.zeros((len(self.distances), where.size))
        for row, (i, j, _) in zip(rows, self.distances, strict=True):
            apart = where[i] - where[j]
            row[3 * i : 3 * i + 3], row[3 * j : 3 * j + 3] = apart, -apart
        return rows / self.root

    def frame(self, where: Doubles, chosen: Sequence[int] | None = None) -> Doubles:
        """An orthonormal basis of the deviations that are left free, of the chosen coordinates."""
        kept = np.arange(where.size) if chosen is None else np.asarray(chosen)
        if not self.distances:
            return np.eye(len(kept))
        _, sizes, vectors = np.linalg.svd(self.gradients(where)[:, kept])
        rank = int((sizes > 1e-10 * sizes.max()).sum())
        return np.asarray(vectors[rank:].T)

    def bent(self, factors: Doubles) -> Doubles:
        """The sum of factors times the second derivatives of g."""
        blocks = np.zeros((len(self.masses), len(self.masses)))
        for factor, (i, j, _) in zip(factors, self.distances, strict=True):
            blocks[i, i] += factor / self.masses[i]
            blocks[j, j] += factor / self.masses[j]
            blocks[i, j] -= factor / np.sqrt(self.masses[i] * self.masses[j])
            blocks[j, i] -= factor / np.sqrt(self.masses[i] * self.masses[j])
        return np.asarray(np.kron(blocks, np.eye(3)))

    def along(self, pull: Doubles, where: Doubles, chosen: Sequence[int] | None = None) -> Doubles:
        """The factors of the gradients in a mass-weighted vector: what is held takes that part up. What is not chosen
        stands still whatever pulls it."""
        if not self.distances:
            return np.zeros(0)
        kept = np.arange(where.size) if chosen is None else np.asarray(chosen)
        return np.asarray(np.linalg.lstsq(self.gradients(where)[:, kept].T, pull[kept], rcond=None)[0])

    def curvature(self, force: Doubles, where: Doubles, chosen: Sequence[int] | None = None) -> Doubles:
        """What is held adds to a group's Hessian: its forces turn as the atoms move.

        The group's force along the gradients is sum of l_c grad g_c. What is held takes it up, so the force left is
        that of the Hessian K + sum of l_c grad grad g_c, since the forces of what is held are -l_c grad g_c.
        """
        kept = np.arange(where.size) if chosen is None else np.asarray(chosen)
        return np.asarray(self.bent(self.along(force.ravel() / self.root, where, chosen))[np.ix_(kept, kept)])

    def drift(self, where: Doubles, speed: Doubles, time: float) -> tuple[Doubles, Doubles, Doubles]:
        """Positions and mass-weighted velocity after a drift by RATTLE, and the factors of its gradients.

        y' = y + t v + sum of l_c grad g_c(y), where all g(y') = 0; v' = (y' - y)/t. Forces at y along the gradients
        change l_c alone.

        Raises
        ------
        KickdriftError
            Where no factors are found: the drift is too long for the distances.
        """
        free = where + (time * speed / self.root).reshape(where.shape)
        reached, factors, smallest = self._closest(free, self.gradients(where))
        if self.distances and not smallest < _KEPT * max(d**2 for _, _, d in self.distances):
            raise KickdriftError("system", f"a drift of {time:g}", "does not keep the held distances: it is too long")
        return reached, self.root * (reached - where).ravel() / time, factors

    def back(self, where: Doubles, chosen: Sequence[int] | None = None) -> Doubles:
        """Positions near by that keep the distances, by the chosen coordinates alone; closer ones where none are found.

        By Newton's method, along the gradients at the positions given.
        """
        rows = self.gradients(where)
        if chosen is not None:
            rows[:, np.setdiff1d(np.arange(where.size), chosen)] = 0.0
        return self._closest(where, rows)[0]

    def _closest(self, reached: Doubles, rows: Doubles) -> tuple[Doubles, Doubles, float]:
        """Positions as close to the distances as Newton's method comes from here along these rows; the factors of the
        rows; and the largest g_c before the last step, or infinity where nothing is held."""
        factors, smallest = np.zeros(len(self.distances)), np.inf
        while self.distances:
            off = np.array([(np.sum((reached[i] - reached[j]) ** 2) - d**2) / 2 for i, j, d in self.distances])
            # Newton's method doubles the digits: less than half a digit is rounding, or no way there.
            if not np.abs(off).max() < smallest / 4:
                break
            smallest = float(np.abs(off).max())
            change = np.linalg.lstsq(self.gradients(reached) @ rows.T, -off, rcond=None)[0]
            factors = factors + change
            reached = reached + (rows.T @ change / self.root).reshape(reached.shape)
        return reached, factors, smallest

    def led(
        self, start: Doubles, end: Doubles, factors: Doubles, time: float, at: Doubles, going: Doubles
    ) -> tuple[Doubles, Doubles]:
        """Deviations (dy, dv), a column each, after the drift from ``start`` to ``end`` with these factors.

        dy' = Q (dy + t dv + sum of l_c grad grad g_c dy), where Q takes out along the gradients at the start what the
        gradients at the end see; dv' = (dy' - dy)/t.
        """
        if not self.distances:
            return at + time * going, going
        first, last = self.gradients(start), self.gradients(end)
        pushed = self.bent(factors) @ at
        seen = last @ (at + time * going + pushed)
        pushed -= first.T @ np.linalg.lstsq(last @ first.T, seen, rcond=None)[0]
        return at + time * going + pushed, going + pushed / time


#: g over d² that RATTLE may leave: rounding of positions of some nm.
_KEPT = 1e-12
