"""The page of `kickdrift explore` in a notebook."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

import numpy as np

from kickdrift import _native
from kickdrift._errors import KickdriftError, required, shown
from kickdrift._numbers import Exact, Range, range_text, text, written
from kickdrift._system import System, a_system

if TYPE_CHECKING:
    from kickdrift._widget import Explorer


def explore(
    *,
    lambda1: Exact | None = None,
    lambda2: Exact | None = None,
    h1: Range | None = None,
    h2: Range | None = None,
    unit: str | None = None,
    system: System | None = None,
    height: int = 640,
) -> Explorer:
    """Show the plane of steps as a map to move in, or a system's growth: the page of the program as a widget.

    Parameters
    ----------
    lambda1, lambda2 : Exact, optional
        The stiffnesses, 1/time².
    h1, h2 : Range, optional
        The window to begin with, both or none; else up to where either clock alone is unstable.
    unit : str, optional
        The unit of time, as ``"fs"``, for the page's words.
    system : System, optional
        A system in place of two stiffnesses.
    height : int
        Pixels.

    Raises
    ------
    KickdriftError
        Bad input, with its field, value and remedy; where anywidget is not installed.

    Examples
    --------
    In a notebook the widget shows itself. What the page asks can be asked without one:

    >>> import kickdrift as kd
    >>> page = kd.explore(lambda1="pi^2", lambda2="pi^2/25", unit="fs")
    >>> told = page.ask("point", h1="1/100", h2="49/50")
    >>> told["kind"], told["tongue"]["m"], told["command"]
    ('hyperbolic', 1, 'kickdrift verdict --lambda1 pi^2 --lambda2 pi^2/25 --h1 1/100 --h2 49/50')
    """
    required("anywidget")
    if not isinstance(height, int) or height <= 0:
        raise KickdriftError("height", shown(height), "give a positive number of pixels")
    if unit is not None and not isinstance(unit, str):
        raise KickdriftError("unit", shown(unit), "give a text, as 'fs'")
    if system is not None:
        _alone(lambda1=lambda1, lambda2=lambda2, h1=h1, h2=h2, unit=unit)
        page = _page(system)
    else:
        if lambda1 is None or lambda2 is None:
            missing = "lambda1" if lambda1 is None else "lambda2"
            raise KickdriftError(missing, None, "give both stiffnesses, or a system")
        if (h1 is None) != (h2 is None):
            raise KickdriftError("h1" if h1 is None else "h2", None, "a window has two ranges: give both, or none")
        window = None if h1 is None or h2 is None else (range_text("h1", h1), range_text("h2", h2))
        springs = text("lambda1", lambda1), text("lambda2", lambda2)
        page = _native.Page.of_springs(*springs, window, unit and written("unit", unit))
    made: Explorer = import_module("kickdrift._widget").Explorer(page, height)
    return made


def _page(system: System) -> _native.Page:
    path = a_system(system)._path
    if path is not None:
        return _native.Page.of_system(path.read_text(), {}, str(path.parent))
    arrays = {name: np.asarray(array, dtype=np.float64) for name, array in system.arrays.items()}
    return _native.Page.of_system(system._text(), arrays, None)


def _alone(**others: object) -> None:
    """A system has stiffnesses, steps and a unit of its own."""
    for name, value in others.items():
        if value is not None:
            raise KickdriftError(name, str(value), "a system has its own: leave it out, or the system")
