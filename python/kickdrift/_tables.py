"""Results that are rows: tongues, closings, curves, the Proposition, comparisons."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Literal

from kickdrift import _plot
from kickdrift._document import Answer, Table, answered, ask, frame, given
from kickdrift._numbers import Exact, Labels, Range, labels_text, names_text, range_text, text

if TYPE_CHECKING:
    import pandas
    from matplotlib.axes import Axes


def _text(field: str, value: Exact | None) -> str | None:
    return None if value is None else text(field, value)


def _range(field: str, value: Range | None) -> str | None:
    return None if value is None else range_text(field, value)


class Tongues(Table):
    """Unstable intervals in s = h1² lambda1, each with its label m, family (a, b), two certified edges and width.

    Examples
    --------
    >>> import kickdrift as kd
    >>> found = kd.tongues("7/3", rho="1/25", m="3..5")
    >>> [row["m"] for row in found]
    [3, 4, 5]
    """

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
        skipped = ("--digits", "--columns")
        return ask([part for part in self._arguments if not part.startswith(skipped)], "svg")

    def _repr_svg_(self) -> str | None:
        asked = self.data["input"]
        return self.to_svg() if {"lambda1", "h1_range", "h2_range"} <= asked.keys() else None


def tongues(
    ratio: Exact | None = None,
    *,
    max_sum: int | None = None,
    rho: Exact | None = None,
    lambda1: Exact | None = None,
    lambda2: Exact | None = None,
    h1: Range | None = None,
    h2: Range | None = None,
    m: Labels | None = None,
    a: str | None = None,
    b: str | None = None,
    digits: int | None = None,
    columns: Iterable[Literal["edges", "exact", "growth", "predicted", "first-order"]] | None = None,
) -> Tongues:
    """Find every unstable interval of one ratio of steps, or of all, with certified edges.

    Parameters
    ----------
    ratio : Exact, optional
        h2/h1 = p/q; or instead
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
    a, b : str, optional
        Only dominant families in these ranges, as ``"0..2"``.
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
    """
    arguments = ["tongues"] + given(
        ratio=_text("ratio", ratio),
        max_sum=max_sum,
        rho=_text("rho", rho),
        lambda1=_text("lambda1", lambda1),
        lambda2=_text("lambda2", lambda2),
        h1_range=_range("h1", h1),
        h2_range=_range("h2", h2),
        m=None if m is None else labels_text(m),
        a=a,
        b=b,
        digits=digits,
        columns=None if columns is None else names_text("columns", columns, "name them, as ['edges']"),
    )
    return Tongues(ask(arguments), tuple(arguments), "tongues")


class Closings(Answer):
    """Where tongues close: pairs (s, rho) at which a resonance does not destabilize.

    Examples
    --------
    >>> import kickdrift as kd
    >>> closed = kd.closings("5/3")[0]
    >>> closed["m"], closed["s"]["exact"], closed["rho"]["exact"]
    (4, '11/4', '114/55')
    """

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
        ratio=_text("ratio", ratio),
        max_sum=max_sum,
        m=None if m is None else labels_text(m),
        rho_range=_range("rho", rho),
        samples=samples,
        digits=digits,
    )


class Curves(Answer):
    """The resonance curves 1/T½ = a/h1 + b/h2, sampled.

    Examples
    --------
    >>> import kickdrift as kd
    >>> [(curve["a"], curve["b"]) for curve in kd.curves(a="0..1", b="0..1", samples=50)]
    [(0, 1)]
    """

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
        return _plot.curves(self.rows, ax)


def curves(
    *,
    lambda1: Exact = "pi^2",
    h1: Range = ("1/1000", "2/pi"),
    h2: Range = ("1/1000", "7/2"),
    a: str = "0..3",
    b: str = "-12..12",
    samples: int = 400,
) -> Curves:
    """Sample the (a, b) families of resonance curves.

    Parameters
    ----------
    lambda1 : Exact
        The fast stiffness, 1/time².
    h1, h2 : Range
        The closed ranges of steps.
    a, b : str
        Ranges of integers, as ``"-2..3"``.
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
        a=a,
        b=b,
        samples=samples,
    )


class Proposition(Answer):
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


class Comparison(Answer):
    """The trace verdict against the tan criterion and against resonance; its rows are the disagreements.

    Examples
    --------
    >>> import kickdrift as kd
    >>> kd.compare(max_sum=6, rho="1/25", samples=9).data["pairs"]
    99
    """

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the disagreements: a grid's in the (h1, h2) plane, those of ratios in (s, h2/h1).

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Where to draw; a new figure unless given.

        Examples
        --------
        >>> import kickdrift as kd
        >>> kd.compare(max_sum=9, rho="1/25", samples=19).plot().get_ylabel()
        '$h_2/h_1$'
        """
        return _plot.comparison(self.rows, ax)


def compare(
    *,
    lambda1: Exact | None = None,
    lambda2: Exact | None = None,
    step: Exact | None = None,
    h1: Range | None = None,
    h2: Range | None = None,
    max_sum: int | None = None,
    rho: Exact | None = None,
    samples: int | None = None,
    tolerance: Exact | None = None,
    methods: str | Sequence[str] | None = None,
    h: Range | None = None,
    h_step: Exact | None = None,
    rho_range: Range | None = None,
    rho_step: Exact | None = None,
    budget: int | None = None,
) -> Comparison:
    """Compare the trace with its predictions, over a grid or over ratios; or integrators side by side.

    Parameters
    ----------
    lambda1, lambda2, step, h1, h2
        A grid as for :func:`map`; or instead
    max_sum, rho, samples
        All coprime p + q up to ``max_sum`` at lambda2/lambda1 = ``rho``, at ``samples`` values of s in (0, 4).
    tolerance : Exact, optional
        How near q h2 must be to a multiple of T½ to count as resonant, in units of T½; 1/20 unless given.
    methods : str or sequence of str, optional
        Integrators side by side instead: names of :func:`methods`, or words. Over the grid of ``step``, ``h1``,
        ``h2``, each force in units of its own step (``lambda2`` is ``lambda1`` unless given); or over
    h, h_step, rho_range, rho_step
        Steps and lambda2/lambda1, each a closed range with a spacing.
    budget : int, optional
        The most kicks that one verdict may compose.

    Raises
    ------
    KickdriftError, BudgetError
        Bad input; more work than the budget allows.

    Examples
    --------
    >>> import kickdrift as kd
    >>> found = kd.compare(lambda1="pi^2", lambda2="pi^2/25", step="1/10", h1=("1/10", "2/pi"), h2=("1/10", 3))
    >>> found.data["pairs"]
    180
    >>> names = ["respa-4", "implicit-explicit"]
    >>> sides = kd.compare(methods=names, h=(0, 16), h_step=1, rho_range=(0, "1/2"), rho_step="1/8", lambda1="pi^2/25")
    >>> [(row["method"], row["unstable"]) for row in sides]
    [('respa-4', 33), ('implicit-explicit', 40)]
    """
    spacing = _text("step", step)
    if methods is not None:
        by_step = h1 is not None or h2 is not None
        return answered(
            Comparison,
            "compare-methods",
            "methods",
            budget,
            methods=names_text("methods", methods, "give names of methods(), or words"),
            lambda1="1" if lambda1 is None else _text("lambda1", lambda1),
            lambda2=_text("lambda2", lambda2),
            h_range=_range("h1", h1) if by_step else _range("h", h),
            h_step=spacing if by_step else _text("h_step", h_step),
            rho_range=_range("rho_range", rho_range),
            rho_step=_text("rho_step", rho_step),
            h2_range=_range("h2", h2),
            h2_step=spacing if by_step else None,
        )
    return answered(
        Comparison,
        "compare",
        "offenders",
        budget,
        lambda1=_text("lambda1", lambda1),
        lambda2=_text("lambda2", lambda2),
        step1=spacing,
        step2=spacing,
        h1_range=_range("h1", h1),
        h2_range=_range("h2", h2),
        max_sum=max_sum,
        rho=_text("rho", rho),
        samples=99 if samples is None and max_sum is not None else samples,
        tolerance=_text("tolerance", tolerance),
    )


class Half(Answer):
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
    return answered(
        Half, "half", "entries", budget, ratio=_text("ratio", ratio), s=_text("s", s), rho=_text("rho", rho)
    )


class Bands(Answer):
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
        lambda1=_text("lambda1", lambda1),
        lambda2=_text("lambda2", lambda2),
        h1_range=_range("h1", h1),
        h2_range=_range("h2", h2),
        area=_text("area", area),
        sectors=sectors,
    )


class Word(Answer):
    """An integrator as its author writes it: its stable and unstable intervals, and all that is known of it.

    Examples
    --------
    >>> import kickdrift as kd
    >>> found = kd.word("K(1/6) D(1/2) K(2/3, -1/36) D(1/2) K(1/6)")
    >>> found.data["order"], found.data["edge"]["exact"]
    (4, '12')
    """


class Methods(Answer):
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
        The friction of letters O, in 1/time; without it they do nothing.
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
        lambda1=_text("lambda1", lambda1),
        lambda2=_text("lambda2", lambda2),
        h=_text("h", h),
        h_range=_range("h_range", h_range),
        friction=_text("friction", friction),
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
