"""Stable and unstable intervals of a system's outer step."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from kickdrift import _plot
from kickdrift._document import Table
from kickdrift._numbers import frozen

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True, eq=False, repr=False)
class Intervals(Table):
    """Stretches of the outer step, ``lo`` to ``hi``: ``stable``, ``unstable``, or ``the data do not tell``.

    Examples
    --------
    >>> import numpy as np
    >>> import kickdrift as kd
    >>> system = kd.System.from_hessians([1.0], {"stiff": ("1/40", [[400.0]]), "soft": ("1/10", [[1.0]])})
    >>> found = system.intervals(("1/20", "1/5"))
    >>> found
    Intervals(5 stretches: outer = 1/20..1/5)
    >>> [row["verdict"] for row in found], found.plot().get_xlabel()
    (['stable', 'the data do not tell', 'unstable', 'the data do not tell', 'stable'], 'outer step')
    """

    @property
    def edges(self) -> npt.NDArray[np.float64]:
        """Where each stretch begins and ends, shape (n, 2)."""
        return frozen(np.stack([self.column("lo"), self.column("hi")], axis=1))

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the stretches over the outer step.

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Where to draw; a new figure unless given.

        Examples
        --------
        >>> import kickdrift as kd
        >>> system = kd.System.from_hessians([1.0], {"stiff": ("1/40", [[400.0]]), "soft": ("1/10", [[1.0]])})
        >>> system.intervals(("1/20", "1/5")).plot().get_xlabel()
        'outer step'
        """
        return _plot.intervals(self.edges, self.column("verdict"), ax)

    def _given(self) -> list[str]:
        given = self.data["input"]
        title = [given["title"]] if given.get("title") else []
        return [*title, given["intervals"].replace("=", " = ")]

    def to_svg(self) -> str:
        """The program's figure: the stretches, and growth where it is unstable.

        Examples
        --------
        >>> import kickdrift as kd
        >>> system = kd.System.from_hessians([1.0], {"stiff": ("1/40", [[400.0]]), "soft": ("1/10", [[1.0]])})
        >>> system.intervals(("1/20", "1/5")).to_svg().startswith("<svg")
        True
        """
        return self._asked.svg()
