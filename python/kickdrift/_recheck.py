"""Documents rechecked: every claim found again by another route."""

from __future__ import annotations

from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Protocol

from kickdrift import _native
from kickdrift._errors import KickdriftError


class HasJson(Protocol):
    """A result with a document."""

    def to_json(self) -> str: ...


@dataclass(frozen=True)
class Recheck:
    """What a recheck found.

    Attributes
    ----------
    rows : int
        The rows of the document.
    route : str
        How they were rechecked, in words.
    sample : tuple of int or None
        (drawn, of) where the slower route took a sample.
    not_rechecked : tuple of str
        The fields that were not rechecked, each with the reason.
    failures : tuple of (row, place, why)
        The rows that do not hold.
    """

    rows: int
    route: str
    sample: tuple[int, int] | None
    not_rechecked: tuple[str, ...]
    failures: tuple[tuple[int, str, str], ...]

    @property
    def holds(self) -> bool:
        """Whether no row fails."""
        return not self.failures

    def __bool__(self) -> bool:
        return self.holds


def recheck(document: HasJson | str | PathLike[str], *, all: bool = False, budget: int | None = None) -> Recheck:
    """Find every claim of a document again by another route than the one that made it.

    Parameters
    ----------
    document : a result, or the path of a JSON document, or its text
        Whole, as it was written.
    all : bool
        Take the slower route for every pair or tongue of a map or survey, and not for a sample.
    budget : int, optional
        The most kicks that one verdict may compose.

    Raises
    ------
    KickdriftError
        What is no document of this program; what does not hold is no error but a failure.

    Examples
    --------
    >>> import kickdrift as kd
    >>> found = kd.recheck(kd.tongues("5/3", rho="1/25"))
    >>> found.holds, found.rows
    (True, 7)
    """
    outcome = _native.recheck(_text(document), all, budget)
    rows, route, sample, not_rechecked, failures = outcome
    return Recheck(rows, route, sample, tuple(not_rechecked), tuple(failures))


def _text(document: HasJson | str | PathLike[str]) -> str:
    if hasattr(document, "to_json"):
        return str(document.to_json())
    if isinstance(document, str) and document.lstrip().startswith("{"):
        return document
    try:
        return Path(document).read_text()
    except OSError as cause:
        raise KickdriftError(str(document), "not read", f"{cause}: name a JSON document") from cause
