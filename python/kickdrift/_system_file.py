"""A system as data: its document and arrays, read from a file and saved to one."""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from os import PathLike, fspath
from pathlib import Path
from types import MappingProxyType
from typing import Any, Self

import numpy as np
import numpy.typing as npt

from kickdrift._document import Asked, Frozen
from kickdrift._errors import KickdriftError, shown
from kickdrift._files import text_of
from kickdrift._numbers import doubles, number, text, written

_SCHEMA = "kickdrift/system/1"
_FILE, ARRAYS = "system.json", "arrays.npz"


@dataclass(frozen=True, eq=False, repr=False)
class SystemFile(Frozen):
    """What stands in the file of a system, and the arrays that it refers to."""

    document: Mapping[str, Any]
    arrays: Mapping[str, npt.NDArray[Any]] = field(default_factory=dict)
    notes: Sequence[str] = ()
    _path: Path | None = None
    _source: str = ""

    def __post_init__(self) -> None:
        for name, mapping in (("document", self.document), ("arrays", self.arrays)):
            if isinstance(mapping, str | PathLike):
                raise KickdriftError(name, shown(mapping), f"a file is read by System.read({fspath(mapping)!r})")
            if not isinstance(mapping, Mapping):
                raise KickdriftError(name, shown(mapping), "give a mapping of names to what they mean")
        kept = {name: doubles(name, array) for name, array in self.arrays.items()}
        object.__setattr__(self, "arrays", MappingProxyType(kept))

    @property
    def accuracy(self) -> float | None:
        """How well measured Hessians are known, relative to their norms; ``None`` of exact stiffnesses."""
        potentials = self.document.get("potentials", ())
        if not any(isinstance(potential.get("stiffness"), Mapping) for potential in potentials):
            return None
        return float(number(self.document.get("accuracy", "1e-6")))

    @classmethod
    def read(cls, path: str | PathLike[str]) -> Self:
        """Read a system file.

        Parameters
        ----------
        path : str or path
            The file; arrays that it refers to lie in its folder.

        Raises
        ------
        KickdriftError
            The file cannot be read. Its content is checked when it is used.

        Examples
        --------
        >>> import kickdrift as kd
        >>> try:
        ...     kd.System.read("nowhere.json")
        ... except kd.KickdriftError as error:
        ...     print(error.field)
        nowhere.json
        """
        source = text_of(path, "name a system file")
        try:
            document = json.loads(source, parse_float=str)
        except (ValueError, RecursionError) as cause:
            raise KickdriftError(str(path), "not read", f"{cause}: name a system file") from cause
        if not isinstance(document, dict):
            raise KickdriftError(str(path), "not read", "a system file is one JSON object: name another one")
        return cls(MappingProxyType(document), _path=Path(path), _source=source)

    def save(self, folder: str | PathLike[str]) -> Path:
        """Write ``system.json`` and ``arrays.npz`` to a folder, each as a whole; return the path of ``system.json``.

        Parameters
        ----------
        folder : str or path
            Made where it is missing.

        Returns
        -------
        Path
            That of ``system.json``.

        Examples
        --------
        >>> import tempfile
        >>> import kickdrift as kd
        >>> system = kd.System({"masses": [1], "potentials": [{"step": "1/10", "springs": [[0, None, 10]]}]})
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     kd.System.read(system.save(folder)).decide().stable
        True
        """
        there = Path(folder)
        there.mkdir(parents=True, exist_ok=True)
        # Beside their places until they are whole; the text last, without which nothing is read.
        ready = [(there / f".{name}.{os.getpid()}", there / name) for name in (ARRAYS, _FILE)]
        try:
            if self.arrays:
                with ready[0][0].open("wb") as file:
                    np.savez(file, allow_pickle=False, **self.arrays)
            ready[1][0].write_text(self._text())
            for part, place in ready[not self.arrays :]:
                part.replace(place)
        finally:
            for part, _ in ready:
                part.unlink(missing_ok=True)
        return there / _FILE

    def _text(self) -> str:
        document = {"schema": _SCHEMA} | {key: value for key, value in self.document.items() if key != "schema"}
        return json.dumps(_exact(document), indent=2) + "\n"

    @contextmanager
    def _file(self) -> Iterator[str]:
        if self._path is not None:
            yield str(self._path)
            return
        with tempfile.TemporaryDirectory(prefix="kickdrift-") as folder:
            yield str(self.save(folder))

    def _fields(self) -> dict[str, str | list[str]]:
        if self._path is not None:
            return {"file": self._path.name, "system": self._source}
        return {"file": _FILE, "system": self._text()}

    def _place(self) -> str | Mapping[str, npt.NDArray[Any]]:
        return self.arrays if self._path is None else str(self._path.parent)

    def _about(self, asked: Asked) -> Asked:
        """The question about this system."""
        return replace(asked, fields=self._fields() | dict(asked.fields), place=self._place())


def _exact(value: Any, field: str = "document") -> Any:
    """Whatever stands for an exact number as its text; JSON would round it or not know it. An error names its place."""
    if isinstance(value, Mapping):
        return {written(field, key): _exact(part, f"{field}.{key}") for key, part in value.items()}
    if isinstance(value, np.ndarray):
        # Its own entries: a float of NumPy's means what it prints, as any other.
        if np.ma.is_masked(value):
            raise KickdriftError(field, "masked entries", "fill them or leave them out: every entry counts")
        return _exact(list(value), field) if value.ndim else text(field, value[()])
    if isinstance(value, list | tuple):
        return [_exact(part, f"{field}[{n}]") for n, part in enumerate(value)]
    if value is None or isinstance(value, bool | str):
        return value
    return value if isinstance(value, int) else text(field, value)
