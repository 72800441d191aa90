"""Errors: what is wrong, with which value, and what to do instead."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from difflib import get_close_matches
from importlib import import_module
from inspect import Parameter, signature
from typing import Any


class KickdriftError(ValueError):
    """Input that makes no sense, or a file that cannot be read.

    Attributes
    ----------
    field : str
        The argument that is wrong, or the path.
    value : str or None
        Its value as it was given; ``None`` where it is missing.
    remedy : str
        What to do instead.

    Examples
    --------
    >>> import kickdrift as kd
    >>> try:
    ...     kd.decide(lambda1=1, lambda2=1, h1="0,3", h2=1)
    ... except kd.KickdriftError as error:
    ...     print(error.field, error.value)
    h1 0,3
    """

    def __init__(self, field: str, value: str | None, remedy: str) -> None:
        self.field = field
        self.value = value
        self.remedy = remedy
        about = f"{field} missing" if value is None else f"{field} = {_short(value)}"
        super().__init__(f"{about}: {remedy}")

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.field, self.value, self.remedy)


class BudgetError(KickdriftError):
    """Work that costs more than its limit, reported before it begins.

    Attributes
    ----------
    field : str
        The work, and what it would cost.
    needed : int or None
        The ``budget`` that allows it; ``None`` where none does.
    remedy : str
        What to do instead.

    Examples
    --------
    >>> import kickdrift as kd
    >>> try:
    ...     kd.decide(lambda1=1, lambda2="1/25", h1="1/1003", h2="1/997", exact=True, budget=1000)
    ... except kd.BudgetError as error:
    ...     print(error.needed, error.remedy)
    11000 choose steps with a simpler ratio
    """

    def __init__(self, field: str, needed: int | None, remedy: str) -> None:
        self.needed = needed
        allow = None if needed is None else f"allow it with budget={needed}"
        super().__init__(field, None, remedy)
        self.args = (f"{field}: {', or '.join(part for part in (allow, remedy) if part)}",)

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.field, self.needed, self.remedy)


def known(given: Mapping[str, object], *functions: Callable[..., object], elsewhere: str = "") -> None:
    """That one of the functions takes each of these keywords.

    Raises
    ------
    KickdriftError
        One that none takes, with the nearest that there is, else with where it belongs, or with all of them.
    """
    every = (parameter for function in functions for parameter in signature(function).parameters.values())
    names = dict.fromkeys(parameter.name for parameter in every if parameter.kind in _NAMED)
    for name, value in given.items():
        if name in names:
            continue
        if like := get_close_matches(name, names, n=2):
            raise KickdriftError("keyword", name, f"unknown; did you mean {' or '.join(like)}?")
        if elsewhere:
            raise KickdriftError(name, shown(value), elsewhere)
        raise KickdriftError("keyword", name, f"choose among {', '.join(names)}")


#: Keywords, as signatures have them.
_NAMED = (Parameter.KEYWORD_ONLY, Parameter.POSITIONAL_OR_KEYWORD)


def shown(value: object) -> str:
    """The representation of a value; its type where Python refuses to write it, as integers of thousands of digits."""
    try:
        return repr(value)
    except ValueError:
        return f"a {type(value).__name__} of too many digits"
    except MemoryError:
        raise
    except Exception:
        return f"a {type(value).__name__} without a representation"


def _short(value: str) -> str:
    line = "".join(" " if ord(c) < 32 else c for c in value)
    return line if len(line) <= 60 else f"{line[:30]}...{line[-15:]} ({len(line)} characters)"


def required(package: str, *more: str) -> Any:
    """An optional package, or a module of it; and the packages that are needed beside it."""
    try:
        return import_module(package)
    except ImportError:
        raise needs(package.partition(".")[0], *more) from None


def needs(*packages: str) -> KickdriftError:
    """The error where optional packages are not installed."""
    return KickdriftError(packages[0], "not installed", f"install {' and '.join(packages)} beside kickdrift")
