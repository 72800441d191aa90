"""Second derivatives of bonded terms by their formulas: bonds, angles and torsions, all terms of a force at once.

Each term is a function of one internal coordinate q of a few atoms: E'' grad q grad qT + E' grad grad q. What q's own
derivatives are, the rules of products and chains tell, to rounding: :class:`Jet` carries them along.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from kickdrift._rigid import Doubles


@dataclass(frozen=True)
class Jet:
    """A value for each term, shape (t,), its gradient (t, c) and second derivatives (t, c, c) by c coordinates."""

    value: Doubles
    slope: Doubles
    bend: Doubles

    def __add__(self, other: Jet) -> Jet:
        return Jet(self.value + other.value, self.slope + other.slope, self.bend + other.bend)

    def __sub__(self, other: Jet) -> Jet:
        return Jet(self.value - other.value, self.slope - other.slope, self.bend - other.bend)

    def __mul__(self, other: Jet) -> Jet:
        a, b = self.value[:, None], other.value[:, None]
        across = self.slope[:, :, None] * other.slope[:, None, :]
        bend = a[..., None] * other.bend + b[..., None] * self.bend + across + across.swapaxes(1, 2)
        return Jet(self.value * other.value, a * other.slope + b * self.slope, bend)

    def through(self, value: Doubles, first: Doubles, second: Doubles) -> Jet:
        """A function of this with such a value and such derivatives."""
        along = self.slope[:, :, None] * self.slope[:, None, :]
        bend = second[:, None, None] * along + first[:, None, None] * self.bend
        return Jet(value, first[:, None] * self.slope, bend)

    def root(self) -> Jet:
        root = np.sqrt(self.value)
        return self.through(root, 0.5 / root, -0.25 / root**3)


def angle(up: Jet, along: Jet) -> Jet:
    """The angle of a point with these coordinates: grad = (x grad y - y grad x)/r², and its derivative."""
    square = along * along + up * up
    inverse = square.through(1 / square.value, -1 / square.value**2, 2 / square.value**3)
    turn = along.value[:, None] * up.slope - up.value[:, None] * along.slope
    across = along.slope[:, :, None] * up.slope[:, None, :]
    bend = along.value[:, None, None] * up.bend - up.value[:, None, None] * along.bend + across.swapaxes(1, 2) - across
    # The derivative of the numerator by the second index, then that of 1/r²; grad grad is symmetric as a whole.
    bend = bend * inverse.value[:, None, None] + turn[:, :, None] * inverse.slope[:, None, :]
    return Jet(np.arctan2(up.value, along.value), turn * inverse.value[:, None], bend)


_Vector = tuple[Jet, Jet, Jet]


def _dot(a: _Vector, b: _Vector) -> Jet:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _cross(a: _Vector, b: _Vector) -> _Vector:
    x, y, z = (a[k - 2] * b[k - 1] - a[k - 1] * b[k - 2] for k in range(3))
    return x, y, z


def _apart(where: Doubles, start: int, end: int) -> _Vector:
    """From one atom of each term to another, of positions (t, atoms, 3)."""
    count, size = len(where), where[0].size

    def component(axis: int) -> Jet:
        slope = np.zeros((count, size))
        slope[:, 3 * end + axis], slope[:, 3 * start + axis] = 1.0, -1.0
        return Jet(where[:, end, axis] - where[:, start, axis], slope, np.zeros((count, size, size)))

    return component(0), component(1), component(2)


def _length(where: Doubles) -> Jet:
    along = _apart(where, 0, 1)
    return _dot(along, along).root()


def _bend(where: Doubles) -> Jet:
    u, v = _apart(where, 1, 0), _apart(where, 1, 2)
    normal = _cross(u, v)
    return angle(_dot(normal, normal).root(), _dot(u, v))


def _torsion(where: Doubles) -> Jet:
    first, middle, last = (_apart(where, k, k + 1) for k in range(3))
    near, far = _cross(first, middle), _cross(middle, last)
    return angle(_dot(middle, middle).root() * _dot(first, far), _dot(near, far))


def _harmonic(q: Doubles, rest: Doubles, k: Doubles) -> tuple[Doubles, Doubles]:
    return k * (q - rest), k


def _periodic(q: Doubles, n: Doubles, phase: Doubles, k: Doubles) -> tuple[Doubles, Doubles]:
    return -k * n * np.sin(n * q - phase), -k * n**2 * np.cos(n * q - phase)


def _ryckaert(q: Doubles, *c: Doubles) -> tuple[Doubles, Doubles]:
    """A sum of c_n cosⁿ(q - π)."""
    x, y = -np.cos(q), -np.sin(q)
    first = sum(n * coefficient * x ** (n - 1) for n, coefficient in enumerate(c) if n > 0)
    second = sum(n * (n - 1) * coefficient * x ** (n - 2) for n, coefficient in enumerate(c) if n > 1)
    return np.asarray(-first * y), np.asarray(second * y**2 - first * x)


_Law = Callable[..., tuple[Doubles, Doubles]]

#: Each force's internal coordinate, and E' and E'' of that with the parameters behind its atoms.
LAWS: dict[str, tuple[Callable[[Doubles], Jet], _Law]] = {
    "HarmonicBondForce": (_length, _harmonic),
    "HarmonicAngleForce": (_bend, _harmonic),
    "PeriodicTorsionForce": (_torsion, _periodic),
    "RBTorsionForce": (_torsion, _ryckaert),
}

#: Terms that are looked at together: some 100 MB.
_TOGETHER = 10_000


def blocks(kind: str, atoms: Sequence[Sequence[int]], parameters: Doubles, positions: Doubles) -> tuple[Any, Doubles]:
    """The coordinates (t, c) of a force's terms and their second derivatives (t, c, c); not finite where a term has
    none, as a straight angle."""
    coordinate, law = LAWS[kind]
    places, found = np.array(atoms, dtype=np.int64), []
    with np.errstate(divide="ignore", invalid="ignore"):
        for start in range(0, len(places), _TOGETHER):
            part = slice(start, start + _TOGETHER)
            q = coordinate(positions[places[part]])
            first, second = law(q.value, *parameters[part].T)
            found.append(q.through(q.value, first, second).bend)
    return (3 * places[:, :, None] + np.arange(3)).reshape(len(places), -1), np.concatenate(found)
