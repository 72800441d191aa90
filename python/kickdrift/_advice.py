"""Advice as an answer: which steps are safe, for how long, and why."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from html import escape
from os import PathLike
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, TypeAlias

from kickdrift import _plot
from kickdrift._document import Asked, Document, Row, flat, frame
from kickdrift._native import Number
from kickdrift._numbers import Exact

if TYPE_CHECKING:
    import pandas
    from matplotlib.axes import Axes

Time: TypeAlias = Exact
"""A length of time: a text with its unit as ``"0.5fs"`` or ``"0.01ps"``, or an exact number of fs."""

Engine: TypeAlias = str | PathLike[str] | Sequence[str | PathLike[str]]
"""An input of a simulation engine: a path, or its text (of several lines); of OpenMM a system and an integrator."""

_COLOURS = {"safe": "safe", "caution": "caution", "near": "caution", "island": "caution", "little": "safe"}


@dataclass(frozen=True, eq=False, repr=False)
class Advised(Document):
    """What all advice has: schemes of steps, each with a status, and what to do."""

    _text: str
    _details: str

    _schemes_are = "schemes"

    @property
    def status(self) -> str:
        """The first scheme's status.

        ``safe``; ``caution``: proven stable, beyond a published limit; ``near``: an unstable interval is within the
        band; ``island``: stable above an unstable interval; ``unstable``; ``not told``: not decided within the accuracy
        of the Hessians, or the fastest period is not given. For forces that are no gradient the status says how much
        the steps add to their growth: ``little``, ``much`` or ``not told``.
        """
        return str(self.schemes[0]["status"])

    @property
    def safe(self) -> Number | None:
        """The longest outer step of the first scheme, fs, that is proven stable for the whole band and below the
        published limits: T/3 of the fastest motion, and T/6.28 of each clock's own forces."""
        return _number(self.schemes[0]["safe"])

    @property
    def largest(self) -> Number | None:
        """The longest one that is proven stable for the whole band."""
        return _number(self.schemes[0]["largest"])

    @cached_property
    def schemes(self) -> tuple[Row, ...]:
        """One row a scheme: ``outer``, ``status``, ``band_edge``, ``largest``, ``safe`` and so on; steps in fs."""
        return self._table(self._schemes_are)

    @cached_property
    def rows(self) -> tuple[Row, ...]:
        """One row a scheme and fast mode (of Hessians one a scheme): growth, and the unstable intervals of the outer
        step, fs."""
        return self._table("rows")

    @cached_property
    def levers(self) -> tuple[Row, ...]:
        """What would let the outer step of the first scheme grow: masses, constraints, methods, ratios, one row each.

        ``first`` unstable step, ``band_edge`` (proven below), ``step`` to take and its ``bound``, costs a picosecond,
        ``gain``, ``engines``; empty where they were left out.

        Examples
        --------
        >>> import kickdrift as kd
        >>> advice = kd.advise(["10fs", "40fs"], steps=["0.5fs", "4fs"])
        >>> [(row["lever"], row["step"]) for row in advice.levers[:2]], advice.levers[5]["first_exact"]
        ([('as given', '3'), ('short-average MOLLY', '231/50')], '40/pi')
        """
        return self._table("levers") if "levers" in self.data else ()

    @property
    def engine(self) -> Mapping[str, Any] | None:
        """What was read of an engine's input: ``name``, ``forces``, ``used``, ``remarks``, and its lines ``rewritten``
        with the step that is advised."""
        found = self.data.get("engine")
        return None if found is None else MappingProxyType(found)

    def _table(self, name: str) -> tuple[Row, ...]:
        return tuple(MappingProxyType(row) for row in self.data[name])

    def to_pandas(self) -> pandas.DataFrame:
        """The rows as a data frame; the ends of enclosures stand beside each other, as ``first_lower_lo``.

        Examples
        --------
        >>> import kickdrift as kd
        >>> frame = kd.advise({"OH": "10fs", "slow": "40fs"}, steps=["0.5fs", "4fs"]).to_pandas()
        >>> len(frame), "first_lower_lo" in frame
        (1, True)
        """
        return frame(flat(self.rows))

    @property
    def details(self) -> str:
        """All that there is to say: the lines of ``str(advice)``, the reasons, every lever, and the tables.

        Examples
        --------
        >>> import kickdrift as kd
        >>> advice = kd.advise({"OH": "10fs", "slow": "40fs"}, steps=["0.5fs", "4fs"])
        >>> len(str(advice).splitlines()) <= 12, "What would let the outer step grow" in advice.details
        (True, True)
        """
        return self._details

    def __str__(self) -> str:
        return self._text

    def __repr__(self) -> str:
        each = (f"{float(Number(scheme['outer'])):g} fs {scheme['status']}" for scheme in self.schemes)
        return f"{type(self).__name__}({', '.join(each)})"

    def _repr_html_(self) -> str:
        colour = _plot.COLOURS[_COLOURS.get(self.status, "unstable")]
        style = f"border-left: 4px solid {colour}; padding-left: 1em"
        return f"<pre style='{style}'>{escape(self._text.rstrip())}</pre>"


@dataclass(frozen=True, eq=False, repr=False)
class Advice(Advised):
    """Which steps are safe for some periods: each scheme of steps with each fast mode, what to do, and why.

    Examples
    --------
    >>> import kickdrift as kd
    >>> advice = kd.advise({"OH": "10fs", "slow": "40fs"}, steps=[("0.5fs", "4fs"), ("0.5fs", "5fs")])
    >>> advice.status, advice.safe, [scheme["status"] for scheme in advice.schemes]
    ('caution', Number('3'), ['caution', 'island'])
    """

    _asked: Asked

    @cached_property
    def modes(self) -> tuple[Row, ...]:
        """One row a mode: its clock, period and the limits that follow, fs."""
        return self._table("modes")

    def to_svg(self) -> str:
        """The program's figure: the outer step across, each mode a row.

        Examples
        --------
        >>> import kickdrift as kd
        >>> kd.advise({"OH": "10fs", "slow": "40fs"}, steps=["0.5fs", "4fs"]).to_svg().startswith("<svg")
        True
        """
        return self._asked.svg()

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the proven stable and unstable outer steps of the first scheme, a row a mode.

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Where to draw; a new figure unless given.

        Examples
        --------
        >>> import kickdrift as kd
        >>> kd.advise({"OH": "10fs", "slow": "40fs"}, steps=["0.5fs", "4fs"]).plot().get_xlabel()
        'outer step (fs)'
        """
        return _plot.advice(self.data, ax)

    def _repr_html_(self) -> str:
        return f"{super()._repr_html_()}{self.to_svg()}"


@dataclass(frozen=True, eq=False, repr=False)
class SystemAdvice(Advised):
    """Which steps are safe for a molecule by its Hessians, as :meth:`System.advise` finds.

    Examples
    --------
    >>> import kickdrift as kd
    >>> fast, slow = [[0.39, 0], [0, 0.41]], [[0.02, 0.01], [0.01, 0.02]]
    >>> system = kd.System.from_hessians([1, 1], {"fast": ("1/2", fast), "slow": (4, slow)}, time_unit="fs")
    >>> advice = system.advise()
    >>> advice.status, advice.groups[0]["count"]
    ('caution', 2)
    """

    warnings: tuple[str, ...] = ()
    """What limits the advice, in words: what was found when the system was made, and what its verdict warns of."""

    _schemes_are = "rows"

    @cached_property
    def groups(self) -> tuple[Row, ...]:
        """The modes of the fast stiffness alone, the fastest first: ``count``, ``shortest``, ``longest`` period, fs,
        and the ``atoms`` that the fastest moves; none of forces that are no gradient."""
        return self._table("groups") if "groups" in self.data else ()

    @cached_property
    def ladder(self) -> tuple[Row, ...]:
        """For forces that are no gradient, the multiples of the step before the outermost one that were looked at.

        One row each: ``outer``, the enclosed ``growth_rate`` per ps, and how much the steps add, ``status``. Empty for
        other forces.

        Examples
        --------
        >>> import kickdrift as kd
        >>> cheap, correction = [[0.5, 0], [0, 0.5]], [[0.02, 1e-4], [-1e-4, 0.02]]
        >>> levels = {"cheap": ("1/2", cheap), "correction": (4, correction)}
        >>> advice = kd.System.from_hessians([1, 1], levels, time_unit="fs", symmetric=False).advise()
        >>> advice.status, advice.ladder[7]["outer"], advice.ladder[7]["status"]
        ('little', '4', 'little')
        """
        return self._table("ladder") if "ladder" in self.data else ()

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the proven stable outer steps and the first unstable interval, a row a scheme.

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Where to draw; a new figure unless given.

        Examples
        --------
        >>> import kickdrift as kd
        >>> fast, slow = [[0.39, 0], [0, 0.41]], [[0.02, 0.01], [0.01, 0.02]]
        >>> system = kd.System.from_hessians([1, 1], {"fast": ("1/2", fast), "slow": (4, slow)}, time_unit="fs")
        >>> system.advise().plot().get_xlabel()
        'outer step (fs)'
        """
        if self.ladder:
            return _plot.ladder(self.data, ax)
        return _plot.system_advice(self.data, ax)


def _number(value: str | None) -> Number | None:
    return None if value is None else Number(value)
