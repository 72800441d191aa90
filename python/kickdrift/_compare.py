"""Comparisons: the trace beside its predictions, and integrators side by side."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from kickdrift import _plot
from kickdrift._document import Table, answered
from kickdrift._numbers import Exact, Range, names_text, optional_range, optional_text

if TYPE_CHECKING:
    from matplotlib.axes import Axes


class Comparison(Table):
    """The trace verdict against the tan criterion and against resonance; its rows are the disagreements.

    Examples
    --------
    >>> import kickdrift as kd
    >>> kd.compare(max_sum=6, rho="1/25", samples=9).data["pairs"]
    99
    """

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the disagreements: on a grid in the (h1, h2) plane, for ratios in (s, h2/h1).

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
    by_cost: bool = False,
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
        Steps and lambda2/lambda1, each a closed range with a spacing; words of one force have steps alone.
    by_cost : bool, optional
        Steps as they are paid for: a word of n evaluations takes n times each step, and the rows begin with the least
        unstable share.
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
    >>> paid = kd.compare(methods="pefrl,velocity-verlet", by_cost=True, h=(0, 2), h_step="1/100")
    >>> [(row["method"], row["evaluations"], row["unstable"]) for row in paid]
    [('velocity-verlet', 1, 1), ('pefrl', 4, 71)]
    """
    spacing = optional_text("step", step)
    if methods is not None:
        by_step = h1 is not None or h2 is not None
        return answered(
            Comparison,
            "compare-methods",
            "methods",
            budget,
            methods=names_text("methods", methods, "give names of methods(), or words"),
            lambda1="1" if lambda1 is None else optional_text("lambda1", lambda1),
            lambda2=optional_text("lambda2", lambda2),
            h_range=optional_range("h1", h1) if by_step else optional_range("h", h),
            h_step=spacing if by_step else optional_text("h_step", h_step),
            rho_range=optional_range("rho_range", rho_range),
            rho_step=optional_text("rho_step", rho_step),
            h2_range=optional_range("h2", h2),
            h2_step=spacing if by_step else None,
            by_cost="true" if by_cost else None,
        )
    return answered(
        Comparison,
        "compare",
        "offenders",
        budget,
        lambda1=optional_text("lambda1", lambda1),
        lambda2=optional_text("lambda2", lambda2),
        step1=spacing,
        step2=spacing,
        h1_range=optional_range("h1", h1),
        h2_range=optional_range("h2", h2),
        max_sum=max_sum,
        rho=optional_text("rho", rho),
        samples=99 if samples is None and max_sum is not None else samples,
        tolerance=optional_text("tolerance", tolerance),
    )
