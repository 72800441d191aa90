"""All modes of a sparse stiffness, molecule by molecule: what nothing joins has modes of its own.

A molecule too large for dense matrices is looked at through windows J_w with sum of J_w² = 1 along its bonds. For
any symmetric A, x.A x = sum of (J_w x).A (J_w x) + x.E x/2, where E_ij = A_ij times the sum of (J_w(i) - J_w(j))²
(localization, after Ismagilov, Morgan and Simon). So the largest eigenvalue is at most that of the largest window plus
half the largest row of |E|, and at least that of the largest window, whose matrix is a part of A (Cauchy).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from kickdrift._errors import KickdriftError
from kickdrift._held import Held
from kickdrift._rigid import Doubles
from kickdrift._scipy import csgraph, sparse

_Indices = npt.NDArray[np.int64]

#: Atoms whose matrices are dense ones: a second or two for each.
WHOLE = 400

#: Held distances that share atoms, up to so many, are projected out as dense matrices.
_JOINED = 300

#: Sums of some dozen products of doubles cancel to less than this part of the largest of them.
ROUNDED = 1e-12

#: Layers of bonds that a window must have at least to tell anything.
_THIN = 4

#: A mode in two windows is shown by a window that has so much of it.
_MOST = 0.5

#: Entries of the dense matrices that stand beside each other: some 100 MB.
_TOGETHER = 10**7


@dataclass(frozen=True)
class Shown:
    """The modes of the stiffest molecule of a kind, a column each, and how many molecules are of this kind."""

    atoms: _Indices
    values: Doubles
    vectors: Doubles
    count: int


@dataclass
class Modes:
    """Eigenvalues of all molecules, and the vectors of one molecule of each kind, the stiffest.

    Attributes
    ----------
    whole : list of array
        The eigenvalues of molecules of one window.
    seen : list of (values, parts)
        What windows saw, and how much of each: a mode in two windows is in parts in both, and the parts of all are as
        many as there are modes, since the sum of tr J_w² is their number.
    beyond : float
        What no eigenvalue exceeds the largest one by: 0 but for windows, and rounding.
    molecules : int
        What has any stiffness.
    windows : int
        Through which large molecules were seen.
    """

    whole: list[Doubles] = field(default_factory=list)
    seen: list[tuple[Doubles, Doubles]] = field(default_factory=list)
    shown: dict[Any, Shown] = field(default_factory=dict)
    beyond: float = 0.0
    molecules: int = 0
    windows: int = 0

    @property
    def values(self) -> Doubles:
        """The eigenvalues, those of windows where most of a mode is in one."""
        return np.concatenate([np.zeros(0), *self.whole, *(values[part >= _MOST] for values, part in self.seen)])

    @property
    def largest(self) -> float:
        every = [*self.whole, *(values for values, _ in self.seen)]
        return max((float(values.max(initial=0.0)) for values in every), default=0.0)

    def count(self, least: float, most: float) -> int:
        """How many there are from one eigenvalue to another, of modes in windows about."""
        whole = sum(int(((values >= least) & (values <= most)).sum()) for values in self.whole)
        parts = sum(float(part[(values >= least) & (values <= most)].sum()) for values, part in self.seen)
        return whole + round(parts)

    def show(self, kind: Any, modes: Shown) -> None:
        """Keep these modes if their kind has no stiffer ones, and count its molecules."""
        before = self.shown.get(kind)
        if before is None:
            self.shown[kind] = modes
            return
        stiffer = max(before, modes, key=lambda each: each.values.max(initial=0.0))
        self.shown[kind] = replace(stiffer, count=before.count + modes.count)


def projected(matrix: Any, held: Held, where: Doubles) -> Any:
    """A sparse mass-weighted matrix on what held distances leave free; None where too many of these hang together.

    Entries below :data:`ROUNDED` of the largest one are what rounding leaves of stiffness along held distances: none.
    """
    if not held.distances:
        return matrix
    count = len(held.distances)
    i, j = (np.array([distance[k] for distance in held.distances]) for k in (0, 1))
    apart = where[i] - where[j]
    places = np.stack([3 * i[:, None] + np.arange(3), 3 * j[:, None] + np.arange(3)], axis=1).reshape(count, 6)
    values = np.hstack([apart, -apart]) / held.root[places]
    rows = np.repeat(np.arange(count), 6)
    gradients = sparse.csr_matrix((values.ravel(), (rows, places.ravel())), shape=(count, where.size))
    gram = (gradients @ gradients.T).tocsr()
    parts = []
    for members in _alike(csgraph.connected_components(gram, directed=False)[1]):
        if members.shape[1] > _JOINED:
            return None
        try:
            inverse = np.linalg.inv(_dense(gram, members))
        except np.linalg.LinAlgError as cause:
            raise KickdriftError("system", f"{count} constraints", "depend on each other: leave those out") from cause
        shape = (*members.shape, members.shape[1])
        down, across = (np.broadcast_to(places, shape).ravel() for places in (members[:, :, None], members[:, None, :]))
        parts.append(sparse.csr_matrix((inverse.ravel(), (down, across)), shape=gram.shape))
    free = sparse.identity(where.size, format="csr") - gradients.T @ sum(parts) @ gradients
    found = (free @ matrix @ free).tocsr()
    found.data[np.abs(found.data) < ROUNDED * np.abs(matrix.data).max(initial=0.0)] = 0.0
    return found


def modes(matrix: Any, kinds: Sequence[Any]) -> Modes | None:
    """All modes of a sparse symmetric matrix of three coordinates an atom, where ``kinds`` name each atom; None where
    windows of a few hundred atoms are too thin to bound anything.
    """
    matrix = ((matrix + matrix.T) / 2).tocsr()
    matrix.sum_duplicates()
    matrix.eliminate_zeros()
    entries = matrix.tocoo()
    atoms = matrix.shape[0] // 3
    near = sparse.csr_matrix((np.ones(entries.nnz), (entries.row // 3, entries.col // 3)), shape=(atoms, atoms))
    found = Modes()
    for members in _alike(csgraph.connected_components(near, directed=False)[1]):
        size = members.shape[1]
        if size <= WHOLE:
            each = max(1, _TOGETHER // (9 * size**2))
            for start in range(0, len(members), each):
                _whole(matrix, members[start : start + each], kinds, found)
        elif not all(_in_windows(matrix, near, atoms, found) for atoms in members):
            return None
    # The eigenvalues of a symmetric matrix as LAPACK finds them are off by some units in the last place of its norm,
    # times its size at most.
    found.beyond += 3 * min(matrix.shape[0], 3 * WHOLE) * float(np.finfo(float).eps) * found.largest
    return found


def _alike(label: npt.NDArray[np.int32]) -> list[_Indices]:
    """The members of each label, those of equally many together: (labels, members)."""
    order = np.argsort(label, kind="stable")
    sizes = np.bincount(label)
    starts = np.cumsum(sizes) - sizes
    return [order[starts[sizes == size][:, None] + np.arange(size)].astype(np.int64) for size in np.unique(sizes)]


def _coordinates(members: _Indices) -> _Indices:
    coordinates: _Indices = (3 * members[..., None] + np.arange(3)).reshape(*members.shape[:-1], -1)
    return coordinates


def _dense(matrix: Any, members: _Indices) -> Doubles:
    """The dense matrices of sets of rows that nothing joins, (sets, n, n)."""
    count, size = members.shape
    rows = matrix[members.ravel()].tocoo()
    place = np.zeros(matrix.shape[0], dtype=np.int64)
    place[members.ravel()] = np.tile(np.arange(size), count)
    blocks = np.zeros((count, size, size))
    blocks[rows.row // size, rows.row % size, place[rows.col]] = rows.data
    return blocks


def _whole(matrix: Any, members: _Indices, kinds: Sequence[Any], found: Modes) -> None:
    """All modes of molecules of equally many atoms."""
    values, vectors = np.linalg.eigh(_dense(matrix, _coordinates(members)))
    found.whole.append(values.ravel())
    moves = np.abs(values).max(axis=1) > 0
    found.molecules += int(moves.sum())
    for n in np.flatnonzero(moves):
        found.show(tuple(kinds[atom] for atom in members[n]), Shown(members[n], values[n], vectors[n], 1))


def _in_windows(matrix: Any, near: Any, atoms: _Indices, found: Modes) -> bool:
    """All modes of one molecule through windows along its bonds; whether these are thick enough."""
    neighbours = near[atoms][:, atoms]
    # From the atom farthest from any, so that layers are thin.
    root = csgraph.breadth_first_order(neighbours, 0, directed=False)[0][-1]
    layer = csgraph.shortest_path(neighbours, unweighted=True, indices=root).astype(np.int64)
    depth = int(layer.max())
    before = np.concatenate([[0], np.cumsum(np.bincount(layer))])

    def largest(width: int) -> int:
        """The atoms of the largest window of layers nearer than that to its middle."""
        centres = np.arange(0, depth + width, width)
        ends, starts = np.minimum(centres + width, depth + 1), np.clip(centres - width + 1, 0, depth + 1)
        return int((before[ends] - before[starts]).max())

    fits = [width for width in range(_THIN, depth + 2) if largest(width) <= WHOLE]
    if not fits:
        return False
    width = max(fits)
    inside = matrix[_coordinates(atoms)][:, _coordinates(atoms)].tocoo()
    left = np.zeros(inside.nnz)
    for centre in range(0, depth + width, width):
        off = np.abs(layer - centre)
        weight = np.where(off < width, np.cos(np.pi / 2 * off / width), 0.0)
        left += (weight[inside.row // 3] - weight[inside.col // 3]) ** 2
        seen = np.flatnonzero(weight > 0)
        if not len(seen):
            continue
        values, vectors = np.linalg.eigh(matrix[_coordinates(atoms[seen])][:, _coordinates(atoms[seen])].toarray())
        found.windows += 1
        parts = (np.repeat(weight[seen], 3)[:, None] ** 2 * vectors**2).sum(axis=0)
        kept = parts >= _MOST
        found.seen.append((values, parts))
        found.show((int(atoms[0]), centre), Shown(atoms[seen], values[kept], vectors[:, kept], 1))
    edge = np.bincount(inside.row, weights=np.abs(inside.data) * left)
    found.beyond, found.molecules = max(found.beyond, float(edge.max(initial=0.0)) / 2), found.molecules + 1
    return True
