"""The verdict on a system, as its document tells it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from kickdrift import _plot
from kickdrift._document import Asked, Document
from kickdrift._enclosure import Enclosure
from kickdrift._native import Number
from kickdrift._numbers import frozen

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True, eq=False, repr=False)
class DecidedSystem(Document):
    """What the document of a verdict on a system says."""

    _asked: Asked

    @property
    def stable(self) -> bool:
        """Whether all powers of the propagator are proven to stay bounded."""
        return bool(self.data["stable"])

    @property
    def kind(self) -> str:
        """elliptic, hyperbolic, parabolic or coexistence; ``not decided`` where nothing is proven."""
        return str(self.data["kind"])

    @property
    def proven(self) -> bool:
        """Whether it is proven for the Hessians given; False where nothing is decided, a warning says why. Warnings
        say, too, where these are not the Hessians that a run meets."""
        return bool(self.data["proven"])

    @property
    def growth_rate(self) -> float:
        """The middle of :attr:`growth_bounds`, NaN where there are none."""
        bounds = self.growth_bounds
        return float("nan") if bounds is None else sum(bounds) / 2

    @property
    def growth_bounds(self) -> Enclosure | None:
        """Doubles that enclose the largest growth rate per unit time: zeros where nothing grows exponentially, None
        where no bound is proven."""
        found = self.data["growth_rate"]
        return None if found is None else Enclosure(found["lo"], float("inf") if found["hi"] is None else found["hi"])

    @property
    def period(self) -> Number:
        """The synchronization period, exactly."""
        return Number(self.data["period"])

    @property
    def _is_respa(self) -> bool:
        return self._asked.fields.get("method", "respa") == "respa"

    def _beside(self, name: str) -> Mapping[str, Any] | None:
        found = self.data.get(name)
        return None if found is None else MappingProxyType(found)

    @property
    def measured(self) -> Mapping[str, Any] | None:
        """For measured Hessians: ``accuracy``, ``holds`` within it, ``margin``, ``first_unstable`` outer step."""
        return self._beside("measured")

    @property
    def friction(self) -> Mapping[str, Any] | None:
        """What the friction asked for does: ``rate``, ``damping``, ``growth_rate`` with it, and ``masking``: at
        ``lo`` something grows still, at ``hi`` nothing does, ``ranges`` of rates are proven to mask all growth, and
        ``stays`` says whether every larger rate is."""
        return self._beside("friction")

    @property
    def no_gradient(self) -> Mapping[str, Any] | None:
        """For forces that are no gradient: ``asymmetries``, growth ``without_steps``, ``added_by_steps`` and
        ``within_accuracy``, and the ``masking_friction``."""
        return self._beside("no_gradient")

    @property
    def nearest_unstable(self) -> Mapping[str, Any] | None:
        """What :meth:`System.nearest` asks for: the unstable interval that holds the outer step, ``own``, the next one
        ``below`` and ``above``, None where there is none in the ``searched`` range, and its ``untold`` parts."""
        return self._beside("nearest_unstable")

    @property
    def bias(self) -> tuple[Mapping[str, float], ...] | None:
        """By how much the potential energy of each normal mode is off, the fastest first: its ``turn`` over the period,
        its ``period`` and R, ``at_kicks`` (constant energy) and ``in_drifts`` (a weak thermostat there); 1 is right.
        Rounded. None unless elliptic, and where it is not computed: the text says why.

        Examples
        --------
        >>> import kickdrift as kd
        >>> system = kd.System.from_hessians([1.0], {"stiff": ("1/40", [[400.0]]), "soft": ("1/10", [[1.0]])})
        >>> round(system.decide().bias[0]["at_kicks"], 4)
        1.072
        """
        found = self.data["bias"]
        return None if found is None else tuple(MappingProxyType(mode) for mode in found)

    @property
    def local_steps(self) -> Mapping[str, Any] | None:
        """For a scheme of local time steps: its ``levels``, and the ``plain_limit`` of leapfrog without them.

        A sparse one also has its ``first_unstable`` step, under ``lts`` if it has a single level.
        """
        return self._beside("local_steps")

    @cached_property
    def multipliers(self) -> npt.NDArray[np.complex128]:
        """The multipliers of one period as far as the document has them, rounded, shape (2k,): k of them, then their
        inverses."""
        every = [found["lambda"] for part in self.data["parts"] for found in part["multipliers"] or ()]
        values = np.array([complex(value["re"], value["im"]) for value in every], dtype=np.complex128)
        return frozen(np.concatenate([values, 1 / values]))

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the multipliers in the complex plane, those off the unit circle in another colour.

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Where to draw; a new figure unless given.

        Examples
        --------
        >>> import kickdrift as kd
        >>> system = kd.System.from_hessians([1.0], {"stiff": ("1/40", [[400.0]]), "soft": ("1/10", [[1.0]])})
        >>> system.decide().plot().get_aspect()
        1.0
        """
        return _plot.multipliers(self.multipliers, ax)

    def to_svg(self) -> str:
        """The program's figure: multipliers, and shapes of growing modes.

        Examples
        --------
        >>> import kickdrift as kd
        >>> system = kd.System.from_hessians([1.0], {"stiff": ("1/40", [[400.0]]), "soft": ("1/10", [[1.0]])})
        >>> system.decide().to_svg().startswith("<svg")
        True
        """
        return self._asked.svg()

    def _repr_svg_(self) -> str:
        return self.to_svg()

    def __bool__(self) -> bool:
        return self.stable
