"""SciPy's modules, each imported where something of it is first used: it is asked for by what needs it alone."""

from __future__ import annotations

from typing import Any

from kickdrift._errors import required


class _Module:
    """A module of SciPy's."""

    def __init__(self, name: str) -> None:
        self._name = name

    def __getattr__(self, name: str) -> Any:
        return getattr(required(self._name), name)


sparse: Any = _Module("scipy.sparse")
csgraph: Any = _Module("scipy.sparse.csgraph")
linalg: Any = _Module("scipy.sparse.linalg")
spatial: Any = _Module("scipy.spatial")
special: Any = _Module("scipy.special")
