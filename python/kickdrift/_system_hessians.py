"""Systems that are made from measured Hessians: at one place, or along the integrator's orbit."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from types import MappingProxyType
from typing import Any, Self, TypeAlias

import numpy as np
import numpy.typing as npt

from kickdrift._errors import KickdriftError, shown
from kickdrift._numbers import Exact, doubles, duration, items, level_of, mapping_of, written
from kickdrift._system_file import ARRAYS, SystemFile

Levels: TypeAlias = Mapping[str, tuple[Any, Any]] | Sequence[tuple[str, tuple[Any, Any]]]
"""By name a step (Exact) and a matrix, in either order."""


@dataclass(frozen=True, eq=False, repr=False)
class HessianSystem(SystemFile):
    """A system whose stiffnesses are arrays of doubles."""

    @classmethod
    def from_hessians(
        cls,
        masses: npt.ArrayLike,
        potentials: Levels,
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
    ) -> Self:
        """Make a system of measured Hessians.

        Parameters
        ----------
        masses : array of doubles, shape (n,) or (n/3,)
            One for each degree of freedom, or for each particle of three.
        potentials : mapping of str to (step, Hessian), in either order
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
            Project no rigid motions out: there are none, as for atoms among others that stand still.
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
        potentials = mapping_of("potentials", potentials, "give a mapping of names to (step, Hessian)")
        known = doubles("accuracy", accuracy)
        if known.ndim > 0:
            raise KickdriftError("accuracy", shown(accuracy), "give one number")
        pairs = {name: level_of(written("potentials", name), pair, _PAIR) for name, pair in potentials.items()}
        steps = {name: _step(name, step, time_unit) for name, (step, _) in pairs.items()}
        arrays = {"masses": doubles("masses", masses)}
        if positions is not None:
            arrays["positions"] = doubles("positions", positions)
        document: dict[str, Any] = {"accuracy": float(known), **{name: reference(name) for name in arrays}}
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
            at, stored = compressed(place, name, hessian, float(known)) or _dense(place, name, hessian)
            potential = {"name": name, "step": written(name, steps[name]), "stiffness": at}
            arrays |= stored
            if forces is not None:
                if name not in forces:
                    raise KickdriftError("forces", name, "give the force of each potential")
                arrays[f"force{place}"] = doubles(name, forces[name]).ravel()
                potential["force"] = reference(f"force{place}")
            document["potentials"].append(potential)
        return cls(MappingProxyType(document), arrays, tuple(notes))

    @classmethod
    def along_orbit(
        cls,
        masses: npt.ArrayLike,
        potentials: Levels,
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
    ) -> Self:
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
            The rigid motions themselves, if the coordinates are not particles': mass-weighted columns at t = 0 and
            half a period later.
        accuracy : float
            The error of each Hessian relative to its norm: a proof holds for all Hessians within it.
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
        potentials = mapping_of("potentials", potentials, "give a mapping of names to (step, Hessians)")
        arrays = {"masses": doubles("masses", masses)}
        ends = {"positions": positions, "turned": turned, "rigid": rigid}
        if not (periodic or keep_rigid):
            arrays |= {name: doubles(name, end) for name, end in ends.items() if end is not None}
        document: dict[str, Any] = {"along_orbit": True, "accuracy": float(doubles("accuracy", accuracy))}
        document |= {name: reference(name) for name in arrays}
        named: dict[str, Any] = {"title": title, "time_unit": time_unit, "labels": items("labels", labels, "list them")}
        named |= {"periodic": periodic, "keep_rigid": keep_rigid}
        document |= {key: value for key, value in named.items() if value}
        document["potentials"] = []
        pairs = {name: level_of(written("potentials", name), pair, _PAIR) for name, pair in potentials.items()}
        for place, (name, (step, hessians)) in enumerate(pairs.items()):
            at, stored = _dense(place, name, hessians)
            exact = written(name, _step(name, step, time_unit))
            document["potentials"].append({"name": name, "step": exact, "stiffness": at})
            arrays |= stored
        return cls(MappingProxyType(document), arrays, tuple(notes))


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
    stem = f"hessian{place}"
    return reference(stem), {stem: doubles(name, hessian)}


def compressed(place: int, name: str, hessian: Any, accuracy: float) -> tuple[dict[str, str], _Arrays] | None:
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
    # Each of two entries gives half of their difference.
    if np.linalg.norm(off.data) / 2 > accuracy * np.linalg.norm(sizes):
        most = int(np.abs(off.data).argmax())
        i, j = int(off.row[most]), int(off.col[most])
        entry, other = (float(rows[place]) for place in ((i, j), (j, i)))
        if entry == 0:
            (i, j), (entry, other) = (j, i), (other, entry)
        remedy = (
            f"is not symmetric: entry [{j}, {i}] is {other!r}, and they differ by {abs(entry - other):.3g}; give both "
            "triangles: T + T.T - diags(T.diagonal()) of one triangle T, (K + K.T)/2 of what was to be symmetric"
        )
        raise KickdriftError(f"{name}[{i}, {j}]", repr(entry), remedy)
    rows = ((rows + rows.T) / 2).tocsr()
    rows.sum_duplicates()
    stem = f"hessian{place}"
    parts = {"data": rows.data, "indices": rows.indices, "indptr": rows.indptr}
    return {"npz": ARRAYS, "csr": stem}, {f"{stem}.{part}": doubles(name, array) for part, array in parts.items()}


def reference(name: str) -> dict[str, str]:
    """An array of doubles as documents refer to it."""
    return {"npz": ARRAYS, "array": name}
