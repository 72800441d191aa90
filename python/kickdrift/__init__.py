"""Exact, certified linear stability of multiple-time-step integrators: velocity Verlet, r-RESPA, AVI.

Numbers are exact: ``"0.3"`` is 3/10, ``"pi^2/25"`` means what it says, Fractions, Decimals and SymPy's rationals are
taken as they are. **A float means what it prints**: ``0.3`` is 3/10; :func:`exact` gives the double itself.

>>> import kickdrift as kd
>>> print(kd.decide(lambda1="pi^2", lambda2="pi^2/25", h1="1/100", h2="0.98"))
unstable: hyperbolic, Tr Q < -2; exponential growth
  h2/h1        98/1: 98 fast and 1 slow kicks in the period T = 49/50
  ...
"""

from importlib.metadata import version as _version

from kickdrift._advice import Advice, SystemAdvice
from kickdrift._advise import advise
from kickdrift._aperture import Aperture, aperture
from kickdrift._bands import Bands, bands
from kickdrift._compare import Comparison, compare
from kickdrift._document import Document, Row, Table
from kickdrift._enclosure import Bias, Enclosure
from kickdrift._entries import Half, half
from kickdrift._errors import BudgetError, KickdriftError
from kickdrift._explore import explore
from kickdrift._intervals import Intervals
from kickdrift._map import Map, map
from kickdrift._native import Number
from kickdrift._numbers import Exact, Labels, Range, exact, number, simplest
from kickdrift._program import main
from kickdrift._recheck import Recheck, recheck
from kickdrift._resonances import Curves, Proposition, curves, proposition
from kickdrift._scan import Scan
from kickdrift._simulate import Run, simulate
from kickdrift._system import System, SystemVerdict
from kickdrift._tongues import Closings, Tongues, closings, tongues
from kickdrift._verdict import Verdict, Verdicts, decide, verdicts
from kickdrift._word import Family, Methods, Word, family, methods, word

#: The version of the package, and of the program in it.
__version__ = _version("kickdrift")

__all__ = [
    "Advice",
    "Aperture",
    "Bands",
    "Bias",
    "BudgetError",
    "Closings",
    "Comparison",
    "Curves",
    "Document",
    "Enclosure",
    "Exact",
    "Family",
    "Half",
    "Intervals",
    "KickdriftError",
    "Labels",
    "Map",
    "Methods",
    "Number",
    "Proposition",
    "Range",
    "Recheck",
    "Row",
    "Run",
    "Scan",
    "System",
    "SystemAdvice",
    "SystemVerdict",
    "Table",
    "Tongues",
    "Verdict",
    "Verdicts",
    "Word",
    "__version__",
    "advise",
    "aperture",
    "bands",
    "closings",
    "compare",
    "curves",
    "decide",
    "exact",
    "explore",
    "family",
    "half",
    "main",
    "map",
    "methods",
    "number",
    "proposition",
    "recheck",
    "simplest",
    "simulate",
    "tongues",
    "verdicts",
    "word",
]
