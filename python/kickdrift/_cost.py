"""What Hessians will take, before they are begun."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from time import perf_counter

import numpy as np

from kickdrift._errors import KickdriftError
from kickdrift._hessians import Force
from kickdrift._kicks import schedule
from kickdrift._rigid import Doubles


@dataclass(frozen=True)
class Work:
    """What Hessians will take, before they are begun: their columns, how many are kept, seconds a force takes, and how
    many Hessians the way to a minimum or an orbit takes."""

    columns: int
    hessians: int
    evaluation: float
    sought: int = 0

    @staticmethod
    def of_period(columns: int, steps: Sequence[Fraction], evaluation: float, about: str, sought: int = 0) -> Work:
        """That of half a period: about the minimum one Hessian a group, about an orbit one a kick, at each of Newton's
        steps to it; ``sought`` Hessians before these."""
        if about == "minimum":
            return Work(columns, len(steps), evaluation, sought)
        kicks = sum(len(kick.groups) for kick in schedule(steps))
        return Work(columns, kicks, evaluation, sought + STEPS * kicks)

    @property
    def seconds(self) -> float:
        """Four forces a column."""
        return 4 * self.columns * (self.hessians + self.sought) * self.evaluation

    @property
    def bytes(self) -> float:
        """Matrices of doubles: six while one is made, and of each that is kept four copies in the system."""
        return 8.0 * self.columns**2 * (6 + 4 * self.hessians)

    def __str__(self) -> str:
        sought = f" and some {self.sought} on the way there" if self.sought else ""
        forces = 4 * self.columns * (self.hessians + self.sought)
        each = f"{self.hessians} Hessians of {self.columns} columns{sought}, {forces} forces"
        return f"{each} of {1e3 * self.evaluation:.3g} ms: some {_rounded(self.seconds)} s, {self.bytes / 1e9:.2g} GB"

    def begin(self, most: float, is_told: bool, remedy: str) -> None:
        """Say what it is, where that is wanted, and refuse what the library, the memory or ``most`` seconds do not let
        through.

        Raises
        ------
        KickdriftError
            Before anything is computed.
        """
        who = f"{self.columns} degrees of freedom"
        if self.columns > LARGEST:
            raise KickdriftError("system", who, f"dense ones are {LARGEST} at most: {remedy}")
        free = _memory()
        if self.bytes > free:
            raise KickdriftError("system", who, f"there are {free / 1e9:.2g} GB for {self}: {remedy}")
        if not self.seconds <= most:
            raise KickdriftError("system", who, f"{self}, more than {most:g} s: give longest=SECONDS, or {remedy}")
        if is_told:
            print(self, file=sys.stderr, flush=True)


def _rounded(seconds: float) -> str:
    """Two digits, or whole seconds."""
    return f"{seconds:.0f}" if seconds >= 100 else f"{seconds:.2g}"


#: Hessians that Newton's method makes on its way from beside a minimum; from far away, up to ``_HESSIANS``.
SOUGHT = 4

#: Steps of Newton's method from a minimum to an orbit, some; each makes the Hessians of half a period.
STEPS = 6


#: The library takes dense matrices of so many rows.
LARGEST = 4096


def _memory() -> float:
    """Bytes that programs may have, what caches hold included; all there are, or no limit, where that is not said."""
    try:
        lines = Path("/proc/meminfo").read_text().splitlines()
        return next(1024.0 * int(line.split()[1]) for line in lines if line.startswith("MemAvailable"))
    except (OSError, StopIteration):
        pass
    try:
        return float(os.sysconf("SC_PHYS_PAGES")) * os.sysconf("SC_PAGE_SIZE")
    except (AttributeError, OSError, ValueError):
        return np.inf


#: Hessians that take more seconds than this are asked for.
LONGEST = 3600.0


def seconds_of(force: Force, positions: Doubles) -> float:
    """How long a force takes, the second time.

    Raises
    ------
    KickdriftError
        Where it has no finite forces at these positions: nothing could be measured about them.
    """
    found = force(positions)
    if np.shape(found) != np.shape(positions):
        raise KickdriftError("forces", f"shape {np.shape(found)}", f"give shape {np.shape(positions)}")
    if not np.isfinite(found).all():
        atom = int(np.argwhere(~np.isfinite(found))[0][0])
        remedy = "there is no finite force at these positions: do two particles share a place?"
        raise KickdriftError("forces", f"{found[atom]} on particle {atom}", remedy)
    begin = perf_counter()
    force(positions)
    return perf_counter() - begin
