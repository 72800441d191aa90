"""Exact numbers: what functions take, and how they are written for the library."""

from __future__ import annotations

from collections.abc import Iterable
from decimal import Decimal
from fractions import Fraction
from typing import Any, TypeAlias

from kickdrift import _native
from kickdrift._errors import KickdriftError
from kickdrift._native import Number

Exact: TypeAlias = int | float | Fraction | Decimal | str | Number | Any
"""An exact number: an int, a Fraction, a Decimal, a text such as ``"pi^2/25"`` (``**`` is ``^``), a SymPy number
without rounded parts, a NumPy scalar, a Number. A float means exactly that double."""

Range: TypeAlias = tuple[Exact, Exact] | str
"""A closed range: a pair of exact numbers, or a text ``"LO..HI"``."""

Labels: TypeAlias = int | str | Iterable[int]
"""Labels m: one, several, or a text such as ``"1,3,7..9"``."""


def number(value: Exact) -> Number:
    """Return the exact number that a value denotes.

    Parameters
    ----------
    value : Exact
        A float is the number that the double is to its last bit: ``0.1`` is not 1/10, ``"0.1"`` is.

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
    >>> kd.number("0.1") == kd.number(Decimal("0.1")), kd.number(0.1) == kd.number("0.1")
    (True, False)
    >>> kd.number("pi**2/25")
    Number('pi^2/25')
    >>> kd.number(0.1).fraction
    Fraction(3602879701896397, 36028797018963968)
    """
    return _native.number("number", value)


def text(field: str, value: Exact) -> str:
    """The exact number as the library reads it."""
    return str(_native.number(field, value))


def range_text(field: str, value: Range) -> str:
    """A closed range as the library reads it."""
    if isinstance(value, str):
        return value.replace("**", "^")
    try:
        lo, hi = value
    except (TypeError, ValueError):
        raise KickdriftError(field, repr(value), "give a pair (lo, hi), or a text as '1/100..7/2'") from None
    return f"{text(field, lo)}..{text(field, hi)}"


def labels_text(value: Labels) -> str:
    """Labels as the library reads them."""
    if isinstance(value, str):
        return value
    return ",".join(str(m) for m in ([value] if isinstance(value, int) else value))
