"""Tongues: every unstable interval of a ratio of steps, and where they close."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Literal

import numpy as np
import numpy.typing as npt

from kickdrift import _plot
from kickdrift._document import Asked, Table, answered
from kickdrift._numbers import (
    Exact,
    Families,
    Labels,
    Range,
    families_text,
    labels_text,
    names_text,
    optional_range,
    optional_text,
    ratio_text,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes


class Tongues(Table):
    """Unstable intervals in s = h1² lambda1, each with its label m, family (a, b), two certified edges and width.

    Examples
    --------
    >>> import kickdrift as kd
    >>> found = kd.tongues("7/3", rho="1/25", m="3..5")
    >>> [row["m"] for row in found]
    [3, 4, 5]
    """

    @property
    def lower(self) -> npt.NDArray[np.float64]:
        """The lower edges in s, enclosed: shape (n, 2)."""
        return self.column("lower").reshape(-1, 2)

    @property
    def upper(self) -> npt.NDArray[np.float64]:
        """The upper edges, as the lower ones; NaN where a tongue has none."""
        return self.column("upper").reshape(-1, 2)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the tongues as bars from edge to edge in s, one line a tongue, coloured by the family's a.

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Where to draw; a new figure unless given.

        Examples
        --------
        >>> import kickdrift as kd
        >>> kd.tongues("7/3", rho="1/25").plot().get_xlabel()
        '$s = h_1^2 \\\\lambda_1$'
        """
        return _plot.tongues(self.rows, ax)

    def to_svg(self) -> str:
        """The atlas in the (h1, h2) plane as SVG, of tongues asked for with ``lambda1``, ``h1`` and ``h2``.

        Examples
        --------
        >>> import kickdrift as kd
        >>> found = kd.tongues(max_sum=6, lambda1="pi^2", lambda2="pi^2/25", h1=("1/10", "2/pi"), h2=("1/10", "7/2"))
        >>> found.to_svg().startswith("<svg")
        True
        """
        # An atlas shows edges alone.
        fields = {name: text for name, text in self._asked.fields.items() if name != "digits"}
        return Asked("tongues", {**fields, "columns": "edges"}).svg()

    def _repr_svg_(self) -> str | None:
        asked = self.data["input"]
        return self.to_svg() if {"lambda1", "h1_range", "h2_range"} <= asked.keys() else None


def _ratios(given: Exact | Iterable[Exact]) -> str:
    """One ratio or several, as the library reads them."""
    if isinstance(given, str):
        given = given.split(",")
    several: Iterable[Exact] = given if isinstance(given, Iterable) else [given]
    return ",".join(ratio_text(ratio) for ratio in several)


def tongues(
    ratio: Exact | Iterable[Exact] | None = None,
    *,
    max_sum: int | None = None,
    rho: Exact | None = None,
    lambda1: Exact | None = None,
    lambda2: Exact | None = None,
    h1: Range | None = None,
    h2: Range | None = None,
    m: Labels | None = None,
    a: Families | None = None,
    b: Families | None = None,
    digits: int | None = None,
    columns: Iterable[Literal["edges", "exact", "growth", "predicted", "first-order"]] | None = None,
) -> Tongues:
    """Find every unstable interval of one ratio of steps, of some or of all, with certified edges.

    Parameters
    ----------
    ratio : Exact or iterable of them, optional
        h2/h1 = p/q, or several; or instead
    max_sum : int, optional
        All coprime p + q up to this number.
    rho : Exact, optional
        lambda2/lambda1 >= 0, rational; or give both stiffnesses.
    lambda1, lambda2 : Exact, optional
        The stiffnesses, 1/time²; with ``lambda1`` edges are given in h1 and h2 too.
    h1, h2 : Range, optional
        Only tongues that meet these closed ranges of steps (needs ``lambda1``).
    m : Labels, optional
        Only these labels.
    a, b : Families, optional
        Only these dominant families: an integer, a pair (lo, hi), or a text as ``"0..2"``.
    digits : int, optional
        Significant digits of the edges, as decimals.
    columns : iterable of str, optional
        What to give beside the edges; all unless given, and without growth for many ratios.

    Raises
    ------
    KickdriftError
        Bad input, with its field, value and remedy.

    Examples
    --------
    >>> import kickdrift as kd
    >>> tongue = kd.tongues("7/3", rho="1/25", m=4, digits=30)[0]
    >>> tongue["lower"]["entry"], tongue["closed"]
    ('C', False)
    >>> [(row["p"], row["q"], row["m"]) for row in kd.tongues(["3/2", "5/2"], rho="1/25", m=1)]
    [(3, 2, 1), (5, 2, 1)]
    """
    return answered(
        Tongues,
        "tongues",
        "tongues",
        ratio=None if ratio is None else _ratios(ratio),
        max_sum=max_sum,
        rho=optional_text("rho", rho),
        lambda1=optional_text("lambda1", lambda1),
        lambda2=optional_text("lambda2", lambda2),
        h1_range=optional_range("h1", h1),
        h2_range=optional_range("h2", h2),
        m=None if m is None else labels_text(m),
        a=None if a is None else families_text("a", a),
        b=None if b is None else families_text("b", b),
        digits=digits,
        columns=None if columns is None else names_text("columns", columns, "name them, as ['edges']"),
    )


class Closings(Table):
    """Where tongues close: pairs (s, rho) at which a resonance does not destabilize.

    Examples
    --------
    >>> import kickdrift as kd
    >>> closed = kd.closings("5/3")[0]
    >>> closed["m"], closed["s"]["exact"], closed["rho"]["exact"]
    (4, '11/4', '114/55')
    """

    @property
    def s(self) -> npt.NDArray[np.float64]:
        """s of each closing, enclosed: shape (n, 2)."""
        return self.column("s").reshape(-1, 2)

    @property
    def rho(self) -> npt.NDArray[np.float64]:
        """lambda2/lambda1 of each, as s."""
        return self.column("rho").reshape(-1, 2)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the closings in the (rho, s) plane.

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Where to draw; a new figure unless given.

        Examples
        --------
        >>> import kickdrift as kd
        >>> len(kd.closings(max_sum=8).plot().texts)
        4
        """
        return _plot.closings(self.rows, ax)


def closings(
    ratio: Exact | None = None,
    *,
    max_sum: int | None = None,
    m: Labels | None = None,
    rho: Range | None = None,
    samples: int | None = None,
    digits: int | None = None,
) -> Closings:
    """Find where tongues close.

    Parameters
    ----------
    ratio : Exact, optional
        h2/h1 = p/q; or instead
    max_sum : int, optional
        All coprime p + q up to this number, at most 200.
    m : Labels, optional
        Only these labels, with ``ratio``.
    rho : Range, optional
        The closed range of lambda2/lambda1, rational and positive; 1/10000..100 unless given.
    samples : int, optional
        Values of rho between which edges are seen to cross; 400 unless given.
    digits : int, optional
        Significant digits of s and rho.

    Raises
    ------
    KickdriftError
        Bad input, with its field, value and remedy.

    Examples
    --------
    >>> import kickdrift as kd
    >>> len(kd.closings(max_sum=8))
    4
    """
    return answered(
        Closings,
        "closings",
        "closings",
        ratio=optional_text("ratio", ratio),
        max_sum=max_sum,
        m=None if m is None else labels_text(m),
        rho_range=optional_range("rho", rho),
        samples=samples,
        digits=digits,
    )
