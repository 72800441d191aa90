"""Integrators: a word as its author writes it, and the catalogue."""

from __future__ import annotations

from kickdrift._document import Table, answered
from kickdrift._numbers import Exact, Range, optional_range, optional_text


class Word(Table):
    """An integrator as its author writes it: its stable and unstable intervals, and all that is known of it.

    Examples
    --------
    >>> import kickdrift as kd
    >>> found = kd.word("K(1/6) D(1/2) K(2/3, -1/36) D(1/2) K(1/6)")
    >>> found.data["order"], found.data["edge"]["exact"]
    (4, '12')
    """


class Methods(Table):
    """The catalogue of integrators.

    Examples
    --------
    >>> import kickdrift as kd
    >>> [row["edge_s"] for row in kd.methods() if row["name"] == "velocity-verlet"]
    ['4']
    """


def word(
    word: str | None = None,
    *,
    method: str | None = None,
    lambda1: Exact | None = None,
    lambda2: Exact | None = None,
    h: Exact | None = None,
    h_range: Range | None = None,
    friction: Exact | None = None,
    budget: int | None = None,
) -> Word:
    """Decide consistency, symmetry, order, stable steps and cost of an integrator, and its verdict at one step.

    Parameters
    ----------
    word : str, optional
        Kicks K, K1, K2, drifts D, implicit midpoints C, exact flows R, friction O and repetitions n*(...), as "K(1/2)
        D(1) K(1/2)".
    method : str, optional
        A name of the catalogue in place of a word, see `methods`.
    lambda1, lambda2 : Exact, optional
        The stiffnesses of K1 (or K) and K2; both where the word names two forces, lambda2/lambda1 rational.
    h : Exact, optional
        The step of the whole word at which the verdict is asked for.
    h_range : Range, optional
        Only the intervals that meet this range of steps.
    friction : Exact, optional
        The friction of letters O, F and I, in 1/time; without it they do nothing.
    budget : int, optional
        The most kicks of a word; 100 unless given.

    Raises
    ------
    KickdriftError, BudgetError
        A text that is no word, with the place; more kicks than the budget allows.

    Examples
    --------
    >>> import kickdrift as kd
    >>> kd.word("K(1/2) D(1) K(1/2)").data["edge"]["omega_h"]
    {'lo': 2.0, 'hi': 2.0}
    >>> kd.word(method="respa-4", lambda1=1, lambda2="1/25", h=4).data["verdict"]["kind"]
    'elliptic'
    """
    return answered(
        Word,
        "word",
        "intervals",
        budget,
        word=word,
        method=method,
        lambda1=optional_text("lambda1", lambda1),
        lambda2=optional_text("lambda2", lambda2),
        h=optional_text("h", h),
        h_range=optional_range("h_range", h_range),
        friction=optional_text("friction", friction),
    )


def methods() -> Methods:
    """List published integrators: order on oscillators, cost, stable steps, efficiency, source.

    Examples
    --------
    >>> import kickdrift as kd
    >>> "pefrl" in [row["name"] for row in kd.methods()]
    True
    """
    return answered(Methods, "methods", "methods", None)
