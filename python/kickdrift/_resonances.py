"""Resonances: the curves of the families (a, b), and the Proposition about them."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from kickdrift import _plot
from kickdrift._document import Table, answered, frame
from kickdrift._numbers import Exact, Families, Range, families_text, frozen, range_text, text

if TYPE_CHECKING:
    import pandas
    from matplotlib.axes import Axes


class Curves(Table):
    """The resonance curves 1/T½ = a/h1 + b/h2, sampled.

    Examples
    --------
    >>> import kickdrift as kd
    >>> [(curve["a"], curve["b"]) for curve in kd.curves(a="0..1", b="0..1", samples=50)]
    [(0, 1)]
    """

    @property
    def points(self) -> Mapping[tuple[int, int], npt.NDArray[np.float64]]:
        """The points (h1, h2) of each family (a, b), shape (n, 2)."""
        found: dict[tuple[int, int], list[tuple[float, float]]] = {}
        for row in self.rows:
            family = found.setdefault((row["a"], row["b"]), [])
            family += [(point["h1"], point["h2"]) for point in row["points"]]
        return MappingProxyType({family: frozen(np.array(points).reshape(-1, 2)) for family, points in found.items()})

    def to_pandas(self) -> pandas.DataFrame:
        """One row a point: a, b, h1, h2 and so on.

        Examples
        --------
        >>> import kickdrift as kd
        >>> kd.curves(a="0..0", b="1..1", samples=50).to_pandas().columns[:4].tolist()
        ['a', 'b', 'h1', 'h2']
        """
        points = ({"a": row["a"], "b": row["b"], **point} for row in self.rows for point in row["points"])
        return frame(points)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the curves in the (h1, h2) plane.

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Where to draw; a new figure unless given.

        Examples
        --------
        >>> import kickdrift as kd
        >>> kd.curves(a="0..1", b="0..1").plot().get_ylabel()
        '$h_2$'
        """
        return _plot.curves(self.points, ax)


def curves(
    *,
    lambda1: Exact = "pi^2",
    h1: Range = ("1/1000", "2/pi"),
    h2: Range = ("1/1000", "7/2"),
    a: Families = "0..3",
    b: Families = "-12..12",
    samples: int = 400,
) -> Curves:
    """Sample the (a, b) families of resonance curves.

    Parameters
    ----------
    lambda1 : Exact
        The fast stiffness, 1/time².
    h1, h2 : Range
        The closed ranges of steps.
    a, b : Families
        Which families: an integer, a pair (lo, hi), or a text as ``"-2..3"``.
    samples : int
        Points a curve, evenly spaced in theta.

    Raises
    ------
    KickdriftError
        Bad input, with its field, value and remedy.

    Examples
    --------
    >>> import kickdrift as kd
    >>> curve = kd.curves(a="1..1", b="0..0", samples=3)
    >>> curve.data["input"]["lambda1"]
    'pi^2'
    """
    return answered(
        Curves,
        "curves",
        "curves",
        lambda1=text("lambda1", lambda1),
        h1_range=range_text("h1", h1),
        h2_range=range_text("h2", h2),
        a=families_text("a", a),
        b=families_text("b", b),
        samples=samples,
    )


class Proposition(Table):
    """The paper's Proposition checked: a witness (a, b) for each resonant point (p, q, m).

    Examples
    --------
    >>> import kickdrift as kd
    >>> kd.proposition(max=5).holds
    True
    """

    @property
    def holds(self) -> bool:
        """Whether no point fails."""
        return bool(self.data["holds"])


def proposition(max: int | None = None) -> Proposition:
    """Check the Proposition exhaustively and exactly, with witnesses.

    Parameters
    ----------
    max : int, optional
        All coprime p, q up to this number; 60 unless given.

    Raises
    ------
    KickdriftError
        Bad input, with its field, value and remedy.

    Examples
    --------
    >>> import kickdrift as kd
    >>> kd.proposition(max=2).rows[0]["b"]
    1
    """
    return answered(Proposition, "proposition", "witnesses", max=max)
