"""What has two ends or two parts: by attribute, by name as in rows, or unpacked as a pair."""

from __future__ import annotations

from typing import Any, NamedTuple


class _ByName(tuple[Any, ...]):
    """A tuple whose parts are found by their names, too."""

    __slots__ = ()

    def __getitem__(self, key: Any) -> Any:
        return getattr(self, key) if key in getattr(self, "_fields", ()) else super().__getitem__(key)

    def __repr__(self) -> str:
        return repr(tuple(self))


class _Ends(NamedTuple):
    lo: float
    hi: float


class Enclosure(_ByName, _Ends):
    """Doubles that enclose a number: ``found.lo``, ``found["lo"]`` as in rows, or ``lo, hi = found``.

    Examples
    --------
    >>> import kickdrift as kd
    >>> trace = kd.decide(lambda1=1, lambda2=0, h1=1, h2=1).trace
    >>> trace["lo"] == trace.lo == trace[0], trace.lo <= 1 <= trace.hi
    (True, True)
    """

    __slots__ = ()


class _Parts(NamedTuple):
    at_kicks: Enclosure
    in_drifts: Enclosure


class Bias(_ByName, _Parts):
    """R where velocities are thermal at the kicks, and where they are in the drifts.

    Examples
    --------
    >>> import kickdrift as kd
    >>> bias = kd.decide(lambda1=1, lambda2=0, h1=1, h2=1).bias
    >>> bias["at_kicks"]["lo"] == bias.at_kicks.lo == bias[0][0]
    True
    """

    __slots__ = ()
