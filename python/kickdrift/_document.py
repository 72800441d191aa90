"""Results as documents: JSON to the last byte as the program writes it, tables for notebooks and for pandas."""

from __future__ import annotations

import html
import json
import shlex
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from dataclasses import fields as parts
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Self, TypeVar, cast, overload

import numpy as np
import numpy.typing as npt

from kickdrift import _native
from kickdrift._errors import KickdriftError, required
from kickdrift._numbers import frozen, written

if TYPE_CHECKING:
    import pandas

#: A row of a result: its fields by name, read only.
Row = Mapping[str, Any]

_SHOWN = 20

#: The flags of fields that have other names.
_FLAGS = {"width": "resolution", "scan_x": "scan", "scan_y": "scan"}


class Frozen:
    """A frozen dataclass whose copy is itself; it is pickled by its fields alone, which stay read only."""

    def __copy__(self) -> Self:
        return self

    def __deepcopy__(self, memo: object) -> Self:
        return self

    def __getstate__(self) -> dict[str, Any]:
        state = {part.name: getattr(self, part.name) for part in parts(cast(Any, self))}
        return {name: dict(value) if isinstance(value, MappingProxyType) else value for name, value in state.items()}

    def __setstate__(self, state: dict[str, Any]) -> None:
        for name, value in state.items():
            object.__setattr__(self, name, _held(value))


def _held(value: Any) -> Any:
    if isinstance(value, dict):
        for item in value.values():
            if isinstance(item, np.ndarray):
                frozen(item)
        return MappingProxyType(value)
    return frozen(value) if isinstance(value, np.ndarray) else value


@dataclass(frozen=True, eq=False, repr=False)
class Asked(Frozen):
    """A question of the library, which is answered once; a copy from another process asks again."""

    name: str
    #: A text each, or the texts of its parts.
    fields: Mapping[str, str | list[str]]
    budget: int | None = None
    #: Where the arrays are that a system refers to: the folder, or they themselves.
    place: str | Mapping[str, npt.NDArray[np.float64]] = ""
    #: Names of the files whose texts are fields.
    files: Mapping[str, list[str]] = field(default_factory=dict)

    @cached_property
    def _answer(self) -> _native.Answer:
        return _native.ask(self.name, *self._given())

    def _given(self) -> tuple[dict[str, str | list[str]], int | None, str | dict[str, npt.NDArray[np.float64]]]:
        place = self.place if isinstance(self.place, str) else dict(self.place)
        fields = {
            name: written(name, given) if isinstance(given, str) else [written(name, part) for part in given]
            for name, given in self.fields.items()
        }
        return fields, self.budget, place

    def render(self, form: str) -> str:
        """The answer as json, csv, latex or text, or a text with all details."""
        return self._answer.render(form)

    def svg(self) -> str:
        """The answer as the program draws it."""
        words = ["kickdrift", {"family": "word"}.get(self.name, self.name)]
        for name, value in {**self.fields, **self.files}.items():
            flag = "--" + _FLAGS.get(name, name.replace("_", "-"))
            several = [value] if isinstance(value, str) else value
            if name == "file" or (name == "word" and words[1] == "word"):
                words += several
            elif name not in ("system", "columns"):
                words += [word for text in several for word in ([flag] if text == "true" else [flag, text])]
        return _native.draw(self.name, *self._given(), shlex.join(words))


def question(name: str, budget: int | None = None, **fields: str | int | float | bool | None) -> Asked:
    """A question with fields; those that are None or False are not given."""
    given = ((field, value) for field, value in fields.items() if value is not None and value is not False)
    return Asked(name, {field: "true" if value is True else written(field, value) for field, value in given}, budget)


@dataclass(frozen=True, eq=False, repr=False)
class Document(Frozen):
    """A result, frozen, with the text of its JSON document.

    Two results are equal where their documents are.

    Examples
    --------
    >>> import kickdrift as kd
    >>> found = kd.proposition(max=3)
    >>> found.to_json() == kd.proposition(max=3).to_json()
    True
    >>> found.data["schema"]
    'kickdrift/proposition/1'
    """

    _json: str

    def to_json(self) -> str:
        """The document that the program writes for the same question, byte for byte.

        Examples
        --------
        >>> import kickdrift as kd
        >>> print(kd.decide(lambda1=1, lambda2=0, h1=1, h2=1).to_json()[:36])
        {
          "schema": "kickdrift/verdict/1",
        """
        return self._json

    @cached_property
    def data(self) -> Mapping[str, Any]:
        """The document as nested mappings and lists; numbers with a point are doubles."""
        return MappingProxyType(json.loads(self._json))

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and isinstance(other, Document) and self._json == other._json

    def __hash__(self) -> int:
        return hash(self._json)


@dataclass(frozen=True, eq=False, repr=False)
class Table(Document, Sequence[Row]):
    """A result that is rows: a sequence of read-only mappings.

    Examples
    --------
    >>> import kickdrift as kd
    >>> found = kd.tongues("5/3", rho="1/25")
    >>> len(found), found[3]["m"], found[3]["lower"]["lo"] < found[3]["upper"]["hi"]
    (7, 4, True)
    """

    _rows_are: str
    _asked: Asked

    @cached_property
    def rows(self) -> tuple[Row, ...]:
        """The rows, in the document's order; enclosures are mappings with ``lo`` and ``hi``."""
        return tuple(MappingProxyType(row) for row in self.data[self._rows_are])

    def __len__(self) -> int:
        return len(self.rows)

    @overload
    def __getitem__(self, index: int) -> Row: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[Row]: ...
    def __getitem__(self, index: int | slice) -> Row | Sequence[Row]:
        return self.rows[index]

    def __iter__(self) -> Iterator[Row]:
        return iter(self.rows)

    def column(self, name: str) -> npt.NDArray[Any]:
        """A field of all rows as an array, read only.

        Parameters
        ----------
        name : str
            A field, or a part of one as ``"lower.h1"``.

        Returns
        -------
        array
            Enclosures have shape (n, 2), ``lo`` beside ``hi``; all else has shape (n,). Where a row has no such number
            it is NaN, and None where others have texts.

        Raises
        ------
        KickdriftError
            A field that no row has.

        Examples
        --------
        >>> import kickdrift as kd
        >>> found = kd.tongues("5/3", rho="1/25")
        >>> found.column("m").tolist(), found.column("lower").shape
        ([1, 2, 3, 4, 5, 6, 7], (7, 2))
        """
        return column(self.rows, name)

    def to_csv(self) -> str:
        """The rows as CSV, all columns.

        Examples
        --------
        >>> import kickdrift as kd
        >>> kd.half("1/1", s=1, rho=0).to_csv().splitlines()[0].split(",")[:2]
        ['entry', 'sign']
        """
        return self._asked.render("csv")

    def to_latex(self) -> str:
        """The rows as a LaTeX table.

        Examples
        --------
        >>> import kickdrift as kd
        >>> r"\\begin{tabular}" in kd.half("1/1", s=1, rho=0).to_latex()
        True
        """
        return self._asked.render("latex")

    def to_pandas(self) -> pandas.DataFrame:
        """The rows as a data frame; the parts of a field stand beside each other, as ``lower_lo`` and ``lower_hi``.

        Raises
        ------
        KickdriftError
            Where pandas is not installed.

        Examples
        --------
        >>> import kickdrift as kd
        >>> frame = kd.tongues("5/3", rho="1/25").to_pandas()
        >>> bool((frame.lower_lo <= frame.lower_hi).all())
        True
        """
        return frame(flat(self.rows))

    def __repr__(self) -> str:
        given = ", ".join(self._given())
        return f"{type(self).__name__}({len(self)} {self._rows_are}{': ' if given else ''}{given})"

    def _given(self) -> list[str]:
        return [f"{key} = {value}" for key, value in self.data["input"].items()]

    def _repr_html_(self) -> str:
        """A table of the first rows for a notebook."""
        rows = flat(self.rows[:_SHOWN])
        names = list(dict.fromkeys(name for row in rows for name in row))
        head = "".join(f"<th>{html.escape(name)}</th>" for name in names)
        cells = ("".join(f"<td>{html.escape(_cell(row.get(name)))}</td>" for name in names) for row in rows)
        body = "".join(f"<tr>{row}</tr>" for row in cells)
        more = f"<p>{len(self) - _SHOWN} more rows</p>" if len(self) > _SHOWN else ""
        title = html.escape(f"{type(self).__name__}: {', '.join(self._given())}")
        return f"<p>{title}</p><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>{more}"


@dataclass(frozen=True, eq=False, repr=False)
class Told(Table):
    """A table whose answer has words, too: ``print`` shows them."""

    def __str__(self) -> str:
        return self._asked.render("text").rstrip()

    @property
    def details(self) -> str:
        """The whole answer with its tables, as the program's ``--details`` has it.

        Examples
        --------
        >>> import kickdrift as kd
        >>> "palindrome   yes" in kd.word("K(1/2) D(1) K(1/2)").details
        True
        """
        return self._asked.render("details").rstrip()


_Kind = TypeVar("_Kind", bound=Table)


def answered(kind: type[_Kind], name: str, rows: str, budget: int | None = None, **fields: str | int | None) -> _Kind:
    """The answer to a question; fields that are None are not given."""
    asked = question(name, budget, **fields)
    return kind(asked.render("json"), rows, asked)


def column(rows: Sequence[Row], name: str) -> npt.NDArray[Any]:
    """A field of all rows as an array, as :meth:`Table.column` has it."""
    values: list[Any] = list(rows)
    for part in name.split("."):
        if values and not any(isinstance(value, Mapping) and part in value for value in values):
            names = dict.fromkeys(field for value in values if isinstance(value, Mapping) for field in value)
            raise KickdriftError("name", name, f"there are {', '.join(names)}")
        values = [value.get(part) if isinstance(value, Mapping) else None for value in values]
    if any(isinstance(value, Mapping) for value in values):
        ends = ([None, None] if value is None else [value.get("lo"), value.get("hi")] for value in values)
        return frozen(np.array(list(ends), dtype=np.float64).reshape(-1, 2))
    if any(isinstance(value, str | list) for value in values):
        texts = np.empty(len(values), dtype=object)
        texts[:] = values
        return frozen(texts)
    return frozen(np.array(values, dtype=np.float64 if None in values else None))


def frame(rows: Iterable[Mapping[str, Any]]) -> pandas.DataFrame:
    """Rows as a data frame."""
    made: pandas.DataFrame = required("pandas").DataFrame(list(rows))
    return made


def flat(rows: Iterable[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """The fields of each row, those of its parts under joined names: a part that a row lacks is no column."""
    nested: set[str] = set()

    def fields(row: Mapping[str, Any], before: str = "") -> Iterator[tuple[str, Any]]:
        for name, value in row.items():
            if isinstance(value, Mapping):
                nested.add(before + name)
                yield from fields(value, f"{before}{name}_")
            else:
                yield f"{before}{name}", value

    every = [dict(fields(row)) for row in rows]
    return [{name: value for name, value in row.items() if value is not None or name not in nested} for row in every]


def _cell(value: object) -> str:
    return "" if value is None else f"{value:.10g}" if isinstance(value, float) else str(value)
