#!/usr/bin/env python3
"""Area of Figure 1's window in which EVERY rational pair of steps is proven unstable: bands.py PROGRAM CELLS D; JSON.

By the theorem of proofs/DENSITY.md, section 2. For each cell of h1 and each m = 1, 2, 3 the range of h2 is found for
which its two inequalities hold at all h1 of the cell; what is summed is the area of these rectangles.
Every pair at spacing 1/D is decided, too: those in the bands must be unstable.
"""

import csv
import io
import json
import math
import subprocess
import sys
from fractions import Fraction

H1, H2 = 2 / math.pi, 3.5
# Each inequality is asked with this to spare: a million times what the few functions of libm here can err by.
SPARE = 1e-9


def advance(beta, psi):
    """By how much a kick of strength beta turns the direction psi: arctan(tan psi + beta) - psi on its own branch."""
    return math.atan2(math.sin(psi) + beta * math.cos(psi), math.cos(psi)) - psi


def wobble(theta):
    """max over sigma of |arg(1 - sigma + sigma e^(i theta)) - theta sigma|: where |P|^2 = sin(theta)/theta."""
    s = 4 * math.sin(theta / 2) ** 2
    sigma = 0.5 * (1 - math.sqrt(1 - 4 * (1 - math.sin(theta) / theta) / s))
    return abs(math.atan2(sigma * math.sin(theta), 1 - sigma + sigma * math.cos(theta)) - theta * sigma)


class Column:
    """What depends on h1 in [lo, hi] alone."""

    def __init__(self, lo, hi):
        theta = [2 * math.asin(math.pi * h / 2) for h in (lo, hi)]
        self.turn = [theta[0] / lo, theta[1] / hi]
        self.chi = wobble(theta[1])
        self.root = math.sqrt(1 - (math.pi * hi / 2) ** 2)

    def below(self, m, h2):
        """Resonance m is not yet reached, whatever the phase: 0 < sup of the advance at pi/2 < m pi - theta h2/h1."""
        beta = 2 * h2 * math.pi / (50 * self.root)
        if self.chi >= math.pi / 2 - math.atan(beta / 2):
            return False
        back = max(advance(beta, side * math.pi / 2 - side * self.chi) for side in (1, -1))
        return m * math.pi - self.turn[1] * h2 > back + SPARE

    def above(self, m, h2):
        """A kick turns across it, whatever the phase."""
        alpha = h2 * math.pi * self.root / 50
        least = min(advance(2 * alpha, -math.atan(alpha) + chi) for chi in (self.chi, -self.chi))
        return m * math.pi - self.turn[0] * h2 < least - SPARE

    def band(self, m):
        """A range of h2 at both ends of which, so between them, both hold; None where there is none."""
        resonance = m * math.pi / self.turn[1]
        upper = bisect(lambda h2: self.below(m, h2), 0.5 * resonance, min(resonance, H2))
        if upper is None:
            return None
        lower = bisect(lambda h2: self.above(m, h2), upper, 0.5 * resonance)
        return lower and (lower, upper)


def bisect(holds, good, other):
    """The last point on the way from good to other where it holds."""
    if not holds(good):
        return None
    if holds(other):
        return other
    for _ in range(48):
        middle = 0.5 * (good + other)
        good, other = (middle, other) if holds(middle) else (good, middle)
    return good


def main(program, cells, d):
    n = int(cells)
    area = [0.0] * 3
    # The first cell has no lower turn, the last no root.
    for i in range(1, n - 1):
        lo, hi = H1 * i / n, H1 * (i + 1) / n
        column = Column(lo, hi)
        for m in (1, 2, 3):
            if band := column.band(m):
                area[m - 1] += (hi - lo) * (band[1] - band[0])
    shares = [a / (H1 * H2) for a in area]
    print(json.dumps({"cells": n, "bands": shares, "share": sum(shares), "grid": compare(program, int(d))}, indent=2))


def compare(program, d):
    """Of the pairs at spacing 1/d: how many are unstable, how many lie in the bands, how many of these are stable."""
    command = [program, "map", "--lambda1", "pi^2", "--lambda2", "pi^2/25", "--step", f"1/{d}", "--h1-range", f"1/{d}..2/pi",
               "--h2-range", f"1/{d}..7/2", "--format", "csv", "--quiet"]
    rows = csv.DictReader(io.StringIO(subprocess.run(command, check=True, capture_output=True, text=True).stdout))
    unstable = {tuple(int(Fraction(row[h]) * d) for h in ("h1", "h2")) for row in rows if row["kind"] != "coexistence"}
    pairs = []
    for i in range(1, int(H1 * d) + 1):
        column = Column(i / d, i / d)
        bands = [band for m in (1, 2, 3) if (band := column.band(m))]
        pairs += [(i, j) for j in range(1, int(H2 * d) + 1) if any(lo <= j / d <= hi for lo, hi in bands)]
    stable = sum(pair not in unstable for pair in pairs)
    return {"d": d, "unstable": len(unstable), "in_bands": len(pairs), "stable_in_bands": stable}


if __name__ == "__main__":
    main(*sys.argv[1:])
