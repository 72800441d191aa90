"""The shapes of bonds, scanned: some twenty energies each, from which apertures are measured."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass

import numpy as np

from kickdrift._errors import KickdriftError
from kickdrift._rigid import Doubles

#: kJ/mol/K.
GAS = 8.31446261815324e-3

#: Curvatures are of lengths so far apart, nm.
_NEAR = 2e-4

#: A scan goes to this energy, in kT: runs of 10,000 bonds for 100 ns see 20.7.
HIGHEST = 20.0

#: Lengths on either side of rest up to the amplitude that a harmonic bond of that energy had.
_LENGTHS = 10

#: A stretched bond is followed to so many of these amplitudes.
_FARTHEST = 2


@dataclass(frozen=True)
class Shape:
    """A bond with its potential, as ``kd.aperture`` and ``kd.advise`` read it.

    Attributes
    ----------
    bond : str
        NAME:poly:k2=...,k3=...,k4=...,MASS,MASS or NAME:morse:D=...,a=...,MASS,MASS, whichever is nearer.
    pair : (int, int)
        The two atoms.
    period : float
        That of its smallest oscillations, all else at rest, fs.
    misfit : float
        How far that is off the energies at most, kT.
    """

    bond: str
    pair: tuple[int, int]
    period: float
    misfit: float


@dataclass(frozen=True)
class Scan:
    """The energy in kJ/mol over the length of one bond in nm, both atoms moving about their centre of mass."""

    energy: Callable[[Doubles], float]
    where: Doubles
    masses: Doubles
    pair: tuple[int, int]

    def at(self, longer: float) -> float:
        first, second = self.pair
        along = self.where[second] - self.where[first]
        along = along / np.linalg.norm(along)
        share = self.masses[first] / (self.masses[first] + self.masses[second])
        moved = self.where.copy()
        moved[second] += longer * share * along
        moved[first] -= longer * (1 - share) * along
        return self.energy(moved)

    def curved(self, length: float) -> tuple[float, float]:
        """The slope and the curvature of the energy."""
        low, middle, high = (self.at(length + side * _NEAR) for side in (-1, 0, 1))
        return (high - low) / (2 * _NEAR), (high - 2 * middle + low) / _NEAR**2

    @property
    def mass(self) -> float:
        first, second = self.masses[list(self.pair)]
        return float(first * second / (first + second))

    def shape(self, names: Sequence[str], temperature: float) -> Shape:
        rest = 0.0
        for _ in range(3):
            slope, curvature = self.curved(rest)
            if curvature <= 0:
                raise KickdriftError("pair", str(self.pair), "is at no minimum: minimize first")
            rest -= slope / curvature
        thermal = GAS * temperature
        amplitude, bottom = np.sqrt(2 * HIGHEST * thermal / curvature), self.at(rest)
        x, above = [0.0], [0.0]
        for side in (-1, 1):
            for n in range(1, _FARTHEST * _LENGTHS + 1):
                x.append(side * n / _LENGTHS * amplitude)
                above.append(self.at(rest + x[-1]) - bottom)
                if not above[-1] < HIGHEST * thermal:
                    break
        # In units of the amplitude, so that all constants are of one size.
        scaled, above_rest = np.array(x) / amplitude, np.array(above)
        misfit, terms, curvature = min(
            _polynomial(scaled, above_rest, amplitude), _morse(scaled, above_rest, amplitude)
        )
        first, second = self.pair
        bond = f"{names[first]}-{names[second]}:{terms},{self.masses[first]:.12g},{self.masses[second]:.12g}"
        return Shape(bond, self.pair, float(2e3 * np.pi * np.sqrt(self.mass / curvature)), misfit / thermal)


def _polynomial(x: Doubles, above: Doubles, unit: float) -> tuple[float, str, float]:
    """How far k2 x² + k3 x³ + k4 x⁴ is off at most, its constants, its curvature at rest."""
    columns = np.stack([x**2, x**3, x**4], axis=1)
    constants = np.linalg.lstsq(columns, above, rcond=None)[0]
    k2, k3, k4 = constants / unit ** np.array([2, 3, 4])
    terms = f"poly:k2={k2:.12g}kJ/mol/nm^2,k3={k3:.12g}kJ/mol/nm^3,k4={k4:.12g}kJ/mol/nm^4"
    return float(np.abs(columns @ constants - above).max()), terms, 2 * k2


def _morse(x: Doubles, above: Doubles, unit: float) -> tuple[float, str, float]:
    """The same of D (1 - exp(-a x))²: the best D of each a, a by ever narrower grids."""

    def fitted(a: float) -> tuple[float, float, float]:
        column = np.expm1(-a * x) ** 2
        depth = float(column @ above / (column @ column))
        return float(np.abs(depth * column - above).max()), depth, a

    best, grid = (np.inf, 0.0, 1.0), np.geomspace(0.01, 3, 60)
    for _ in range(8):
        best = min(best, *(fitted(float(a)) for a in grid))
        wide = grid[1] / grid[0]
        grid = np.geomspace(best[2] / wide, best[2] * wide, 20)
    misfit, depth, a = best
    return misfit, f"morse:D={depth:.12g}kJ/mol,a={a / unit:.12g}/nm", 2 * depth * (a / unit) ** 2


def shapes(
    energy: Callable[[Doubles], float],
    where: Doubles,
    masses: Doubles,
    names: Sequence[str],
    *,
    held: Collection[frozenset[int]],
    pairs: Sequence[tuple[int, int]] | None,
    temperature: float,
    count: int,
) -> list[Shape]:
    """The fastest bonds, in order; of all atoms and the ones nearest to them unless pairs are given."""
    chosen = _nearest(where) if pairs is None else {(int(a), int(b)) for a, b in pairs}
    if any(not 0 <= n < len(where) for pair in chosen for n in pair) or any(a == b for a, b in chosen):
        raise KickdriftError("pairs", str(pairs), f"give two different atoms of 0 to {len(where) - 1} in each")
    scans = [Scan(energy, where, masses, pair) for pair in sorted(chosen) if frozenset(pair) not in held]
    if not scans:
        raise KickdriftError("pairs", str(pairs), "all bonds are held, or there is none: give two atoms that vibrate")
    fastest = sorted(scans, key=lambda scan: scan.curved(0.0)[1] / scan.mass, reverse=True)
    return [scan.shape(names, temperature) for scan in fastest[:count]]


def _nearest(where: Doubles) -> set[tuple[int, int]]:
    """Each atom and the one nearest to it."""
    pairs = set()
    for n, place in enumerate(where):
        far = np.linalg.norm(where - place, axis=1)
        far[n] = np.inf
        other = int(np.argmin(far))
        if np.isfinite(far[other]):
            pairs.add((min(n, other), max(n, other)))
    return pairs
