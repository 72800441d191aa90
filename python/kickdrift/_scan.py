"""Verdicts on a system over one or two of its numbers."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from kickdrift._document import Told
from kickdrift._numbers import frozen

#: The fields of the numbers that vary.
AXES = ("scan_x", "scan_y")


class Scan(Told):
    """The verdict at each value of one number of a system, or of two: rows of ``x``, ``y``, ``kind`` and so on.

    Examples
    --------
    >>> import kickdrift as kd
    >>> system = kd.System({"masses": [1], "potentials": [{"step": 1, "springs": [[0, None, 1]]}]})
    >>> found = system.scan({"outer": (1, 3, 1)})
    >>> found, found.stable.tolist()
    (Scan(3 verdicts: outer=1..3:1), [True, False, False])
    """

    @property
    def stable(self) -> npt.NDArray[np.bool_]:
        """Whether each is stable, in the order of the rows; False where nothing is proven."""
        return frozen(np.isin(self.column("kind").astype(str), ["elliptic", "coexistence"]))

    def _given(self) -> list[str]:
        given: dict[str, Any] = self.data["input"]
        title = [given["title"]] if given.get("title") else []
        return [*title, *(given[axis] for axis in AXES if axis in given)]

    def to_svg(self) -> str:
        """The program's figure: growth rates over one number, verdicts over two.

        Examples
        --------
        >>> import kickdrift as kd
        >>> system = kd.System({"masses": [1], "potentials": [{"step": 1, "springs": [[0, None, 1]]}]})
        >>> system.scan("outer=1..3:1/2").to_svg().startswith("<svg")
        True
        """
        return self._asked.svg()
