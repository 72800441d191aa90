"""Apertures: how hot a bond may be before the method throws it out."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from kickdrift import _plot
from kickdrift._document import Told, answered
from kickdrift._numbers import Exact, items, text, with_unit, written

if TYPE_CHECKING:
    from matplotlib.axes import Axes

#: What to give in place of what are no steps.
_STEPS = "give steps in fs, as [1.4, 2], or a text, as '1.4fs,2fs'"
_RANGE = "give a range of steps in fs, as (1.2, 2.6), or a text, as '1.2fs..2.6fs'"


class Aperture(Told):
    """How hot a bond may be at each step: a measurement of the method on one bond in doubles, no proof.

    Examples
    --------
    >>> import kickdrift as kd
    >>> found = kd.aperture("OH:morse:D=485.72kJ/mol,a=22.87/nm,15.999,1.008", steps=1.95)
    >>> found[0]["aperture"], found[0]["k"], found[0]["enough"]
    (0.5, 4, False)
    """

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the aperture over the step, with the method's resonances, the steps asked for, and the level.

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Where to draw; a new figure unless given.

        Examples
        --------
        >>> import kickdrift as kd
        >>> found = kd.aperture("OH:morse:D=485.72kJ/mol,a=22.87/nm,15.999,1.008", h_range="1.9fs..2fs", step="0.05fs")
        >>> found.plot().get_xlabel()
        'step (fs)'
        """
        return _plot.aperture(self.data, ax)


def aperture(
    bond: str,
    *,
    temperature: Exact = "298K",
    steps: str | Exact | Sequence[Exact] | None = None,
    h_range: str | Sequence[Exact] | None = None,
    step: Exact | None = None,
    method: str | None = None,
    word: str | None = None,
    substeps: int | None = None,
    slow: Exact | None = None,
    band: Exact | None = None,
    bonds: int = 10_000,
    length: Exact = "100ns",
    budget: int | None = None,
) -> Aperture:
    """Measure the least energy, in kT, at which a bond is lost at each step.

    The integrator is run in doubles on one bond from 48 phases at rising energies: a measurement, no proof.

    Parameters
    ----------
    bond : str
        NAME:SHAPE,MASS,MASS. The shape is k=X (E = k x²/2), K=X (E = K x²), morse:D=X,a=Y (E = D (1 - exp(-a x))²) or
        poly:k2=X,k3=Y,k4=Z (E = k2 x² + k3 x³ + k4 x⁴).
    temperature : Exact, optional
        A number in K, or a text with its unit.
    steps : str, Exact or sequence of Exact, optional
        Steps: numbers in fs, or texts with their units.
    h_range : str or pair of Exact, optional
        A closed range of steps.
    step : Exact, optional
        From one step of the range to the next; 0.01 fs unless given.
    method, word : str, optional
        Another integrator than velocity Verlet: a name of the catalogue, or a word.
    substeps : int, optional
        r-RESPA: so many inner steps of the bond in each step of the slow force.
    slow : Exact, optional
        A slow harmonic force about the bond's rest: the period that it would give the bond alone.
    band : Exact, optional
        A part of the period, as 0.05 or "5%": ``band_aperture`` is the least of all bonds whose periods are longer by
        up to this, as neighbours make them, and decides ``enough``.
    bonds : int, optional
        The bonds of the system that is meant.
    length : Exact, optional
        The length of the run that is meant; a number is in fs.
    budget : int, optional
        The most kicks of one bond.

    Raises
    ------
    KickdriftError, BudgetError
        Bad input; more kicks than the budget allows.

    Examples
    --------
    >>> import kickdrift as kd
    >>> kd.aperture("OH:morse:D=485.72kJ/mol,a=22.87/nm,15.999,1.008", steps=["1.95fs", 2.2]).column("aperture")
    array([0.5 , 2.25])
    """
    return answered(
        Aperture,
        "aperture",
        "steps",
        budget,
        bond=written("bond", bond),
        temperature=with_unit("temperature", temperature, "K"),
        steps=_listed(steps),
        h_range=_ends(h_range),
        step=with_unit("step", step, "fs"),
        method=method,
        word=word,
        substeps=substeps,
        slow=with_unit("slow", slow, "fs"),
        band=band if band is None or isinstance(band, str) else text("band", band),
        bonds=bonds,
        length=with_unit("length", length, "fs"),
    )


def _listed(steps: str | Exact | Sequence[Exact] | None) -> str | None:
    if isinstance(steps, list | tuple):
        return ",".join(str(with_unit("steps", step, "fs")) for step in items("steps", steps, _STEPS))
    return with_unit("steps", steps, "fs")


def _ends(h_range: str | Sequence[Exact] | None) -> str | None:
    if h_range is None or isinstance(h_range, str):
        return h_range if h_range is None else written("h_range", h_range)
    return "..".join(str(with_unit("h_range", end, "fs")) for end in items("h_range", h_range, _RANGE))
