"""Systems: many clocks, many degrees of freedom."""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from os import PathLike
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import numpy.typing as npt

from kickdrift import _plot
from kickdrift._advise import Engine, SystemAdvice, Time, asked
from kickdrift._document import Answer, Asked, Document, Frozen, frame, question
from kickdrift._errors import KickdriftError, shown
from kickdrift._files import text_of
from kickdrift._native import Number
from kickdrift._numbers import (
    Exact,
    Range,
    doubles,
    duration,
    frozen,
    items,
    number,
    pair_of,
    range_text,
    text,
    written,
)

if TYPE_CHECKING:
    import pandas
    from matplotlib.axes import Axes

    from kickdrift._monodromy import Followed, Monodromy

_SCHEMA = "kickdrift/system/1"
_FILE, _ARRAYS = "system.json", "arrays.npz"


@dataclass(frozen=True, eq=False, repr=False)
class System(Frozen):
    """Masses and potentials, each with a clock of its own: M x'' + sum of K_k x = 0.

    Parameters
    ----------
    document : mapping
        As in a system file, without ``schema``: ``masses``, ``potentials`` and so on; numbers are exact, a float means
        what it prints. Arrays of doubles stand by reference, ``{"npz": "arrays.npz", "array": NAME}``.
    arrays : mapping of str to array, optional
        The arrays referred to; read-only copies are kept.
    notes : sequence of str, optional
        What was left out or estimated while the system was made.

    Examples
    --------
    Two masses, a stiff bond between them and a soft tether to a wall:

    >>> import kickdrift as kd
    >>> system = kd.System({"masses": [1, 1], "potentials": [
    ...     {"step": "1/10", "springs": [[0, 1, 10]]}, {"step": "1/2", "springs": [[0, None, "1/2"]]}]})
    >>> system.decide().stable
    True
    """

    document: Mapping[str, Any]
    arrays: Mapping[str, npt.NDArray[Any]] = field(default_factory=dict)
    notes: Sequence[str] = ()
    _path: Path | None = None
    _source: str = ""
    _orbit: Followed | None = None

    def __post_init__(self) -> None:
        for name, mapping in (("document", self.document), ("arrays", self.arrays)):
            if not isinstance(mapping, Mapping):
                raise KickdriftError(name, shown(mapping), "give a mapping of names to what they mean")
        own = {name: doubles(name, array) for name, array in self.arrays.items()}
        object.__setattr__(self, "arrays", MappingProxyType(own))

    @property
    def accuracy(self) -> float | None:
        """How well measured Hessians are known, relative to their norms; ``None`` of exact stiffnesses."""
        potentials = self.document.get("potentials", ())
        if not any(isinstance(own.get("stiffness"), Mapping) for own in potentials):
            return None
        return float(number(self.document.get("accuracy", "1e-6")))

    @staticmethod
    def read(path: str | PathLike[str]) -> System:
        """Read a system file.

        Parameters
        ----------
        path : str or path
            The file; arrays that it refers to lie in its folder.

        Raises
        ------
        KickdriftError
            A file that cannot be read; what stands in it is checked when it is used.

        Examples
        --------
        >>> import kickdrift as kd
        >>> try:
        ...     kd.System.read("nowhere.json")
        ... except kd.KickdriftError as error:
        ...     print(error.field)
        nowhere.json
        """
        source = text_of(path, "name a system file")
        try:
            document = json.loads(source, parse_float=str)
        except (ValueError, RecursionError) as cause:
            raise KickdriftError(str(path), "not read", f"{cause}: name a system file") from cause
        if not isinstance(document, dict):
            raise KickdriftError(str(path), "not read", "a system file is one JSON object: name another one")
        return System(MappingProxyType(document), _path=Path(path), _source=source)

    @staticmethod
    def from_hessians(
        masses: npt.ArrayLike,
        potentials: Mapping[str, tuple[Exact, npt.ArrayLike]],
        *,
        positions: npt.ArrayLike | None = None,
        accuracy: float = 1e-6,
        title: str = "",
        time_unit: str = "",
        labels: Sequence[str] = (),
        elements: Sequence[str] = (),
        bonded: Sequence[tuple[int, int]] | None = None,
        forces: Mapping[str, npt.ArrayLike] | None = None,
        constraints: str | Sequence[tuple[int, int]] | None = None,
        notes: Sequence[str] = (),
        periodic: bool = False,
        keep_rigid: bool = False,
        symmetric: bool = True,
    ) -> System:
        """Make a system of measured Hessians.

        Parameters
        ----------
        masses : array of doubles, shape (n,) or (n/3,)
            One for each degree of freedom, or for each particle of three.
        potentials : mapping of str to (step, Hessian)
            A step (Exact, or with its unit as ``"0.5fs"``) and a symmetric matrix of doubles, shape (n, n),
            energy/length², by name; minus the derivative of a force that is no gradient. Two sparse matrices or arrays
            of SciPy are decided by sparse factorizations, in the first stable region: some 10^5 degrees of freedom.
        positions : array of doubles, shape (n/3, 3), optional
            By which rigid motions are projected out; else those that every Hessian leaves free within its accuracy are.
        accuracy : float
            How well the Hessians are known, relative to their norms; verdicts tell whether they stand within it.
        title : str, optional
            Names the system in answers.
        time_unit : str, optional
            What the steps are in, as ``"ps"``; answers name it.
        labels : sequence of str, optional
            One for each degree of freedom, or for each particle of three: of molecules the atom, its kind of residue
            and its number, as ``"H1 HOH 4"``.
        elements : sequence of str, optional
            The symbol of each particle; else its mass tells.
        bonded : sequence of (int, int), optional
            Which particles are bonded; else distances tell. By these answers name motions: ``O-H stretch of HOH``.
        forces : mapping of str to array, shape (n,) or (n/3, 3), optional
            The force of each potential at the positions, by which ``constraints`` bend its Hessian.
        constraints : "h-bonds" or a sequence of (int, int), optional
            The distances that are held; they need ``forces`` and ``positions``.
        notes : sequence of str, optional
            What was left out or estimated: the first warnings of every answer.
        periodic : bool
            The particles are in a periodic box: three translations are rigid, and no rotation.
        keep_rigid : bool
            Project no rigid motions out: there are none, as of atoms among others that stand still.
        symmetric : bool
            False: a force is no gradient, as one that is learned and predicted directly, so that asymmetry is no error.
            Rigid motions are projected out by positions alone then.

        Raises
        ------
        KickdriftError
            Masked, complex or infinite entries, a step that is no positive rational; shapes that do not fit together,
            when the system is decided.

        Examples
        --------
        >>> import numpy as np
        >>> import kickdrift as kd
        >>> stiff, soft = np.diag([400.0, 400.0]), np.array([[1.0, -1.0], [-1.0, 1.0]])
        >>> system = kd.System.from_hessians([1.0, 1.0], {"stiff": ("1/40", stiff), "soft": ("1/10", soft)})
        >>> system.decide().stable
        True
        """
        if not isinstance(potentials, Mapping):
            raise KickdriftError("potentials", shown(potentials), "give a mapping of names to (step, Hessian)")
        known = doubles("accuracy", accuracy)
        if known.ndim > 0:
            raise KickdriftError("accuracy", shown(accuracy), "give one number")
        pairs = {name: pair_of(written("potentials", name), own, _PAIR) for name, own in potentials.items()}
        steps = {name: _step(name, step, time_unit) for name, (step, _) in pairs.items()}
        arrays = {"masses": doubles("masses", masses)}
        if positions is not None:
            arrays["positions"] = doubles("positions", positions)
        document: dict[str, Any] = {"accuracy": float(known), **{name: _at(name) for name in arrays}}
        named: dict[str, Any] = {"title": title, "time_unit": time_unit, "labels": items("labels", labels, "list them")}
        named |= {"periodic": periodic, "keep_rigid": keep_rigid, "elements": items("elements", elements, "list them")}
        named["constraints"] = constraints if isinstance(constraints, str) else _pairs("constraints", constraints)
        document |= {key: value for key, value in named.items() if value}
        if not symmetric:
            document["symmetric"] = False
        if bonded is not None:
            document["bonded"] = _pairs("bonded", bonded)
        document["potentials"] = []
        for place, (name, (_, hessian)) in enumerate(pairs.items()):
            at, own = _compressed(place, name, hessian, float(known)) or _dense(place, name, hessian)
            potential = {"name": name, "step": written(name, steps[name]), "stiffness": at}
            arrays |= own
            if forces is not None:
                if name not in forces:
                    raise KickdriftError("forces", name, "give the force of each potential")
                arrays[f"force{place}"] = doubles(name, forces[name]).ravel()
                potential["force"] = _at(f"force{place}")
            document["potentials"].append(potential)
        return System(MappingProxyType(document), arrays, tuple(notes))

    @staticmethod
    def along_orbit(
        masses: npt.ArrayLike,
        potentials: Mapping[str, tuple[Exact, npt.ArrayLike]],
        *,
        positions: npt.ArrayLike | None = None,
        turned: npt.ArrayLike | None = None,
        rigid: npt.ArrayLike | None = None,
        accuracy: float = 1e-6,
        title: str = "",
        time_unit: str = "",
        labels: Sequence[str] = (),
        notes: Sequence[str] = (),
        periodic: bool = False,
        keep_rigid: bool = False,
    ) -> System:
        """Make a system of Hessians along half a period of the integrator's own orbit, each kick with its own.

        The orbit starts at rest in the middle of a kick of every clock, and turns at rest half a period later.

        Parameters
        ----------
        masses : array of doubles, shape (n,) or (n/3,)
            One for each degree of freedom, or for each particle of three.
        potentials : mapping of str to (step, Hessians)
            By increasing step; the symmetric matrices at all kicks from t = 0 to half the period, both counted, shape
            (k, n, n), energy/length².
        positions, turned : array of doubles, shape (n/3, 3), optional
            Where the particles of a free molecule are at t = 0 and half a period later: its rigid motions are set
            apart.
        rigid : array of doubles, shape (2, n, r), optional
            These motions themselves, in other coordinates than those of particles: mass-weighted columns at t = 0 and
            half a period later.
        accuracy : float
            How well each Hessian is known, relative to its norm: what is proven is so for all within it.
        title, time_unit, labels, notes, periodic, keep_rigid
            As for :meth:`from_hessians`.

        Raises
        ------
        KickdriftError
            As :meth:`from_hessians`.

        Examples
        --------
        >>> import numpy as np
        >>> import kickdrift as kd
        >>> stiff = np.array([[[400.0]], [[402.0]], [[404.0]]])
        >>> system = kd.System.along_orbit([1.0], {"stiff": ("1/40", stiff), "soft": ("1/10", [[[1.0]]])})
        >>> verdict = system.decide()
        >>> verdict.stable, verdict.measured["holds"]
        (True, 'stable')
        """
        if not isinstance(potentials, Mapping):
            raise KickdriftError("potentials", shown(potentials), "give a mapping of names to (step, Hessians)")
        arrays = {"masses": doubles("masses", masses)}
        ends = {"positions": positions, "turned": turned, "rigid": rigid}
        if not (periodic or keep_rigid):
            arrays |= {name: doubles(name, own) for name, own in ends.items() if own is not None}
        document: dict[str, Any] = {"along_orbit": True, "accuracy": float(doubles("accuracy", accuracy))}
        document |= {name: _at(name) for name in arrays}
        named: dict[str, Any] = {"title": title, "time_unit": time_unit, "labels": items("labels", labels, "list them")}
        named |= {"periodic": periodic, "keep_rigid": keep_rigid}
        document |= {key: value for key, value in named.items() if value}
        document["potentials"] = []
        pairs = {name: pair_of(written("potentials", name), own, _PAIR) for name, own in potentials.items()}
        for place, (name, (step, hessians)) in enumerate(pairs.items()):
            at, own = _dense(place, name, hessians)
            exact = written(name, _step(name, step, time_unit))
            document["potentials"].append({"name": name, "step": exact, "stiffness": at})
            arrays |= own
        return System(MappingProxyType(document), arrays, tuple(notes))

    def save(self, folder: str | PathLike[str]) -> Path:
        """Write ``system.json`` and ``arrays.npz`` to a folder, each as a whole; return the path of the former.

        Parameters
        ----------
        folder : str or path
            Made where it is missing.

        Returns
        -------
        Path
            That of ``system.json``.

        Examples
        --------
        >>> import tempfile
        >>> import kickdrift as kd
        >>> system = kd.System({"masses": [1], "potentials": [{"step": "1/10", "springs": [[0, None, 10]]}]})
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     kd.System.read(system.save(folder)).decide().stable
        True
        """
        own = Path(folder)
        own.mkdir(parents=True, exist_ok=True)
        # Beside their places until they are whole; the text last, without which nothing is read.
        ready = [(own / f".{name}.{os.getpid()}", own / name) for name in (_ARRAYS, _FILE)]
        try:
            if self.arrays:
                with ready[0][0].open("wb") as file:
                    np.savez(file, allow_pickle=False, **self.arrays)
            ready[1][0].write_text(self._text())
            for part, place in ready[not self.arrays :]:
                part.replace(place)
        finally:
            for part, _ in ready:
                part.unlink(missing_ok=True)
        return own / _FILE

    def _text(self) -> str:
        document = {"schema": _SCHEMA} | {key: value for key, value in self.document.items() if key != "schema"}
        return json.dumps(_exact(document), indent=2) + "\n"

    @contextmanager
    def _file(self) -> Iterator[str]:
        if self._path is not None:
            yield str(self._path)
            return
        with tempfile.TemporaryDirectory(prefix="kickdrift-") as folder:
            yield str(self.save(folder))

    def _fields(self) -> dict[str, str | list[str]]:
        if self._path is not None:
            return {"file": self._path.name, "system": self._source}
        return {"file": _FILE, "system": self._text()}

    def _place(self) -> str | Mapping[str, npt.NDArray[Any]]:
        return self.arrays if self._path is None else str(self._path.parent)

    def _about(self, asked: Asked) -> Asked:
        """The question about this system."""
        return replace(asked, fields=self._fields() | dict(asked.fields), place=self._place())

    def decide(
        self,
        *,
        exact: bool = False,
        accuracy: float | None = None,
        keep_rigid: bool = False,
        friction: Exact | None = None,
        method: str | None = None,
        budget: int | None = None,
    ) -> SystemVerdict:
        """Decide whether the system is stable, and find what grows.

        Parameters
        ----------
        exact : bool
            Exact arithmetic alone.
        accuracy : float, optional
            How well measured Hessians are known, in place of the system's own number.
        keep_rigid : bool
            Leave the rigid motions of measured Hessians in.
        friction : Exact, optional
            A rate G, 1/time, rational: v times exp(-G t) in the middle of every drift (BAOAB). The verdict stays that
            without friction; ``SystemVerdict.friction`` tells what friction does.
        method : str, optional
            The integrator of two dense Hessians, in place of the system's own: ``"respa"``, ``"implicit-explicit"``,
            ``"impulse"``, ``"molly-short"``, ``"molly-linear"``, ``"molly-long"``, ``"gautschi"``, ``"hairer-lubich"``.
            All but the first take the force of the shorter step in one go over the longer one.
        budget : int, optional
            The most products of machine words.

        Raises
        ------
        KickdriftError, BudgetError
            A system that makes no sense; more work than the budget allows.

        Examples
        --------
        >>> import kickdrift as kd
        >>> system = kd.System.from_hessians([1.0], {"stiff": ("1/40", [[400.0]]), "soft": ("1/10", [[1.0]])})
        >>> system.decide().stable, system.decide(method="implicit-explicit").stable
        (True, True)
        """
        damped = None if friction is None else text("friction", friction)
        asked = question(
            "system",
            budget,
            exact=exact,
            keep_rigid=keep_rigid,
            friction=damped,
            accuracy=accuracy,
            method=method,
        )
        asked = self._about(asked)
        return SystemVerdict(asked.render("json"), self, asked)

    def nearest(
        self,
        *,
        resolution: float = 1e-4,
        accuracy: float | None = None,
        method: str | None = None,
        budget: int | None = None,
    ) -> SystemVerdict:
        """The verdict, and the unstable intervals of the outer step next to the system's own, at its ratios of steps.

        Parameters
        ----------
        resolution : float
            The relative width above which no interval is missed.
        accuracy, method, budget
            As for :meth:`decide`.

        Returns
        -------
        SystemVerdict
            Its :attr:`SystemVerdict.nearest_unstable` has them, from half the step to twice the step at most.

        Raises
        ------
        KickdriftError, BudgetError
            As :meth:`decide`.

        Examples
        --------
        >>> import kickdrift as kd
        >>> system = kd.System.from_hessians([1.0], {"stiff": ("1/40", [[400.0]]), "soft": ("1/10", [[1.0]])})
        >>> found = system.nearest().nearest_unstable
        >>> found["own"], found["below"], [round(found["above"][end], 4) for end in ("lo", "hi")]
        (None, None, [0.1527, 0.1531])
        """
        asked = question("system", budget, nearest=True, width=resolution, accuracy=accuracy, method=method)
        asked = self._about(asked)
        return SystemVerdict(asked.render("json"), self, asked)

    def intervals(
        self,
        outer: Range,
        *,
        resolution: float = 1e-4,
        accuracy: float | None = None,
        method: str | None = None,
        budget: int | None = None,
    ) -> Intervals:
        """All stable and unstable intervals of the outer step, at the ratios of steps that there are.

        Of measured Hessians a stretch is proven for all within their accuracy. ``the data do not tell`` where these
        share no verdict, or nothing is proven.

        Parameters
        ----------
        outer : Range
            The closed range of outer steps, rational.
        resolution : float
            The relative width above which no interval is missed.
        accuracy : float, optional
            How well the Hessians are known.
        method : str, optional
            The integrator of two dense Hessians, as for ``decide``.
        budget : int, optional
            The most products of machine words.

        Raises
        ------
        BudgetError
            More work than the budget allows, before it begins.

        Examples
        --------
        >>> import kickdrift as kd
        >>> system = kd.System.from_hessians([1.0], {"stiff": ("1/40", [[400.0]]), "soft": ("1/10", [[1.0]])})
        >>> [row["verdict"] for row in system.intervals(("1/20", "1/10"))]
        ['stable']
        """
        over = f"outer={range_text('outer', outer)}"
        asked = question("system", budget, intervals=over, width=resolution, accuracy=accuracy, method=method)
        asked = self._about(asked)
        return Intervals(asked.render("json"), (), "stretches", asked)

    def advise(
        self,
        steps: str | Sequence[Any] = (),
        *,
        engine: Engine | None = None,
        band: Exact = "5%",
        length: Time | None = None,
        friction: Exact | None = None,
        constraints: str | None = None,
        hmr: Exact | None = None,
        levers: bool = True,
        harmonic: bool = False,
    ) -> SystemAdvice:
        """Say which steps are safe for these Hessians, with a unit of time, for how long, and why.

        Of one level, two, or more. The first unstable step, a band of periods below which all steps are stable, and the
        verdict at each scheme are proven for all Hessians within their accuracy.

        Parameters
        ----------
        steps : sequence of Time, or a sequence of such, optional
            Schemes beside the system's own steps, which are the first: from the inner to the outer step, fs.
        engine : path or text, or a sequence of such, optional
            An input of a simulation engine, whose steps are the first scheme then.
        band : Exact or percentage
            How far every period may be off, relatively.
        length : Time, optional
            The length of the run, as ``"10ns"``.
        friction : Exact, optional
            A thermostat's, as ``"1/ps"``: whether it masks what grows.
        constraints : str, optional
            ``"h-bonds"``: bonds with hydrogens held, beside what is held already; of Hessians with ``forces``.
        hmr : Exact, optional
            Hydrogens of this mass in amu, taken from their heavy atoms.
        levers : bool
            Whether to say what would let the step grow.
        harmonic : bool
            The bonds are harmonic: nothing published bounds a clock's own step, which else stays below T/6.28.

        Raises
        ------
        KickdriftError
            Bad input; exact stiffnesses, no ``time_unit``; a scheme of another number of steps than there are levels.

        Examples
        --------
        >>> import numpy as np
        >>> import kickdrift as kd
        >>> fast, slow = np.diag([0.39, 0.41]), np.array([[0.02, 0.01], [0.01, 0.02]])
        >>> system = kd.System.from_hessians([1.0, 1.0], {"fast": ("1/2", fast), "slow": (4, slow)}, time_unit="fs")
        >>> system.advise(steps=[("0.5fs", "6fs")])
        SystemAdvice(4 fs caution, 6 fs island)
        """
        scales = (band, length, friction, constraints, hmr)
        found = asked(
            self._fields(),
            steps,
            engine,
            scales,
            place=self._place(),
            levers=levers,
            harmonic=harmonic,
        )
        warnings = self.decide().warnings
        # What a run does at these steps, where that is known to be about another state; then three sentences: what is
        # safe, what limits it, what would let it grow.
        # With other masses or held bonds the orbit is another one, which nobody has followed.
        lines = found.render("text").splitlines(keepends=True)
        own = self if constraints is None and hmr is None else replace(self, _orbit=None)
        text = own._told() + "".join(lines[:3]) + _warned(own._unsaid(warnings)) + "".join(lines[3:])
        return SystemAdvice(found.render("json"), text, warnings)

    def _told(self) -> str:
        """What comes first: the integrator's own orbit, where a run is about it and not about the minimum."""
        return "" if self._orbit is None else self._orbit.sentence

    def _unsaid(self, notes: Sequence[str]) -> Sequence[str]:
        """The notes that this does not say."""
        return notes if self._orbit is None else self._orbit.unsaid(notes)

    def __repr__(self) -> str:
        potentials = self.document.get("potentials", ())
        steps = ", ".join(f"{p.get('name', k)}: step {p['step']}" for k, p in enumerate(potentials))
        return f"System({self.document.get('title') or 'untitled'}; {steps or 'built'})"


def a_system(value: Any) -> System:
    """The argument ``system`` itself, where it is one.

    Raises
    ------
    KickdriftError
        Anything else.
    """
    if not isinstance(value, System):
        raise KickdriftError("system", shown(value), "give a System, as System.read('system.json') is")
    return value


def _warned(warnings: Sequence[str]) -> str:
    """What comes before an answer's text."""
    return "".join(f"warning: {note}\n" for note in warnings)


#: What each potential is.
_PAIR = "give the step and the Hessian, as ('1/40', [[400.0]])"


def _step(name: str, value: Exact, unit: str) -> Fraction:
    """A step in the system's unit of time, where it has one."""
    return duration(f"potentials[{name}]", value, unit, molecular=False)


def _pairs(name: str, pairs: Sequence[tuple[int, int]] | None) -> list[list[int]]:
    try:
        return [[int(i), int(j)] for i, j in pairs or ()]
    except (TypeError, ValueError) as cause:
        raise KickdriftError(name, shown(pairs), "give pairs of particles, counted from 0, as [(0, 1)]") from cause


_Arrays: TypeAlias = dict[str, npt.NDArray[np.float64]]


def _dense(place: int, name: str, hessian: npt.ArrayLike) -> tuple[dict[str, str], _Arrays]:
    own = f"hessian{place}"
    return _at(own), {own: doubles(name, hessian)}


def _compressed(place: int, name: str, hessian: Any, accuracy: float) -> tuple[dict[str, str], _Arrays] | None:
    """The three arrays of compressed rows of a sparse matrix of SciPy's; None of anything else.

    It is to be symmetric to its accuracy, as a dense one: what asymmetry there is within that is split evenly.
    """
    if not hasattr(hessian, "tocsr"):
        return None
    rows = hessian.tocsr()
    if rows.shape[0] != rows.shape[1]:
        raise KickdriftError(name, f"of shape {tuple(rows.shape)}", "give a square matrix")
    sizes = doubles(name, rows.data)
    off = (rows - rows.T).tocoo()
    # Of two entries, each half of the difference.
    if np.linalg.norm(off.data) / 2 > accuracy * np.linalg.norm(sizes):
        most = int(np.abs(off.data).argmax())
        i, j = int(off.row[most]), int(off.col[most])
        own, other = (float(rows[place]) for place in ((i, j), (j, i)))
        if own == 0:
            (i, j), (own, other) = (j, i), (other, own)
        remedy = (
            f"is not symmetric: entry [{j}, {i}] is {other!r}, and they differ by {abs(own - other):.3g}; give both "
            "triangles: T + T.T - diags(T.diagonal()) of one triangle T, (K + K.T)/2 of what was to be symmetric"
        )
        raise KickdriftError(f"{name}[{i}, {j}]", repr(own), remedy)
    rows = ((rows + rows.T) / 2).tocsr()
    rows.sum_duplicates()
    stem = f"hessian{place}"
    parts = {"data": rows.data, "indices": rows.indices, "indptr": rows.indptr}
    return {"npz": _ARRAYS, "csr": stem}, {f"{stem}.{part}": doubles(name, array) for part, array in parts.items()}


def _at(name: str) -> dict[str, str]:
    return {"npz": _ARRAYS, "array": name}


def _exact(value: Any, field: str = "document") -> Any:
    """Whatever stands for an exact number as its text; JSON would round it or not know it. An error names its place."""
    if isinstance(value, Mapping):
        return {written(field, key): _exact(own, f"{field}.{key}") for key, own in value.items()}
    if isinstance(value, list | tuple):
        return [_exact(own, f"{field}[{n}]") for n, own in enumerate(value)]
    if value is None or isinstance(value, bool | str):
        return value
    return value if isinstance(value, int) else text(field, value)


@dataclass(frozen=True, eq=False, repr=False)
class Intervals(Answer):
    """Stretches of the outer step, ``lo`` to ``hi``: ``stable``, ``unstable``, or ``the data do not tell``.

    Examples
    --------
    >>> import numpy as np
    >>> import kickdrift as kd
    >>> system = kd.System.from_hessians([1.0], {"stiff": ("1/40", [[400.0]]), "soft": ("1/10", [[1.0]])})
    >>> found = system.intervals(("1/20", "1/5"))
    >>> found
    Intervals(5 stretches: outer = 1/20..1/5)
    >>> [row["verdict"] for row in found], found.plot().get_xlabel()
    (['stable', 'the data do not tell', 'unstable', 'the data do not tell', 'stable'], 'outer step')
    """

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the stretches over the outer step.

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Where to draw; a new figure unless given.

        Examples
        --------
        >>> import kickdrift as kd
        >>> system = kd.System.from_hessians([1.0], {"stiff": ("1/40", [[400.0]]), "soft": ("1/10", [[1.0]])})
        >>> system.intervals(("1/20", "1/5")).plot().get_xlabel()
        'outer step'
        """
        return _plot.intervals(self.rows, ax)

    def _given(self) -> list[str]:
        given = self.data["input"]
        title = [given["title"]] if given.get("title") else []
        return [*title, given["intervals"].replace("=", " = ")]

    def to_svg(self) -> str:
        """The program's figure: the stretches, and growth where it is unstable.

        Examples
        --------
        >>> import kickdrift as kd
        >>> system = kd.System.from_hessians([1.0], {"stiff": ("1/40", [[400.0]]), "soft": ("1/10", [[1.0]])})
        >>> system.intervals(("1/20", "1/5")).to_svg().startswith("<svg")
        True
        """
        return self._asked.svg()


@dataclass(frozen=True, eq=False, repr=False)
class SystemVerdict(Document):
    """The verdict on a system, with its parts, the modes that grow, and of measured Hessians the margin.

    Examples
    --------
    >>> import kickdrift as kd
    >>> system = kd.System({"masses": [1], "potentials": [{"step": "1/10", "springs": [[0, None, "pi^2"]]},
    ...                                                  {"step": "0.98", "springs": [[0, None, "pi^2/25"]]}]})
    >>> verdict = system.decide()
    >>> verdict.stable, verdict.kind, verdict.proven
    (False, 'hyperbolic', True)
    """

    system: System
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
    def growth_bounds(self) -> tuple[float, float] | None:
        """Doubles that enclose the largest growth rate per unit time: zeros where nothing grows exponentially, None
        where no bound is proven."""
        found = self.data["growth_rate"]
        return None if found is None else (found["lo"], float("inf") if found["hi"] is None else found["hi"])

    @property
    def period(self) -> Number:
        """The synchronization period, exactly."""
        return Number(self.data["period"])

    @property
    def warnings(self) -> tuple[str, ...]:
        """What limits the verdict, in words; what was left out when the system was made comes first."""
        return (*self.system.notes, *self.data["warnings"])

    @property
    def orbit(self) -> Monodromy | None:
        """What small deviations do about the integrator's own orbit, where the groups' forces do not vanish at the
        minimum: that is what a run shows. None where they vanish, where the orbit is not found, or would not be soon.
        It is looked for when it is first asked for."""
        own = self.system._orbit
        return own.found if own is not None and self._is_respa else None

    @property
    def _is_respa(self) -> bool:
        return self._asked.fields.get("method", "respa") == "respa"

    def _beside(self, name: str) -> Mapping[str, Any] | None:
        found = self.data.get(name)
        return None if found is None else MappingProxyType(found)

    @property
    def measured(self) -> Mapping[str, Any] | None:
        """Of measured Hessians: ``accuracy``, ``holds`` within it, ``margin``, ``first_unstable`` outer step."""
        return self._beside("measured")

    @property
    def friction(self) -> Mapping[str, Any] | None:
        """What the friction asked for does: ``rate``, ``damping``, ``growth_rate`` with it, and ``masking``: at
        ``lo`` something grows still, at ``hi`` nothing does, ``ranges`` of rates are proven to mask all growth, and
        ``stays`` says whether every larger rate is."""
        return self._beside("friction")

    @property
    def no_gradient(self) -> Mapping[str, Any] | None:
        """Of forces that are no gradient: ``asymmetries``, growth ``without_steps``, ``added_by_steps`` and
        ``within_accuracy``, and the ``masking_friction``."""
        return self._beside("no_gradient")

    @property
    def nearest_unstable(self) -> Mapping[str, Any] | None:
        """What :meth:`System.nearest` asks for: the unstable interval that holds the outer step, ``own``, the next one
        ``below`` and ``above``, None where there is none in what was ``searched``; what is ``untold`` there."""
        return self._beside("nearest_unstable")

    @property
    def local_steps(self) -> Mapping[str, Any] | None:
        """Of a scheme of local time steps: its ``levels``, and the ``plain_limit`` of leapfrog without them.

        Of a sparse one also its ``first_unstable`` step, under ``lts`` where it has a single level.
        """
        return self._beside("local_steps")

    @cached_property
    def multipliers(self) -> npt.NDArray[np.complex128]:
        """The multipliers of one period as far as the document has them, rounded, shape (2k,): k of them, then their
        inverses."""
        every = [own["lambda"] for part in self.data["parts"] for own in part["multipliers"] or ()]
        values = np.array([complex(own["re"], own["im"]) for own in every], dtype=np.complex128)
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

    def __repr__(self) -> str:
        if not self.proven:
            return f"SystemVerdict({self.kind})"
        rate = "" if self.growth_bounds is None else f", growth rate {self.growth_rate:.6g}"
        words = "stable" if self.stable else f"unstable{rate}"
        told = f"; warnings: {len(self.warnings)}" if self.warnings else ""
        return f"SystemVerdict({words}, {self.kind}{told})"

    def __str__(self) -> str:
        told, notes = "", self.system.notes
        if self._is_respa:
            told, notes = self.system._told(), self.system._unsaid(notes)
        return told + _warned(notes) + self._asked.render("text").rstrip()


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
