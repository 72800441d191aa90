"""Integrators: a word as its author writes it, with parameters, and the catalogue."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from kickdrift._document import Table, Told, answered
from kickdrift._numbers import Exact, Range, Spaced, optional_range, optional_text, spaced_text


class Word(Told):
    """An integrator as its author writes it: its stable and unstable intervals, its order, cost and engines.

    Its rows are the intervals. ``print`` shows the answer in words; ``data`` has all of it by name: ``order``,
    ``general_order``, ``edge``, ``efficiency`` and so on.

    Examples
    --------
    >>> import kickdrift as kd
    >>> found = kd.word("K(1/6) D(1/2) K(2/3, -1/36) D(1/2) K(1/6)")
    >>> found.data["order"], found.data["edge"]["exact"]
    (4, '12')
    >>> print(str(found).splitlines()[1].strip())
    stable       0 < omega h <= 3.4641016151377546(3) = sqrt(12)
    """

    def to_svg(self) -> str:
        """The program's figure: trace, frequency error and bias over the step, unstable steps shaded.

        Examples
        --------
        >>> import kickdrift as kd
        >>> kd.word(method="pefrl").to_svg().startswith("<svg")
        True
        """
        return self._asked.svg()


class Family(Told):
    """A word with a parameter: what is known of it at each value, and the best one.

    Its rows are the values. ``print`` shows the answer in words.

    Examples
    --------
    >>> import kickdrift as kd
    >>> found = kd.family("K(b) D(1) K(1-b)", parameter="b=0..1:1/4")
    >>> [row["order"] for row in found]
    [1, 1, 2, 1, 1]
    """

    def to_svg(self) -> str:
        """The program's figure: unstable steps, efficiency, error and bias over the parameter.

        Examples
        --------
        >>> import kickdrift as kd
        >>> kd.family("K(b) D(1) K(1-b)", parameter="b=0..1:1/4").to_svg().startswith("<svg")
        True
        """
        return self._asked.svg()


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


def family(
    word: str,
    *,
    parameter: str | Mapping[str, Spaced | Exact] | Sequence[tuple[str, Spaced | Exact]],
    maximize: str | None = None,
    minimize: str | None = None,
    up_to: Exact | None = None,
    lambda1: Exact | None = None,
    lambda2: Exact | None = None,
    budget: int | None = None,
) -> Family:
    """Decide order, error, stable steps and cost of a word at each value of a parameter, and the best value.

    Parameters
    ----------
    word : str
        As :func:`word` has it; coefficients may have names, as "K(b) D(1/2) K(1-2*b) D(1/2) K(b)".
    parameter : mapping of str to (lo, hi, spacing) or Exact, or str
        Their values, as ``{"b": ("0.15", "0.25", "1/100")}`` or "b=0.15..0.25:1/100"; one name or two have a range,
        others a value: ``{"a": (0, 1, "1/10"), "c": "1/3"}`` or "a=0..1:1/10,c=1/3".
    maximize, minimize : str, optional
        "edge" or "efficiency" is to be greatest; or "error" or "bias" least.
    up_to : Exact, optional
        The omega h up to which the bias counts; the evaluations of the first force unless given.
    lambda1, lambda2 : Exact, optional
        The stiffnesses of K1 (or K) and K2; both where the word names two forces, lambda2/lambda1 rational.
    budget : int, optional
        The most members times powers of the force; 20000 unless given.

    Raises
    ------
    KickdriftError, BudgetError
        A text that is no word at some value, with the place; more members than the budget allows.

    Examples
    --------
    >>> import kickdrift as kd
    >>> two = "K(b) D(1/2) K(1-2*b) D(1/2) K(b)"
    >>> found = kd.family(two, parameter="b=0.15..0.25:1/100", maximize="edge")
    >>> found.data["best"]["value"], found[-1]["edge"]
    ('1/4', {'lo': 4.0, 'hi': 4.0})
    >>> kd.family(two, parameter={"b": (0.15, 0.25, 0.01)}, maximize="edge") == found
    True
    """
    return answered(
        Family,
        "family",
        "members",
        budget,
        word=word,
        parameter=spaced_text("parameter", parameter, _PARAMETER),
        maximize=maximize,
        minimize=minimize,
        up_to=optional_text("up_to", up_to),
        lambda1=optional_text("lambda1", lambda1),
        lambda2=optional_text("lambda2", lambda2),
    )


_PARAMETER = "give values by name, as {'b': (0.15, 0.25, 0.01)}, or a text as 'b=0.15..0.25:1/100'"


def methods() -> Methods:
    """List published integrators: order on oscillators, cost, stable steps, efficiency, source.

    Examples
    --------
    >>> import kickdrift as kd
    >>> "pefrl" in [row["name"] for row in kd.methods()]
    True
    """
    return answered(Methods, "methods", "methods", None)
