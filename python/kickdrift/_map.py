"""Maps: the verdicts of whole grids of steps."""

from __future__ import annotations

import html
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

from kickdrift import _native, _plot
from kickdrift._document import Document, Frozen
from kickdrift._errors import KickdriftError, required
from kickdrift._numbers import Exact, Range, flag, frozen, range_text, text
from kickdrift._verdict import _STABLE, TIERS, VERDICTS

if TYPE_CHECKING:
    import pandas
    import xarray
    from matplotlib.axes import Axes

_FEW = 4_000_000


@dataclass(frozen=True, eq=False, repr=False)
class Map(Frozen):
    """The verdicts of a grid as arrays (columns of h1, rows of h2), every one proven.

    Examples
    --------
    Figure 1 of the paper, coarsely:

    >>> import kickdrift as kd
    >>> figure1 = kd.map(lambda1="pi^2", lambda2="pi^2/25", step="1/25", h1=("1/25", "2/pi"), h2=("1/25", "7/2"))
    >>> figure1
    Map(15 x 87 pairs: 110 unstable)
    >>> figure1.verdict.dtype, figure1.verdict.shape, figure1.names[figure1.verdict[0, 48]]
    (dtype('uint8'), (15, 87), 'hyperbolic+')
    """

    _question: tuple[Any, ...]
    _texts: tuple[str, str]
    arrays: Mapping[str, npt.NDArray[Any]]
    """All arrays by name, as in the program's ``map.npz``, read only."""

    _map: _native.Map | None = None
    """What writes and draws them at once; left out where the map is pickled."""

    names = VERDICTS
    tier_names = TIERS

    @property
    def h1(self) -> npt.NDArray[np.float64]:
        """The steps of the columns, rounded, shape (columns,)."""
        return self.arrays["h1"]

    @property
    def h2(self) -> npt.NDArray[np.float64]:
        """The steps of the rows, rounded, shape (rows,)."""
        return self.arrays["h2"]

    @property
    def verdict(self) -> npt.NDArray[np.uint8]:
        """Positions in ``Map.names``, shape (len(h1), len(h2))."""
        return self.arrays["verdict"]

    @property
    def tier(self) -> npt.NDArray[np.uint8]:
        """The deciding tiers, positions in ``Map.tier_names``, shape (len(h1), len(h2))."""
        return self.arrays["tier"]

    @property
    def stable(self) -> npt.NDArray[np.bool_]:
        """Whether each pair is stable, shape (len(h1), len(h2))."""
        return frozen(_STABLE[self.verdict])

    @property
    def growth_rate(self) -> npt.NDArray[np.float64]:
        """Growth rates per unit time, shape (len(h1), len(h2)), NaN where nothing grows exponentially; asked for by
        ``growth=True``."""
        return self._asked("growth_rate", "growth")

    @property
    def m(self) -> npt.NDArray[np.int64]:
        """Labels, shape (len(h1), len(h2)), -1 where nothing grows exponentially; asked for by ``label=True``."""
        return self._asked("m", "label")

    def __getstate__(self) -> dict[str, Any]:
        return super().__getstate__() | {"_map": None}

    def _writer(self) -> _native.Map:
        return _native.map(*self._question)[0] if self._map is None else self._map

    def _asked(self, name: str, product: str) -> npt.NDArray[Any]:
        if name not in self.arrays:
            raise KickdriftError(name, "not computed", f"ask for it: map(..., {product}=True)")
        return self.arrays[name]

    @cached_property
    def document(self) -> Document:
        """The document ``kickdrift/map/1``: the counts."""
        return Document(self._texts[0])

    def to_json(self) -> str:
        """The document of ``kickdrift map``, byte for byte: the counts.

        Examples
        --------
        >>> import kickdrift as kd
        >>> small = kd.map(lambda1="pi^2", lambda2=1, step="1/10", h1=("1/10", "1/2"), h2=("1/10", 1))
        >>> small.to_json() == small.document.to_json()
        True
        """
        return self.document.to_json()

    def to_csv(self) -> str:
        """A row for each pair that is unstable or on an edge; a map from another process is computed again.

        Examples
        --------
        >>> import kickdrift as kd
        >>> small = kd.map(lambda1="pi^2", lambda2=1, step="1/10", h1=("1/10", "1/2"), h2=("1/10", 1))
        >>> len(small.to_csv().splitlines()) == 1 + int((~small.stable).sum())
        True
        """
        return self._writer().csv(self.verdict, self.tier)

    def to_xarray(self) -> xarray.Dataset:
        """The arrays over the coordinates h1 and h2, none of them copied.

        Raises
        ------
        KickdriftError
            Where xarray is not installed.

        Examples
        --------
        >>> import kickdrift as kd
        >>> data = kd.map(lambda1="pi^2", lambda2=1, step="1/10", h1=("1/10", "1/2"), h2=("1/10", 1)).to_xarray()
        >>> dict(data.sizes)
        {'h1': 5, 'h2': 10}
        """
        planes = {name: (("h1", "h2"), values) for name, values in self.arrays.items() if values.ndim == 2}
        attributes = {"verdict_names": list(VERDICTS), "tier_names": list(TIERS), **self.document.data["input"]}
        made: xarray.Dataset = required("xarray").Dataset(
            planes, coords={"h1": self.h1, "h2": self.h2}, attrs=attributes
        )
        return made

    def to_pandas(self) -> pandas.DataFrame:
        """One row a pair, by h1, then h2; the kind by name.

        Examples
        --------
        >>> import kickdrift as kd
        >>> small = kd.map(lambda1="pi^2", lambda2=1, step="1/10", h1=("1/10", "1/2"), h2=("1/10", 1))
        >>> len(small.to_pandas())
        50
        """
        pd = required("pandas")
        h1, h2 = (axis.ravel() for axis in np.meshgrid(self.h1, self.h2, indexing="ij"))
        kinds = pd.Categorical.from_codes(self.verdict.ravel().astype(np.int8), categories=pd.Index(VERDICTS))
        more = {name: values.ravel() for name, values in self.arrays.items() if name in _MORE}
        made: pandas.DataFrame = pd.DataFrame(
            {"h1": h1, "h2": h2, "verdict": kinds, "stable": self.stable.ravel(), **more}
        )
        return made

    def plot(self, ax: Axes | None = None, colour: Literal["verdict", "growth"] = "verdict") -> Axes:
        """Draw the map in the program's colours: the kinds of unstable pairs, or their growth rates.

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Where to draw; a new figure unless given.
        colour : "verdict" or "growth"
            Growth needs a map that was asked for with ``growth=True``.

        Raises
        ------
        KickdriftError
            Growth that was not computed.

        Examples
        --------
        >>> import kickdrift as kd
        >>> small = kd.map(lambda1="pi^2", lambda2=1, step="1/10", h1=("1/10", "1/2"), h2=("1/10", 1))
        >>> small.plot().get_xlabel()
        '$h_1$'
        """
        if colour == "growth":
            return _plot.growth(self.h1, self.h2, self.growth_rate, ax)
        return _plot.verdicts(self.h1, self.h2, self.verdict, VERDICTS, ax)

    def to_svg(self, colour: Literal["verdict", "bias"] = "verdict") -> str:
        """The program's figure as SVG.

        Parameters
        ----------
        colour : "verdict" or "bias"
            The kinds of unstable pairs; or how far the potential energy of stable ones is off where the clocks kick,
            the larger of R and 1/R, in doubles.

        Raises
        ------
        KickdriftError
            Another colour.

        Examples
        --------
        >>> import kickdrift as kd
        >>> small = kd.map(lambda1="pi^2", lambda2=1, step="1/10", h1=("1/10", "1/2"), h2=("1/10", 1))
        >>> small.to_svg().startswith("<svg"), small.to_svg("bias") != small.to_svg()
        (True, True)
        """
        if colour not in ("verdict", "bias"):
            raise KickdriftError("colour", colour, "is verdict or bias")
        return self._writer().svg(self.verdict, self.tier, colour == "bias")

    def _repr_svg_(self) -> str | None:
        return self.to_svg() if self.verdict.size <= _FEW else None

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(self._texts[1].rstrip())}</pre>"

    def __repr__(self) -> str:
        columns, rows = self.verdict.shape
        return f"Map({columns} x {rows} pairs: {self.document.data['unstable']} unstable)"


_MORE = ("m", "a", "b", "growth_rate", "growth_rate_error")


def map(
    *,
    lambda1: Exact,
    lambda2: Exact,
    h1: Range,
    h2: Range,
    step: Exact | None = None,
    step1: Exact | None = None,
    step2: Exact | None = None,
    label: bool = False,
    growth: bool = False,
    budget: int | None = None,
    threads: int | None = None,
) -> Map:
    """Decide every pair of a grid: all positive multiples of the spacings in closed ranges of h1 and h2.

    Parameters
    ----------
    lambda1, lambda2 : Exact
        The stiffnesses, 1/time².
    h1, h2 : Range
        The closed ranges of steps, time.
    step, step1, step2 : Exact, optional
        The spacing of both steps, or one for each.
    label : bool
        Also the tongue's label m of each growing pair, and its dominant family (a, b).
    growth : bool
        Also the growth rate of each growing pair and its proven error.
    budget : int, optional
        The most kicks that one pair may compose; a map may compose 10^4 times as many.
    threads : int, optional
        One a core unless given.

    Raises
    ------
    KickdriftError
        Bad input, with its field, value and remedy.
    BudgetError
        A map that would compose more kicks than the budget allows, before the work begins.
    KeyboardInterrupt
        Within a second of Ctrl-C.

    Examples
    --------
    >>> import kickdrift as kd
    >>> found = kd.map(lambda1="pi^2", lambda2="pi^2/25", step="1/10", h1=("1/10", "2/pi"), h2=("1/10", 3), growth=True)
    >>> bool((found.growth_rate[~found.stable] > 0).any())
    True
    """
    steps = [step if spacing is None else spacing for spacing in (step1, step2)]
    for name, spacing in zip(("step", "step2"), steps, strict=True):
        if spacing is None:
            remedy = "a grid needs a spacing, as step='1/100'; verdicts(h1=xs[:, None], h2=ys) takes axes of any steps"
            raise KickdriftError(name, None, remedy)
    ends = [_ends("h1", h1), _ends("h2", h2)]
    label, growth = flag("label", label), flag("growth", growth)
    stiffnesses = [text("lambda1", lambda1), text("lambda2", lambda2)]
    spacings = [text("step1", steps[0]), text("step2", steps[1])]
    question = (stiffnesses, spacings, ends, (label, growth), budget, threads)
    made, arrays = _native.map(*question)
    kept = MappingProxyType({name: frozen(array) for name, array in arrays.items()})
    return Map(question, (made.render("json"), made.render("text")), kept, made)


def _ends(field: str, value: Range) -> list[Exact]:
    lo, dots, hi = range_text(field, value).partition("..")
    if not (dots and lo and hi):
        raise KickdriftError(field, str(value), "give a pair (lo, hi), or a text as '1/100..7/2'")
    return [lo, hi]
