"""Documents rechecked: every claim found again by another route."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Protocol, runtime_checkable

from kickdrift import _native
from kickdrift._errors import KickdriftError, shown
from kickdrift._files import text_of
from kickdrift._numbers import flag, written
from kickdrift._system import SystemVerdict


@runtime_checkable
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

    Examples
    --------
    >>> import kickdrift as kd
    >>> found = kd.recheck(kd.tongues("5/3", rho="1/25"))
    >>> found.holds, found.rows, found.failures
    (True, 7, ())
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


def recheck(
    document: HasJson | str | PathLike[str],
    *,
    all: bool = False,
    budget: int | None = None,
    folder: str | PathLike[str] | None = None,
) -> Recheck:
    """Find every claim of a document again by a route that did not make it.

    Parameters
    ----------
    document : a result, or the path of a JSON document, or its text
        Whole, as it was written.
    all : bool
        Take the slower route for every pair or tongue of a map or survey, and not for a sample.
    budget : int, optional
        The most kicks that one verdict may compose.
    folder : path, optional
        Where the files are that a system of measured Hessians refers to; for a verdict on a system and for a file it
        is known.

    Raises
    ------
    KickdriftError
        The file is no document of this program. A value that does not hold is no error but a failure.

    Examples
    --------
    >>> import kickdrift as kd
    >>> found = kd.recheck(kd.tongues("5/3", rho="1/25"))
    >>> found.holds, found.rows
    (True, 7)
    """
    with _folder(document, folder) as place:
        rows, route, sample, not_rechecked, failures = _native.recheck(_text(document), flag("all", all), budget, place)
    return Recheck(rows, route, sample, tuple(not_rechecked), tuple(failures))


@contextmanager
def _folder(document: HasJson | str | PathLike[str], folder: str | PathLike[str] | None) -> Iterator[str]:
    if folder is None and isinstance(document, SystemVerdict):
        with document.system._file() as path:
            yield str(Path(path).parent)
    elif folder is None and not isinstance(document, HasJson) and not _is_json(document):
        yield str(Path(document).parent) if isinstance(document, str | PathLike) else ""
    elif folder is None or isinstance(folder, str | PathLike):
        yield written("folder", str(folder or ""))
    else:
        raise KickdriftError("folder", shown(folder), "name a folder")


def _is_json(document: object) -> bool:
    return isinstance(document, str) and document.lstrip().startswith("{")


def _text(document: HasJson | str | PathLike[str]) -> str:
    if isinstance(document, HasJson):
        return document.to_json()
    if isinstance(document, str) and _is_json(document):
        return document
    return text_of(document, "name a JSON document")
