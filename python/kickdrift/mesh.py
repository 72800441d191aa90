"""Waves on meshes with local time steps: a mesh of Gmsh or meshio, lumped linear elements, steps by element.

``M x'' + K x = 0`` for a scalar wave of density ``r`` and speed ``c``: ``M`` holds the integrals of ``r``, lumped,
``K`` those of ``r c^2 grad u grad v``. Elements whose own Courant limit is short take substeps (leapfrog with local
time steps, Diaz and Grote 2009).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import factorial, prod
from os import PathLike, fspath
from types import MappingProxyType
from typing import Any

import numpy as np
import numpy.typing as npt

from kickdrift._errors import KickdriftError, needs, shown
from kickdrift._numbers import Exact, doubles, frozen, number, text
from kickdrift._system import System, _at, _compressed

__all__ = ["Waves", "waves"]

#: The simplices that have lumped linear elements, by meshio's names, and how many nodes they have.
_SIMPLICES = {"line": 2, "triangle": 3, "tetra": 4}


@dataclass(frozen=True, eq=False, repr=False)
class Waves:
    """A mesh as a system with local time steps.

    Attributes
    ----------
    system : System
        ``decide`` and ``intervals`` answer on it; ``decide().local_steps["first_unstable"]`` is the certified limit.
    limits : array of doubles, shape (elements,)
        The Courant limit of each element by itself, ``2/w`` of its fastest motion: plain leapfrog is stable below the
        least one.
    substeps : array of integers, shape (elements,)
        The substeps of each element in a step.
    cfl : float
        The least of ``limits * substeps``: the step that the elements' own limits suggest, which no theorem allows.
    nodes : array of integers, shape (n,)
        The node of the mesh that each degree of freedom is.
    """

    system: System
    limits: npt.NDArray[np.float64]
    substeps: npt.NDArray[np.int64]
    cfl: float
    nodes: npt.NDArray[np.int64]


def waves(
    mesh: Any,
    *,
    speed: npt.ArrayLike = 1.0,
    density: npt.ArrayLike = 1.0,
    substeps: int | Sequence[int] = 2,
    step: Exact | None = None,
    courant: float = 0.5,
    fixed: str | Sequence[int] | None = "boundary",
    title: str = "",
) -> Waves:
    """Make a system of a mesh, its small elements with substeps.

    Parameters
    ----------
    mesh : path, meshio.Mesh, or (points, cells)
        A file that meshio reads, as Gmsh's ``.msh`` of version 2.2 or 4.1; its lines, triangles or tetrahedra, those of
        the highest dimension. Or points, shape (nodes, 1 to 3), and cells, shape (elements, 2 to 4), counted from 0.
    speed, density : float or array, shape (elements,)
        Of the wave, and of what it moves through; the unit of time follows from these.
    substeps : int or sequence of int
        In a step of the level above, the coarsest level first: 2 or 3, or (2, 2).
    step : Exact, optional
        Of the coarse elements, rational.
    courant : float
        In place of a step: its share of ``cfl``.
    fixed : "boundary", sequence of nodes, or None
        Nodes that stand still: those of faces that one element alone has, these, or none.
    title : str, optional
        Names the system in answers.

    Returns
    -------
    Waves

    Raises
    ------
    KickdriftError
        A mesh without such elements, elements without a volume, numbers that are not positive.

    Examples
    --------
    A string whose first third is meshed twice as finely takes two substeps there:

    >>> import numpy as np
    >>> import kickdrift.mesh
    >>> points = np.concatenate([np.linspace(0, 1, 21)[:-1], np.linspace(1, 3, 21)])[:, None]
    >>> cells = np.stack([np.arange(40), np.arange(1, 41)], axis=1)
    >>> string = kickdrift.mesh.waves((points, cells), substeps=2, courant=0.5)
    >>> verdict = string.system.decide()
    >>> verdict.stable, bool(verdict.local_steps["first_unstable"]["lo"] < string.cfl)
    (True, True)
    """
    points, cells = _simplices(mesh)
    factors = [int(own) for own in (substeps if isinstance(substeps, Sequence) else [substeps])]
    if not factors or min(factors) < 1:
        raise KickdriftError("substeps", shown(substeps), "give 1 or more, or one number for each level")
    celerity, rho = (_each(name, own, len(cells)) for name, own in (("speed", speed), ("density", density)))
    volume, gradients = _gradients(points, cells)
    count = cells.shape[1]
    gram = np.einsum("eix,ejx->eij", gradients, gradients)
    stiffness = (rho * celerity**2 * volume)[:, None, None] * gram
    # Of one element: its lumped mass is the same at each node.
    fastest = celerity * np.sqrt(count * np.linalg.eigvalsh(gram)[:, -1])
    limits = 2 / fastest
    # The finest level has the smallest element, with all substeps; what does not need a level's substeps is not in it.
    own = np.ones(len(cells), dtype=np.int64)
    coarsest = prod(factors) * limits.min()
    levels, taken = [], 1
    for factor in factors:
        # A little beyond, for the rounding of equal elements.
        fine = limits * taken < coarsest * (1 - 1e-9)
        levels.append((fine, factor))
        taken *= factor
        own[fine] = taken
    cfl = float((limits * own).min())
    still = _fixed(fixed, cells, len(points))
    used = np.unique(cells)
    nodes = np.setdiff1d(used, still)
    if not len(nodes):
        raise KickdriftError("fixed", shown(fixed), "leave some nodes to move")
    place = np.full(len(points), -1)
    place[nodes] = np.arange(len(nodes))
    masses = np.bincount(cells.ravel(), np.repeat(rho * volume / count, count), len(points))[nodes]
    matrix = _assembled(place[cells], stiffness, len(nodes))
    at, arrays = _compressed(0, "stiffness", matrix) or ({}, {})
    arrays["masses"] = doubles("masses", masses)
    document: dict[str, Any] = {"title": title} if title else {}
    document |= {"masses": _at("masses"), "scheme": "lts", "levels": []}
    for level, (fine, factor) in enumerate(levels):
        moving = place[np.unique(cells[fine])]
        arrays[f"fine{level}"] = doubles("fine", moving[moving >= 0].astype(np.float64))
        document["levels"].append({"fine": _at(f"fine{level}"), "substeps": factor})
    dt = text("step", step) if step is not None else text("courant", _share(courant, cfl))
    document["potentials"] = [{"step": dt, "stiffness": at}]
    return Waves(System(MappingProxyType(document), arrays), frozen(limits), frozen(own), cfl, frozen(nodes))


def _share(courant: float, cfl: float) -> Fraction:
    """A short rational near that share of a step."""
    share = float(number(courant))
    if not share > 0:
        raise KickdriftError("courant", shown(courant), "give a positive number, as 0.5")
    return Fraction(f"{share * cfl:.6g}")


def _simplices(mesh: Any) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.int64]]:
    if isinstance(mesh, str | PathLike):
        try:
            import meshio
        except ImportError:
            raise needs("mesh", "meshio") from None
        try:
            mesh = meshio.read(fspath(mesh))
        except (OSError, SystemExit, ValueError, meshio.ReadError) as cause:
            raise KickdriftError("mesh", shown(mesh), "is no mesh that meshio reads: name a .msh file") from cause
    if isinstance(mesh, tuple):
        points, cells = doubles("points", mesh[0]), np.asarray(mesh[1])
    else:
        every: Mapping[str, Any] = mesh.cells_dict
        found = [name for name in _SIMPLICES if len(every.get(name, ()))]
        if not found:
            remedy = "has no lines, triangles or tetrahedra: split other elements into these"
            raise KickdriftError("mesh", ", ".join(every) or "no cell", remedy)
        points, cells = doubles("points", mesh.points), np.asarray(every[found[-1]])
    if points.ndim != 2 or cells.ndim != 2 or cells.shape[1] not in _SIMPLICES.values() or not len(cells):
        remedy = "give points of shape (nodes, 1 to 3) and cells of shape (elements, 2 to 4)"
        raise KickdriftError("mesh", f"{points.shape} and {cells.shape}", remedy)
    if cells.dtype.kind not in "iu" or cells.min() < 0 or cells.max() >= len(points):
        raise KickdriftError("cells", shown(cells), f"give nodes, 0 to {len(points) - 1}")
    return points, cells.astype(np.int64)


def _each(name: str, value: npt.ArrayLike, count: int) -> npt.NDArray[np.float64]:
    own = doubles(name, value)
    if own.ndim > 1 or (own.ndim == 1 and len(own) != count) or not np.all(own > 0):
        raise KickdriftError(name, shown(value), f"give one positive number, or {count} of them, one for each element")
    return np.broadcast_to(own, (count,))


def _gradients(
    points: npt.NDArray[np.float64], cells: npt.NDArray[np.int64]
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """The volume of each element, and the gradients of its linear functions, each 1 at one node and 0 at the others."""
    corners = points[cells]
    edges = corners[:, 1:] - corners[:, :1]
    products = np.einsum("eix,ejx->eij", edges, edges)
    squares = np.linalg.det(products)
    if not np.all(squares > 0):
        flat = int(np.flatnonzero(~(squares > 0))[0])
        raise KickdriftError("cells", f"element {flat}", "has no volume: take it out of the mesh")
    others = np.linalg.solve(products, edges)
    gradients = np.concatenate([-others.sum(axis=1, keepdims=True), others], axis=1)
    return np.sqrt(squares) / factorial(edges.shape[1]), gradients


def _fixed(fixed: Any, cells: npt.NDArray[np.int64], count: int) -> npt.NDArray[np.int64]:
    if fixed is None:
        return np.zeros(0, dtype=np.int64)
    if isinstance(fixed, str):
        if fixed != "boundary":
            raise KickdriftError("fixed", fixed, "give boundary, nodes, or None")
        faces = np.concatenate([np.delete(cells, i, axis=1) for i in range(cells.shape[1])])
        faces, times = np.unique(np.sort(faces, axis=1), axis=0, return_counts=True)
        return np.unique(faces[times == 1])
    own = np.asarray(fixed)
    if own.ndim != 1 or own.dtype.kind not in "iu" or (len(own) and not (own.min() >= 0 and own.max() < count)):
        raise KickdriftError("fixed", shown(fixed), f"give nodes, 0 to {count - 1}")
    return own.astype(np.int64)


def _assembled(places: npt.NDArray[np.int64], own: npt.NDArray[np.float64], size: int) -> Any:
    """The sparse sum of the elements' matrices, without rows and columns whose place is -1."""
    try:
        from scipy import sparse
    except ImportError:
        raise needs("mesh", "scipy") from None
    count = places.shape[1]
    rows, columns = np.repeat(places, count, axis=1).ravel(), np.tile(places, (1, count)).ravel()
    moving = (rows >= 0) & (columns >= 0)
    return sparse.coo_matrix((own.ravel()[moving], (rows[moving], columns[moving])), shape=(size, size)).tocsr()
