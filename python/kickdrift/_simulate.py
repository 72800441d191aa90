"""Simulations: a system run by Algorithm 1."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kickdrift import _plot
from kickdrift._document import Document, frame, question
from kickdrift._numbers import Exact, items, text
from kickdrift._system import System, a_system

if TYPE_CHECKING:
    import pandas
    from matplotlib.axes import Axes


@dataclass(frozen=True, eq=False, repr=False)
class Run(Document):
    """A simulation by Algorithm 1: energy, momentum and amplitude, and measured growth beside the predicted one.

    Examples
    --------
    >>> import kickdrift as kd
    >>> system = kd.System({"masses": [1], "potentials": [{"step": "1/10", "springs": [[0, None, 10]]}]})
    >>> run = kd.simulate(system, periods=10)
    >>> run, len(run.to_pandas()), run.plot().get_xlabel()
    (Run(10 periods), 11, 'time')
    """

    def to_pandas(self) -> pandas.DataFrame:
        """One row a period: time, energy, momentum, amplitude.

        Examples
        --------
        >>> import kickdrift as kd
        >>> system = kd.System({"masses": [1], "potentials": [{"step": "1/10", "springs": [[0, None, 10]]}]})
        >>> kd.simulate(system, periods=10).to_pandas().columns.tolist()
        ['time', 'energy', 'momentum', 'amplitude']
        """
        return frame(self.data["series"])

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the amplitude over time, beside the growth predicted where there is some.

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Where to draw; a new figure unless given.

        Examples
        --------
        >>> import kickdrift as kd
        >>> system = kd.System({"masses": [1], "potentials": [{"step": "1/10", "springs": [[0, None, 10]]}]})
        >>> kd.simulate(system, periods=10).plot().get_xlabel()
        'time'
        """
        return _plot.run(self.data, ax)

    def __repr__(self) -> str:
        return f"Run({self.data['input']['periods']} periods)"


def simulate(
    system: System,
    *,
    periods: int = 200,
    displace: Exact | Sequence[Exact] = "1/10",
    staggered: bool = False,
    budget: int | None = None,
) -> Run:
    """Run Algorithm 1 on a system and measure growth beside the prediction.

    Parameters
    ----------
    system : System
        Its bonds may be nonlinear: the prediction is that about the equilibrium.
    periods : int
        Synchronization periods to run.
    displace : Exact, or one for each degree of freedom
        The starting displacement, length; one number moves the first degree of freedom alone.
    staggered : bool
        Algorithm 1 as it stands: whole kicks at the start of a period. Otherwise they are halved.
    budget : int, optional
        The most work.

    Raises
    ------
    KickdriftError, BudgetError
        Bad input; more work than the budget allows.

    Examples
    --------
    >>> import kickdrift as kd
    >>> chain = kd.System({"build": {"kind": "chain", "masses": 4, "stiffness": [10, 1], "steps": ["1/20", "1/4"]}})
    >>> kd.simulate(chain, periods=5, displace="1/100").data["schema"]
    'kickdrift/simulate/1'
    """
    system = a_system(system)
    if isinstance(displace, list | tuple | np.ndarray):
        parts = enumerate(items("displace", displace, "list numbers"))
        moved = ",".join(text(f"displace[{n}]", part) for n, part in parts)
    else:
        moved = text("displace", displace)
    form = "staggered" if staggered else "symmetric"
    asked = question("simulate", budget, periods=periods, displace=moved, form=form)
    return Run(system._about(asked).render("json"))
