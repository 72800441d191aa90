"""Verdicts: is a pair of steps stable?"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Self

import numpy as np
import numpy.typing as npt

from kickdrift import _native
from kickdrift._document import Document, Frozen
from kickdrift._enclosure import Bias, Enclosure
from kickdrift._errors import BudgetError, KickdriftError, required
from kickdrift._native import Number
from kickdrift._numbers import Exact, flag, frozen, placed
from kickdrift._plot import COLOURS
from kickdrift._progress import Progress, shown

if TYPE_CHECKING:
    import pandas

VERDICTS, TIERS = (tuple(names) for names in _native.names())
"""The seven verdicts by their codes, a kind and the sign of the trace where it is 2 or -2 or beyond; and the three
tiers of the ladder: doubles with a proven bound, more bits, exact arithmetic."""

_STABLE = frozen(np.array([name.startswith(("elliptic", "coexistence")) for name in VERDICTS]))


@dataclass(frozen=True, eq=False, repr=False)
class Verdict:
    """A proven answer about one pair of steps.

    Trace, growth rate and label cost hundreds of verdicts, so they are computed when they are first asked for. What is
    unpickled is decided again.

    Examples
    --------
    >>> import kickdrift as kd
    >>> verdict = kd.decide(lambda1="pi^2", lambda2="pi^2/25", h1="1/100", h2="0.98")
    >>> verdict.stable, verdict.kind, verdict.ratio, verdict.m, verdict.family
    (False, 'hyperbolic', (98, 1), 1, (0, 1))
    >>> bool(verdict)
    False
    """

    _pair: _native.Pair

    @property
    def stable(self) -> bool:
        """Whether all powers of the propagator stay bounded."""
        return self._pair.stable

    @property
    def kind(self) -> str:
        """``elliptic`` and ``coexistence`` are stable, ``parabolic`` grows linearly, ``hyperbolic`` exponentially."""
        return self._pair.kind

    @property
    def side(self) -> int:
        """1 where Tr Q >= 2, -1 where Tr Q <= -2, 0 between."""
        return self._pair.side

    @property
    def decided_by(self) -> str:
        """The tier that proved it: filter, refine or exact."""
        return self._pair.decided_by

    @property
    def ratio(self) -> tuple[int, int]:
        """(p, q), h2/h1 = p/q in lowest terms: p fast and q slow kicks in a period."""
        return self._pair.terms

    @property
    def lambda1(self) -> Number:
        """The fast stiffness, 1/time²."""
        return self._pair.quantities[0]

    @property
    def lambda2(self) -> Number:
        """The slow stiffness, 1/time²."""
        return self._pair.quantities[1]

    @property
    def h1(self) -> Number:
        """The fast step."""
        return self._pair.quantities[2]

    @property
    def h2(self) -> Number:
        """The slow step."""
        return self._pair.quantities[3]

    @property
    def period(self) -> Number:
        """T = p h1 = q h2, after which both clocks meet again."""
        return self._pair.quantities[4]

    @cached_property
    def document(self) -> Document:
        """The document ``kickdrift/verdict/1``."""
        return Document(self._pair.render("json"))

    @property
    def trace(self) -> Enclosure:
        """Doubles that enclose Tr Q; infinite where it is beyond them."""
        return _ends(self.document.data["trace"])

    @property
    def growth_rate(self) -> float:
        """The middle of :attr:`growth_bounds`: per unit time, 0 where nothing grows exponentially."""
        return sum(self.growth_bounds) / 2

    @property
    def growth_bounds(self) -> Enclosure:
        """Doubles that enclose the growth rate per unit time; zeros where nothing grows exponentially."""
        return _ends(self.document.data["growth_rate"])

    @property
    def bias(self) -> Bias | None:
        """By how much the potential energy of a stable pair is off, 1 being right: doubles that enclose it where
        velocities are thermal ``at_kicks`` (constant energy, OBABO), and ``in_drifts`` (BAOAB, LangevinMiddle).
        None unless elliptic, and beyond 1,000 kicks a period.

        Examples
        --------
        >>> import kickdrift as kd
        >>> kicks, drifts = kd.decide(lambda1=1, lambda2=0, h1=1, h2=1).bias
        >>> round(kicks[0], 6), round(drifts[0], 6)
        (1.333333, 1.0)
        """
        found = self.document.data["bias"]
        return None if found is None else Bias(_ends(found["at_kicks"]), _ends(found["in_drifts"]))

    @property
    def m(self) -> int | None:
        """The half turns of the growing solution in a period, where it grows."""
        m: int | None = (self.document.data["resonance"] or {}).get("m")
        return m

    @property
    def family(self) -> tuple[int, int] | None:
        """(a, b) with m = a p + b q, the dominant family of resonances."""
        found = self.document.data["resonance"]
        return None if not found or found["a"] is None else (found["a"], found["b"])

    @property
    def friction(self) -> Mapping[str, Any] | None:
        """What the friction asked for does: ``rate``, ``damping``, ``growth_rate`` with it, and ``masking``: at
        ``lo`` it grows still, at ``hi`` it does not, ``ranges`` of rates are proven to mask the growth, and
        ``stays`` says whether every larger rate is.

        Examples
        --------
        >>> import kickdrift as kd
        >>> found = kd.decide(lambda1="pi^2", lambda2="pi^2/25", h1="1/100", h2="0.98", friction="1/10").friction
        >>> found["damping"], 0.1 < found["masking"]["lo"] <= found["masking"]["hi"]
        ('growing', True)
        """
        found = self.document.data.get("friction")
        return None if found is None else MappingProxyType(found)

    def to_json(self) -> str:
        """The document of ``kickdrift verdict``, byte for byte.

        Examples
        --------
        >>> import kickdrift as kd
        >>> verdict = kd.decide(lambda1=1, lambda2=0, h1=1, h2=1)
        >>> verdict.to_json() == verdict.document.to_json()
        True
        """
        return self.document.to_json()

    def to_csv(self) -> str:
        """The document's one row as CSV.

        Examples
        --------
        >>> import kickdrift as kd
        >>> verdict = kd.decide(lambda1=1, lambda2=0, h1=1, h2=1)
        >>> len(verdict.to_csv().splitlines())
        2
        """
        return self._pair.render("csv")

    def to_latex(self) -> str:
        """The document's one row as a LaTeX table.

        Examples
        --------
        >>> import kickdrift as kd
        >>> verdict = kd.decide(lambda1=1, lambda2=0, h1=1, h2=1)
        >>> r"\\begin{tabular}" in verdict.to_latex()
        True
        """
        return self._pair.render("latex")

    def __bool__(self) -> bool:
        return self.stable

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Verdict) and self.to_json() == other.to_json()

    def __hash__(self) -> int:
        return hash(tuple(self._pair.quantities))

    def __copy__(self) -> Self:
        return self

    def __deepcopy__(self, memo: object) -> Self:
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, self._pair.question()

    def __repr__(self) -> str:
        words = "stable" if self.stable else "unstable"
        given = ", ".join(f"{name}={getattr(self, name)}" for name in ("lambda1", "lambda2", "h1", "h2"))
        return f"Verdict({words}, {self.kind}, {given})"

    def __str__(self) -> str:
        return self._pair.render("text").rstrip()

    def _repr_html_(self) -> str:
        colour = COLOURS["coexistence" if self.stable else "unstable"]
        return f"<pre style='border-left: 4px solid {colour}; padding-left: 1em'>{self}</pre>"


def _again(quantities: list[Number], exact: bool, friction: Number | None, budget: int | None) -> Verdict:
    lambda1, lambda2, h1, h2 = quantities
    return Verdict(_native.decide(lambda1, lambda2, h1, h2, exact, friction, budget))


def _ends(enclosure: Any) -> Enclosure:
    lo, hi = (
        float(np.copysign(np.inf, sign)) if end is None else float(end)
        for end, sign in ((enclosure["lo"], -1), (enclosure["hi"], 1))
    )
    return Enclosure(lo, hi)


def decide(
    *,
    lambda1: Exact,
    lambda2: Exact,
    h1: Exact,
    h2: Exact,
    exact: bool = False,
    friction: Exact | None = None,
    budget: int | None = None,
) -> Verdict:
    """Decide whether a pair of steps is stable: proven, never guessed.

    Parameters
    ----------
    lambda1, lambda2 : Exact
        The stiffnesses of the fast and the slow force, 1/time²: k/m, or (2 pi/P)² for a force of period P.
    h1, h2 : Exact
        The fast and the slow step, time; h2/h1 must be rational.
    exact : bool
        Decide in exact arithmetic alone, and show the exact trace where it is rational.
    friction : Exact, optional
        A rate G, 1/time, rational: v times exp(-G t) in the middle of every drift (BAOAB). The verdict stays that
        without friction; ``Verdict.friction`` tells what friction does.
    budget : int, optional
        The most kicks that one tier may compose; 10^8 unless given.

    Raises
    ------
    KickdriftError
        Bad input, with its field, value and remedy.
    BudgetError
        A period of more kicks than the budget allows, before the work begins.

    Examples
    --------
    >>> import kickdrift as kd
    >>> print(kd.decide(lambda1="11/4", lambda2="57/10", h1=1, h2="5/3"))
    stable: coexistence, Q = I; a tongue is closed here
      h2/h1        5/3: 5 fast and 3 slow kicks in the period T = 5
      trace        2
                   = 2 exactly
      decided by   exact
    """
    return Verdict(_native.decide(lambda1, lambda2, h1, h2, flag("exact", exact), friction, budget))


@dataclass(frozen=True, eq=False, repr=False)
class Verdicts(Frozen):
    """The verdicts of many pairs. Indices and slices find parts of them, as in an array of their shape.

    Attributes
    ----------
    code : array of uint8, the broadcast shape
        Positions in ``Verdicts.names``.
    tier : array of uint8, the same shape
        The deciding tiers, positions in ``Verdicts.tier_names``.

    Examples
    --------
    >>> import kickdrift as kd
    >>> found = kd.verdicts(lambda1="pi^2", lambda2="pi^2/25", h1="1/100", h2=["0.9", "0.98", "1"])
    >>> found.stable.tolist(), found.names[found.code[1]]
    ([True, False, True], 'hyperbolic-')
    >>> bool(found[1].stable), found[~found.stable]
    (False, Verdicts(1 pairs of shape (1,): 1 unstable))
    """

    code: npt.NDArray[np.uint8]
    tier: npt.NDArray[np.uint8]

    names = VERDICTS
    tier_names = TIERS

    @property
    def stable(self) -> npt.NDArray[np.bool_]:
        """Whether each pair is stable; the shape of ``code``."""
        return frozen(np.asarray(_STABLE[self.code]))

    @property
    def kind(self) -> npt.NDArray[np.str_]:
        """The kind of each, in the shape of ``code``: elliptic, parabolic, coexistence or hyperbolic."""
        return frozen(np.asarray(np.array([name.rstrip("+-") for name in VERDICTS])[self.code]))

    def to_pandas(self) -> pandas.DataFrame:
        """One row a pair, in the order of the flattened arrays: stable, kind, decided_by.

        What was given can stand beside: ``found.to_pandas().assign(h2=h2)``.

        Examples
        --------
        >>> import kickdrift as kd
        >>> found = kd.verdicts(lambda1="pi^2", lambda2="pi^2/25", h1="1/100", h2=["0.9", "0.98"])
        >>> found.to_pandas().kind.tolist()
        ['elliptic', 'hyperbolic']
        """
        columns = {
            "stable": self.stable.ravel(),
            "kind": self.kind.ravel(),
            "decided_by": np.array(TIERS)[self.tier.ravel()],
        }
        made: pandas.DataFrame = required("pandas").DataFrame(columns)
        return made

    def __len__(self) -> int:
        return len(self.code)

    def __getitem__(self, index: Any) -> Self:
        return type(self)(frozen(np.asarray(self.code[index])), frozen(np.asarray(self.tier[index])))

    def __repr__(self) -> str:
        unstable = int(self.code.size - np.count_nonzero(self.stable))
        return f"Verdicts({self.code.size} pairs of shape {self.code.shape}: {unstable} unstable)"


def verdicts(
    *,
    lambda1: Any,
    lambda2: Any,
    h1: Any,
    h2: Any,
    budget: int | None = None,
    threads: int | None = None,
    progress: Progress | bool = False,
) -> Verdicts:
    """Decide many pairs at once, side by side in the processor and on all cores, without Python's lock.

    Parameters
    ----------
    lambda1, lambda2, h1, h2 : Exact, or arrays or nested lists of such
        As for :func:`decide`; arrays broadcast as NumPy's do. Each value is read once, however often it is broadcast.
        Floats mean what they print, alone or in arrays of any precision; :func:`exact` gives the doubles themselves.
        Their periods have any number of kicks, 10^30 and more, and a verdict on a pair of such floats takes a hundred
        times as long as one on short numbers: ``np.round(h1, 6)``, or :func:`simplest` of each, where that is meant.
    budget : int, optional
        The most kicks that one pair may compose; 10^8 unless given.
    threads : int, optional
        One a core unless given.
    progress : bool or callable
        A bar on standard error, in a log four lines; or a callback with the pairs decided and all pairs, ten times a
        second. An exception in it stops the work.

    Raises
    ------
    KickdriftError, BudgetError
        As :func:`decide`, for the first pair that has such an error.
    KeyboardInterrupt
        Within a second of Ctrl-C.

    Examples
    --------
    A stiffness per row, a step per column:

    >>> import kickdrift as kd
    >>> found = kd.verdicts(lambda1=[["pi^2"], [1]], lambda2="1/25", h1="1/10", h2=["1", "5/2", "7/2"])
    >>> found.stable.shape
    (2, 3)
    """
    fields = {"lambda1": lambda1, "lambda2": lambda2, "h1": h1, "h2": h2}
    arrays = [_array(field, value) for field, value in fields.items()]
    try:
        shape = np.broadcast_shapes(*(array.shape for array in arrays))
    except ValueError as error:
        shapes = ", ".join(str(array.shape) for array in arrays)
        raise KickdriftError("lambda1, lambda2, h1, h2", shapes, f"give shapes that broadcast: {error}") from None
    # Floats that are no doubles stay themselves, for as doubles they print other digits.
    short = [array.dtype.kind == "f" and array.dtype != np.float64 for array in arrays]
    values = [list(array.ravel()) if odd else array.ravel().tolist() for array, odd in zip(arrays, short, strict=True)]
    positions = [_positions(array, shape) for array in arrays]
    try:
        code, tier = _native.verdicts(values, positions, budget, threads, shown(progress, "pairs"))
    except BudgetError as error:
        raise _of_pair(error, shape) from None
    except KickdriftError as error:
        raise _placed(error, dict(zip(fields, arrays, strict=True))) from None
    return Verdicts(frozen(code.reshape(shape)), frozen(tier.reshape(shape)))


def _placed(error: KickdriftError, arrays: Mapping[str, npt.NDArray[Any]]) -> KickdriftError:
    """An error about the n-th value of an array, ``h1[5]``, as one about its entry, ``h1[1, 2]``."""
    name, _, place = error.field.removesuffix("]").partition("[")
    if name not in arrays or not place.isdigit():
        return error
    where = np.unravel_index(int(place), arrays[name].shape)
    return KickdriftError(placed(name, (int(n) for n in where)), error.value, error.remedy)


def _of_pair(error: BudgetError, shape: tuple[int, ...]) -> BudgetError:
    """An error about the n-th pair, ``pair 5: …``, as one about its place, ``pair [1, 2]: …``."""
    name, colon, work = error.field.partition(": ")
    number = name.removeprefix("pair ")
    if not (colon and name.startswith("pair ") and number.isdigit()):
        return error
    where = ", ".join(str(n) for n in np.unravel_index(int(number), shape))
    return BudgetError(f"pair [{where}]: {work}", error.needed, error.remedy)


def _array(field: str, value: Any) -> npt.NDArray[Any]:
    if np.ma.is_masked(value):
        raise KickdriftError(field, "masked entries", "fill them or leave them out: every entry counts")
    if isinstance(value, np.ndarray):
        return value
    # Texts and Fractions stay what they are.
    try:
        return np.array(value, dtype=object)
    except ValueError:
        raise KickdriftError(field, type(value).__name__, "give nested lists of equal lengths") from None


def _positions(array: npt.NDArray[Any], shape: tuple[int, ...]) -> npt.NDArray[np.int64]:
    places = np.arange(array.size, dtype=np.int64).reshape(array.shape)
    return np.ascontiguousarray(np.broadcast_to(places, shape)).ravel()
