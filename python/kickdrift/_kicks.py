"""The kicks of half a period, by the steps of their forces."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction


@dataclass(frozen=True)
class Kick:
    """One strike of the clocks: its time, and how long each group acts; at the ends of a period half as long."""

    time: Fraction
    groups: tuple[tuple[int, Fraction], ...]


def schedule(steps: Sequence[Fraction]) -> tuple[Kick, ...]:
    """The kicks of the first half of a period, halved at both its ends."""
    period = common_tick(steps)
    half = period / 2
    times = sorted({step * k for step in steps for k in range(int(half / step) + 1)} | {Fraction(0), half})
    kicks = []
    for time in times:
        weight = Fraction(1, 2) if time in (0, half) else Fraction(1)
        groups = tuple((k, weight * step) for k, step in enumerate(steps) if (time / step).denominator == 1)
        kicks.append(Kick(time, groups))
    return tuple(kicks)


def common_tick(steps: Sequence[Fraction]) -> Fraction:
    common = steps[0]
    for step in steps[1:]:
        ratio = common / step
        common *= ratio.denominator
    return common
