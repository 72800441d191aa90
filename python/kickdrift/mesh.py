"""Waves on meshes with local time steps: a mesh of Gmsh or meshio, lumped linear elements, steps by element.

``M x'' + K x = 0`` for a scalar wave of density ``r`` and speed ``c``: ``M`` holds the integrals of ``r``, lumped,
``K`` the integrals of ``r c^2 grad u grad v``. Elements whose own Courant limit is short take substeps (leapfrog with
local time steps, Diaz and Grote 2009), or kick with steps of their own (AVI, Lew, Marsden, Ortiz and West 2003).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import factorial, prod
from os import PathLike, fspath
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
import numpy.typing as npt

from kickdrift._errors import KickdriftError, needs, shown
from kickdrift._numbers import Exact, doubles, frozen, number, text
from kickdrift._system import System, SystemVerdict
from kickdrift._system_hessians import compressed, reference

__all__ = ["Waves", "waves"]

#: The simplices that have lumped linear elements, by meshio's names, and how many nodes they have.
_SIMPLICES = {"line": 2, "triangle": 3, "tetra": 4}


@dataclass(frozen=True, eq=False, repr=False)
class Waves:
    """A mesh as a system with local time steps.

    Attributes
    ----------
    system : System
        ``decide`` answers on it; ``decide().local_steps["first_unstable"]`` is the certified limit.
    limits : array of doubles, shape (elements,)
        The Courant limit of each element by itself, ``2/w`` of its fastest motion: plain leapfrog is stable below the
        least one.
    substeps : array of integers, shape (elements,)
        The substeps of each element in a step.
    cfl : float
        The least of ``limits * substeps``: the step that the elements' own limits suggest, which no theorem allows.
    nodes : array of integers, shape (n,)
        The node of the mesh that each degree of freedom is.
    points : array of doubles, shape (nodes, 1 to 3)
        Where the nodes of the mesh are.
    cells : array of integers, shape (elements, 2 to 4)
        The nodes of each element.
    """

    system: System
    limits: npt.NDArray[np.float64]
    substeps: npt.NDArray[np.int64]
    cfl: float
    nodes: npt.NDArray[np.int64]
    points: npt.NDArray[np.float64]
    cells: npt.NDArray[np.int64]

    def save_modes(self, path: str | PathLike[str], verdict: SystemVerdict) -> Path:
        """Write the growing modes on the mesh, for ParaView and its like; rounded.

        Each mode that a verdict names is a field of the nodes, ``mode_1`` and so on by decreasing growth, 0 where nodes
        stand still, its largest entry 1; where two modes collide also ``quadrature_1``, the same a quarter turn of the
        beat later. ``substeps`` is a field of the elements.

        Parameters
        ----------
        path : str or path
            Its end names the form, one of meshio's: ``.vtu``, ``.vtk``, ``.xdmf``.
        verdict : SystemVerdict
            That on this system, unstable: ``waves.system.decide()``.

        Returns
        -------
        Path
            That of the file.

        Raises
        ------
        KickdriftError
            No mode that grows, a verdict on another system, a form that meshio does not write.

        Examples
        --------
        >>> import tempfile
        >>> from pathlib import Path
        >>> import kickdrift.mesh
        >>> string = kickdrift.mesh.waves(([[0.0], [1.0], [1.5], [2.0]], [[0, 1], [1, 2], [2, 3]]), step=2)
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     string.save_modes(Path(folder, "modes.vtu"), string.system.decide()).name
        'modes.vtu'
        """
        meshio = _meshio()
        modes = [mode for part in verdict.data["parts"] for mode in part["instabilities"]]
        modes.sort(key=lambda mode: -abs(complex(mode["lambda"]["re"], mode["lambda"]["im"])))
        if not modes:
            raise KickdriftError("verdict", shown(verdict), "names no mode that grows: choose an unstable step")
        if any(len(mode["shape"]) != len(self.nodes) for mode in modes):
            remedy = f"is of another system: ask this one, of {len(self.nodes)} degrees of freedom"
            raise KickdriftError("verdict", shown(verdict), remedy)
        fields = {}
        for count, mode in enumerate(modes, 1):
            for name in ("mode", "quadrature") if any(mode["quadrature"]) else ("mode",):
                fields[f"{name}_{count}"] = field = np.zeros(len(self.points))
                field[self.nodes] = mode["shape" if name == "mode" else name]
        flat = np.pad(self.points, ((0, 0), (0, 3 - self.points.shape[1])))
        kind = next(name for name, count in _SIMPLICES.items() if count == self.cells.shape[1])
        mesh = meshio.Mesh(flat, [(kind, self.cells)], point_data=fields, cell_data={"substeps": [self.substeps]})
        try:
            mesh.write(fspath(path))
        except (meshio.WriteError, meshio.ReadError, KeyError) as cause:
            remedy = "has a form that meshio does not write: end it in .vtu"
            raise KickdriftError("path", fspath(path), remedy) from cause
        return Path(path)


def waves(
    mesh: Any,
    *,
    speed: npt.ArrayLike = 1.0,
    density: npt.ArrayLike = 1.0,
    scheme: str = "lts",
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
        A file that meshio reads, as Gmsh's ``.msh`` of version 2.2 or 4.1; its lines, triangles or tetrahedra,
        whichever have the highest dimension. Or points, shape (nodes, 1 to 3), and cells, shape (elements, 2 to 4),
        counted from 0.
    speed, density : float or array, shape (elements,)
        The speed of the wave, and the density of the medium; the unit of time follows from these.
    scheme : "lts" or "avi"
        Leapfrog with local time steps, where small elements make all their nodes fine; or asynchronous variational
        integrators, where they kick with a step of their own.
    substeps : int or sequence of int
        In a step of the level above, the coarsest level first: 2 or 3, or (2, 2); of AVI one number above 1.
    step : Exact, optional
        The step of the coarse elements, rational.
    courant : float
        In place of a step: its share of ``cfl``.
    fixed : "boundary", sequence of nodes, or None
        Nodes that stand still: all nodes on faces of one element alone, the given ones, or none.
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
    factors = [int(factor) for factor in (substeps if isinstance(substeps, Sequence) else [substeps])]
    if not factors or min(factors) < 1:
        raise KickdriftError("substeps", shown(substeps), "give 1 or more, or one number for each level")
    if scheme not in ("lts", "avi"):
        raise KickdriftError("scheme", shown(scheme), "give lts or avi")
    if scheme == "avi" and (len(factors) > 1 or factors[0] < 2):
        raise KickdriftError("substeps", shown(substeps), "of avi give one number above 1: two classes of elements")
    celerity, rho = (_each(name, value, len(cells)) for name, value in (("speed", speed), ("density", density)))
    volume, gradients = _gradients(points, cells)
    count = cells.shape[1]
    gram = np.einsum("eix,ejx->eij", gradients, gradients)
    stiffness = (rho * celerity**2 * volume)[:, None, None] * gram
    # One element by itself has the same lumped mass at each node.
    fastest = celerity * np.sqrt(count * np.linalg.eigvalsh(gram)[:, -1])
    limits = 2 / fastest
    # The finest level has the smallest element, with all substeps; what does not need a level's substeps is not in it.
    steps = np.ones(len(cells), dtype=np.int64)
    coarsest = prod(factors) * limits.min()
    levels, taken = [], 1
    for factor in factors:
        # A little beyond, for the rounding of equal elements.
        fine = limits * taken < coarsest * (1 - 1e-9)
        levels.append((fine, factor))
        taken *= factor
        steps[fine] = taken
    cfl = float((limits * steps).min())
    still = _fixed(fixed, cells, len(points))
    used = np.unique(cells)
    nodes = np.setdiff1d(used, still)
    if not len(nodes):
        raise KickdriftError("fixed", shown(fixed), "leave some nodes to move")
    place = np.full(len(points), -1)
    place[nodes] = np.arange(len(nodes))
    masses = np.bincount(cells.ravel(), np.repeat(rho * volume / count, count), len(points))[nodes]
    document: dict[str, Any] = {"title": title} if title else {}
    document["masses"] = reference("masses")
    arrays = {"masses": doubles("masses", masses)}
    dt = text("step", step) if step is not None else text("courant", _share(courant, cfl))
    potentials = []
    for k, (few, factor) in enumerate(
        [(steps > 1, factors[0]), (steps == 1, 1)] if scheme == "avi" else [(steps > 0, 1)]
    ):
        matrix = _assembled(place[cells[few]], stiffness[few], len(nodes))
        at, matrices = compressed(k, "stiffness", matrix, 1e-12) or ({}, {})
        arrays |= matrices
        potentials.append({"step": text("step", Fraction(dt) / factor), "stiffness": at})
    if scheme != "avi":
        document |= {"scheme": scheme, "levels": []}
        for level, (fine, factor) in enumerate(levels):
            moving = place[np.unique(cells[fine])]
            arrays[f"fine{level}"] = doubles("fine", moving[moving >= 0].astype(np.float64))
            document["levels"].append({"fine": reference(f"fine{level}"), "substeps": factor})
    document["potentials"] = potentials
    system = System(MappingProxyType(document), arrays)
    return Waves(system, frozen(limits), frozen(steps), cfl, frozen(nodes), frozen(points), frozen(cells))


def _share(courant: float, cfl: float) -> Fraction:
    """A short rational near that share of a step."""
    share = float(number(courant))
    if not share > 0:
        raise KickdriftError("courant", shown(courant), "give a positive number, as 0.5")
    return Fraction(f"{share * cfl:.6g}")


def _meshio() -> Any:
    try:
        import meshio
    except ImportError:
        raise needs("mesh", "meshio") from None
    return meshio


def _simplices(mesh: Any) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.int64]]:
    if isinstance(mesh, str | PathLike):
        meshio = _meshio()
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
    values = doubles(name, value)
    if values.ndim > 1 or (values.ndim == 1 and len(values) != count) or not np.all(values > 0):
        raise KickdriftError(name, shown(value), f"give one positive number, or {count} of them, one for each element")
    return np.broadcast_to(values, (count,))


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
    nodes = np.asarray(fixed)
    if (
        nodes.ndim != 1
        or nodes.dtype.kind not in "iu"
        or (len(nodes) and not (nodes.min() >= 0 and nodes.max() < count))
    ):
        raise KickdriftError("fixed", shown(fixed), f"give nodes, 0 to {count - 1}")
    return nodes.astype(np.int64)


def _assembled(places: npt.NDArray[np.int64], matrices: npt.NDArray[np.float64], size: int) -> Any:
    """The sparse sum of the elements' matrices, without rows and columns whose place is -1."""
    try:
        from scipy import sparse
    except ImportError:
        raise needs("mesh", "scipy") from None
    count = places.shape[1]
    rows, columns = np.repeat(places, count, axis=1).ravel(), np.tile(places, (1, count)).ravel()
    moving = (rows >= 0) & (columns >= 0)
    return sparse.coo_matrix((matrices.ravel()[moving], (rows[moving], columns[moving])), shape=(size, size)).tocsr()
