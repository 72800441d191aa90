"""The four entries of half a period."""

from __future__ import annotations

from kickdrift._document import Table, answered
from kickdrift._numbers import Exact, ratio_text, text


class Half(Table):
    """The four entries of a half period.

    Examples
    --------
    >>> import kickdrift as kd
    >>> [row["exact"] for row in kd.half("1/1", s=1, rho=0)]
    ['3/4', '1/2', '-1/2', '1']
    """


def half(ratio: Exact, *, s: Exact, rho: Exact, budget: int | None = None) -> Half:
    """Compute A, B, C, D of the half period, exact and enclosed, in the time unit h1.

    Parameters
    ----------
    ratio : Exact
        h2/h1 = p/q.
    s : Exact
        h1² lambda1, rational.
    rho : Exact
        lambda2/lambda1, rational.
    budget : int, optional
        The largest p + q; 2000 unless given.

    Raises
    ------
    KickdriftError, BudgetError
        Bad input; more kicks than the budget allows.

    Examples
    --------
    >>> import kickdrift as kd
    >>> kd.half("5/3", s="11/4", rho="1/25")[0]["sign"]
    1
    """
    return answered(Half, "half", "entries", budget, ratio=ratio_text(ratio), s=text("s", s), rho=text("rho", rho))
