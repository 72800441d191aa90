"""Bands: steps at which every ratio is unstable."""

from __future__ import annotations

from kickdrift._document import Table, answered
from kickdrift._numbers import Exact, Range, optional_range, optional_text


class Bands(Table):
    """Sectors of steps in which every ratio h2/h1, rational or not, is proven unstable.

    Examples
    --------
    >>> import kickdrift as kd
    >>> found = kd.bands(lambda1="pi^2", lambda2="pi^2/25", h1="1/5..1/4", h2="9/10..1", sectors=500)
    >>> found.data["share"]["lo"] > 0.3
    True
    """


def bands(
    *,
    lambda1: Exact,
    lambda2: Exact,
    h1: Range,
    h2: Range,
    area: Exact | None = None,
    sectors: int | None = None,
    budget: int | None = None,
) -> Bands:
    """Find sectors of (h1, h2) in which every ratio h2/h1, rational or not, is proven unstable.

    A sector is a part of the tongue of the paper's curve (a, b): ratios from ``ratio_from`` to ``ratio_to``, and h1
    between a lower and an upper side, each affine in the ratio from ``lower_from`` to ``lower_to`` and from
    ``upper_from`` to ``upper_to``. Nothing is claimed of steps in no sector: they may be stable or not.

    Parameters
    ----------
    lambda1, lambda2 : Exact
        The stiffnesses of the fast and of the slow force, both positive.
    h1, h2 : Range
        The closed ranges of both steps.
    area : Exact, optional
        End where this share of the window is certified.
    sectors : int, optional
        The most sectors that are tried; 100000 unless given.
    budget : int, optional
        The largest number of sectors that may be asked for.

    Raises
    ------
    KickdriftError, BudgetError
        Bad input; more sectors than the budget allows.

    Examples
    --------
    >>> import kickdrift as kd
    >>> found = kd.bands(lambda1="pi^2", lambda2="pi^2/25", h1="1/5..1/4", h2="9/10..1", sectors=500)
    >>> found[0]["a"], found[0]["b"]
    (0, 1)
    """
    return answered(
        Bands,
        "bands",
        "sectors",
        budget,
        lambda1=optional_text("lambda1", lambda1),
        lambda2=optional_text("lambda2", lambda2),
        h1_range=optional_range("h1", h1),
        h2_range=optional_range("h2", h2),
        area=optional_text("area", area),
        sectors=sectors,
    )
