"""Exact numbers: what functions take, and how they are written for the library."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from decimal import Decimal
from fractions import Fraction
from typing import Any, TypeAlias, TypeGuard, TypeVar

import numpy as np
import numpy.typing as npt

from kickdrift import _native
from kickdrift._errors import KickdriftError, shown
from kickdrift._native import Number

Exact: TypeAlias = int | float | Fraction | Decimal | str | Number | Any
"""An exact number: an int, a Fraction, a Decimal, a text such as ``"pi^2/25"`` (``**`` is ``^``), a SymPy number
without rounded parts, a NumPy scalar, a Number. A float means what it prints, its shortest decimal: 0.02 is 1/50."""


Range: TypeAlias = tuple[Exact, Exact] | str | Mapping[str, float]
"""A closed range: a pair of exact numbers, a text ``"LO..HI"``, or an enclosure of a row, with ``lo`` and ``hi``."""

Spaced: TypeAlias = tuple[Exact, Exact, Exact] | str
"""Values from one end of a range on by a spacing: three exact numbers, or a text ``"LO..HI:BY"``."""

Families: TypeAlias = int | tuple[int, int] | str
"""The integers a or b of families: one, both ends of a range, or a text as ``"-2..3"``."""

Labels: TypeAlias = int | str | Iterable[int]
"""Labels m: one, several, or a text such as ``"1,3,7..9"``."""


def number(value: Exact) -> Number:
    """Return the exact number that a value denotes.

    Parameters
    ----------
    value : Exact
        A float is the number that it prints: ``0.1`` is 1/10, and so is ``numpy.float32(0.1)``. :func:`exact` gives the
        double itself.

    Returns
    -------
    Number
        A sum of terms c pi^k, c rational. It has an order, a hash, ``float(...)`` (rounded), ``str(...)`` (exact),
        ``.fraction`` (where it is rational) and ``.to_sympy()``.

    Raises
    ------
    KickdriftError
        Where the value denotes no such number; infinities and NaN are none.

    Examples
    --------
    >>> from decimal import Decimal
    >>> import kickdrift as kd
    >>> kd.number("0.1") == kd.number(Decimal("0.1")) == kd.number(0.1)
    True
    >>> kd.number("pi**2/25")
    Number('pi^2/25')
    >>> kd.number(0.02).fraction
    Fraction(1, 50)
    """
    return _native.number("number", value)


def exact(value: Any) -> Any:
    """Return the number that a float is to its last bit.

    Parameters
    ----------
    value : float, a float of NumPy's, or an array of such

    Returns
    -------
    Number, or an array of them of the same shape
        What :func:`decide` and :func:`verdicts` take: two doubles have a period of some 10^16 kicks, and a verdict
        all the same.

    Raises
    ------
    KickdriftError
        Where it is no number, as infinities and NaN are none.

    Examples
    --------
    >>> import kickdrift as kd
    >>> kd.exact(0.1).fraction
    Fraction(3602879701896397, 36028797018963968)
    >>> kd.exact(0.5) == kd.number(0.5)
    True
    >>> kd.decide(lambda1=1, lambda2="1/25", h1=kd.exact(0.1), h2=kd.exact(0.3)).stable
    True
    """
    if isinstance(value, np.ndarray):
        all_of_them = np.empty(value.shape, dtype=object)
        for place in np.ndindex(value.shape):
            all_of_them[place] = _exact(placed("number", place), value[place])
        return all_of_them
    return _exact("number", value)


def _exact(field: str, value: Any) -> Number:
    if isinstance(value, float | np.floating):
        if not np.isfinite(value):
            raise KickdriftError(field, shown(value), "give a finite float")
        above, below = value.as_integer_ratio()
        return _native.number(field, Fraction(int(above), int(below)))
    if not hasattr(value, "as_integer_ratio"):
        raise KickdriftError(field, shown(value), "give a finite float")
    return _native.number(field, value)


def placed(field: str, place: Iterable[int]) -> str:
    """The name of an entry of an array, as ``h1[3, 4]``; of a number without axes its own."""
    where = ", ".join(str(n) for n in place)
    return f"{field}[{where}]" if where else field


def text(field: str, value: Exact) -> str:
    """The exact number as the library reads it."""
    return str(_native.number(field, value))


def optional_text(field: str, value: Exact | None) -> str | None:
    """As :func:`text`, where something is given."""
    return None if value is None else text(field, value)


def range_text(field: str, value: Range) -> str:
    """A closed range as the library reads it."""
    if isinstance(value, str):
        return value.replace("**", "^")
    try:
        lo, hi = (value["lo"], value["hi"]) if isinstance(value, Mapping) else value
    except (TypeError, ValueError, KeyError):
        raise KickdriftError(field, shown(value), "give a pair (lo, hi), or a text as '1/100..7/2'") from None
    return f"{text(field, lo)}..{text(field, hi)}"


def families_text(field: str, value: Families) -> str:
    """Families as the library reads them."""
    return range_text(field, (value, value) if isinstance(value, int | np.integer) else value)


def spaced_text(field: str, value: Any, form: str) -> str:
    """Numbers by their names, as the library reads them: each with one value or with values from LO on by a spacing.

    Raises
    ------
    KickdriftError
        What is neither a text nor a mapping or pairs of names to such values.
    """
    if isinstance(value, str):
        return written(field, value).replace("**", "^")

    def one(name: str, values: Any) -> str:
        if isinstance(values, list | tuple) and len(values) == 3:
            lo, hi, by = (text(f"{field}[{name}]", part) for part in values)
            return f"{name}={lo}..{hi}:{by}"
        if isinstance(values, list | tuple):
            raise KickdriftError(f"{field}[{name}]", shown(values), form)
        return f"{name}={values if isinstance(values, str) else text(f'{field}[{name}]', values)}"

    return ",".join(one(written(field, name), values) for name, values in mapping_of(field, value, form).items())


def ratio_text(value: Exact) -> str:
    """A ratio of steps as the library reads it.

    Raises
    ------
    KickdriftError
        A float that was rounded from a simple fraction: it means what it prints, and has as many tongues.
    """
    exactly = _native.number("ratio", value)
    if isinstance(value, float | np.floating) and exactly.is_rational and exactly.fraction.denominator > _LONG:
        meant = simplest(float(value))
        if meant.denominator <= _SHORT:
            raise KickdriftError("ratio", shown(value), f"a float means what it prints: write '{meant}'")
    return str(exactly)


#: Denominators of floats that were rounded, and of the fractions that they stand for.
_LONG, _SHORT = 10**6, 10**4


def optional_range(field: str, value: Range | None) -> str | None:
    """As :func:`range_text`, where something is given."""
    return None if value is None else range_text(field, value)


def written(field: str, value: Any) -> str:
    """A value as the text that it prints, which the library can read.

    Raises
    ------
    KickdriftError
        Halves of surrogate pairs, which no text has, and integers of more digits than Python writes.
    """
    try:
        printed = str(value)
        printed.encode()
    except ValueError:
        raise KickdriftError(
            field,
            ascii(value) if isinstance(value, str) else shown(value),
            "write a number or a text of some hundred characters",
        ) from None
    return printed


def items(field: str, value: Any, remedy: str) -> list[Any]:
    """The items of a list, a one-dimensional array or another iterable; no number has any.

    Raises
    ------
    KickdriftError
        What has no items, and arrays with masked entries.
    """
    if np.ma.is_masked(value):
        raise KickdriftError(field, "masked entries", "fill them or leave them out: every entry counts")
    try:
        return list(value)
    except TypeError:
        raise KickdriftError(field, shown(value), remedy) from None


def flag(field: str, value: Any) -> bool:
    """A yes or no: whatever else Python takes for one may be a slip."""
    if not isinstance(value, bool | np.bool_):
        raise KickdriftError(field, shown(value), "give True or False")
    return bool(value)


def mapping_of(field: str, value: Any, remedy: str) -> Mapping[str, Any]:
    """A mapping from names to their values; pairs of a name and a value are one, too."""
    if isinstance(value, Mapping):
        return value
    pairs = [] if isinstance(value, str | bytes) else items(field, value, remedy)
    is_named = all(isinstance(pair, list | tuple) and len(pair) == 2 and isinstance(pair[0], str) for pair in pairs)
    found = {pair[0]: pair[1] for pair in pairs} if is_named else {}
    if not found or len(found) != len(pairs):
        raise KickdriftError(field, shown(value), remedy)
    return found


def pair_of(field: str, value: Any, remedy: str) -> tuple[Any, Any]:
    """The two parts of a pair."""
    parts = () if isinstance(value, str | bytes | Mapping) else items(field, value, remedy)
    if len(parts) != 2:
        raise KickdriftError(field, shown(value), remedy)
    return parts[0], parts[1]


def level_of(field: str, value: Any, remedy: str, step_at: int = 0) -> tuple[Any, Any]:
    """The step of a level and what acts there, which stand in either order; in doubt the step is at this place."""
    pair = pair_of(field, value, remedy)
    at = 1 - step_at if _is_number(pair[1 - step_at]) and not _is_number(pair[step_at]) else step_at
    return pair[at], pair[1 - at]


def _is_number(value: Any) -> bool:
    return isinstance(value, str | int | float | Fraction | Decimal | Number | np.generic)


def with_unit(field: str, value: Exact | None, unit: str) -> str | None:
    """A quantity as it is written; a number in this unit."""
    if value is None or isinstance(value, str):
        return value if value is None else written(field, value)
    return f"{text(field, value)}{unit}"


def names_text(field: str, value: Any, remedy: str) -> str:
    """Names as the library reads them: a text with commas, or several texts."""
    if isinstance(value, str):
        return written(field, value)
    several = items(field, value, remedy)
    for n, word in enumerate(several):
        if not isinstance(word, str):
            raise KickdriftError(f"{field}[{n}]", shown(word), remedy)
    return ",".join(written(field, word) for word in several)


def labels_text(value: Labels) -> str:
    """Labels as the library reads them."""
    if isinstance(value, str | int):
        return written("m", value)
    several = items("m", value, "give a label, several, or a text as '1,3,7..9'")
    return ",".join(written(f"m[{n}]", m) for n, m in enumerate(several))


#: Units of time by name, in fs.
_UNITS = {"as": Fraction(1, 1000), "fs": Fraction(1), "ps": Fraction(1000), "ns": Fraction(10**6)}

#: The longest step of a molecule that is believed without a unit, fs: bonds to hydrogen have periods of 9 to 11 fs, and
#: no atomistic integrator takes so long a step.
_BELIEVED = 100


def duration(field: str, value: Exact, unit: str, molecular: bool = True) -> Fraction:
    """A positive length of time in a unit, from a text with a unit of its own as ``"0.5fs"`` or a number in that unit.

    Raises
    ------
    KickdriftError
        What is no positive rational; of a molecule a number without a unit that is longer than any of its steps.
    """
    words = value.rstrip() if isinstance(value, str) else ""
    named = words[-2:] in _UNITS
    named_unit = words[-2:] if named else unit
    if named and unit not in _UNITS:
        raise KickdriftError(field, words, f"the system's steps are in {unit or 'no unit'}: give time_unit='fs' or so")
    step = rational(field, words[:-2] if named else value)
    if step <= 0:
        raise KickdriftError(field, str(value), "a step must be positive")
    if molecular and not named and step * _UNITS[unit] > _BELIEVED:
        remedy = f"is {_decimal(step)} {unit}, which no molecule bears: name the unit, as '{_decimal(step)}fs'"
        raise KickdriftError(field, str(value), remedy)
    return step if named_unit == unit else step * _UNITS[named_unit] / _UNITS[unit]


def rational(field: str, value: Exact) -> Fraction:
    """A rational number; an error names the field."""
    found = _native.number(field, value)
    if not found.is_rational:
        raise KickdriftError(field, str(found), "must be rational")
    return found.fraction


def _decimal(value: Fraction) -> str:
    return f"{float(value):.6g}"


def simplest(value: float, ulps: Fraction | int = Fraction(1, 2)) -> Fraction:
    """Return the simplest rational beside a positive double, for which it most likely stands.

    Parameters
    ----------
    value : float
        Positive.
    ulps : Fraction or int
        How many units in the last place it may be off: a half after one rounding. A short decimal that was
        multiplied by a rounded factor is off by two at most: half a unit of each, and one of the product.

    Raises
    ------
    KickdriftError
        Where the value is not positive and finite.

    Examples
    --------
    >>> import kickdrift as kd
    >>> kd.simplest(0.1), kd.simplest(0.1 * 3, ulps=2), kd.simplest(1 / 3)
    (Fraction(1, 10), Fraction(3, 10), Fraction(1, 3))
    """
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value[()]
    try:
        known = float(value) if isinstance(value, int | float | np.floating) else np.nan
    except OverflowError:
        known = np.inf
    if not 0 < known < np.inf:
        raise KickdriftError("number", shown(value), "give a positive finite float")
    if not isinstance(ulps, int | Fraction) or ulps < 0:
        raise KickdriftError("ulps", shown(ulps), "give an int or a Fraction, 0 or more")
    width = ulps * Fraction(float(np.spacing(value if isinstance(value, np.floating) else known)))
    return _between(Fraction(known) - width, Fraction(known) + width)


def positive(field: str, value: Any) -> float:
    """A positive finite double.

    Raises
    ------
    KickdriftError
        Any other value.
    """
    if not (isinstance(value, int | float | np.floating) and 0 < value < np.inf):
        raise KickdriftError(field, shown(value), "give a positive finite number")
    return float(value)


def _between(lo: Fraction, hi: Fraction) -> Fraction:
    """The rational of least denominator in a closed interval of positive numbers, by continued fractions."""
    whole = -(-lo.numerator // lo.denominator)
    if whole <= hi:
        return Fraction(whole)
    below = Fraction(lo.numerator // lo.denominator)
    return below + 1 / _between(1 / (hi - below), 1 / (lo - below))


def doubles(field: str, value: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """A read-only copy of finite real doubles.

    Raises
    ------
    KickdriftError
        Complex or masked entries, text, NaN, infinities: none is dropped in silence.
    """
    if np.ma.is_masked(value):
        raise KickdriftError(field, "masked entries", "fill them or leave them out: every entry counts")
    if _is_frozen(value):
        return value
    try:
        array = np.asarray(value)
        if array.dtype.kind == "c" or (array.dtype.kind == "O" and any(isinstance(x, complex) for x in array.flat)):
            raise KickdriftError(field, "complex entries", "give real numbers")
        array = np.array(array, dtype=np.float64, order="C")
    except (TypeError, ValueError, OverflowError) as cause:
        if isinstance(cause, KickdriftError):
            raise
        raise _no_doubles(field, value) from None
    if not np.isfinite(array).all():
        where = ", ".join(str(int(n)) for n in np.argwhere(~np.isfinite(array))[0])
        raise KickdriftError(field, f"an entry that is not finite, at [{where}]", "give finite numbers")
    return frozen(array)


def _no_doubles(field: str, value: Any) -> KickdriftError:
    """The error that names the first entry which is no number, or the whole where that is no array at all."""
    try:
        entries = np.array(value, dtype=object)
    except ValueError:
        return KickdriftError(field, shown(value), "give nested lists of equal lengths")
    for place in np.ndindex(entries.shape):
        try:
            float(entries[place])
        except (TypeError, ValueError, OverflowError):
            return KickdriftError(placed(field, place), shown(entries[place]), "give an array of numbers")
    return KickdriftError(field, shown(value), "give an array of numbers")


def _is_frozen(value: object) -> TypeGuard[npt.NDArray[np.float64]]:
    """Whether :func:`doubles` gave it, as far as can be seen."""
    if not isinstance(value, np.ndarray) or type(value) is not np.ndarray or value.dtype != np.float64:
        return False
    return value.base is None and not value.flags.writeable and bool(np.isfinite(value).all())


_T = TypeVar("_T", bound=np.generic)


def frozen(array: npt.NDArray[_T]) -> npt.NDArray[_T]:
    """The same array, read only."""
    array.setflags(write=False)
    return array
