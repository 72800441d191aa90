"""Maps, surveys and scans of systems on a Dask client, into a Zarr store that xarray opens.

Each task is pure: it computes one part and writes it to chunks of its own, and only a count comes back. What a store
holds already is not computed again, so a job that was killed goes on where it stopped, and ends with the same bytes.

Give workers one thread each and let Dask spawn them (``LocalCluster(n_workers=N, threads_per_worker=1)``): each task
runs on one thread. A task is given up after as many deaths of workers as ``distributed.scheduler.allowed-failures``
says (3). On a cluster with Slurm, dask-jobqueue starts the workers::

    from dask.distributed import Client
    from dask_jobqueue import SLURMCluster

    cluster = SLURMCluster(cores=8, processes=8, memory="8GB", walltime="02:00:00")
    cluster.adapt(maximum_jobs=50)
    kickdrift.dask.map("figure1.zarr", client=Client(cluster), lambda1="pi^2", ...)
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from math import gcd
from os import PathLike, fspath
from typing import Any

import numpy as np

import kickdrift as kd
from kickdrift import _native
from kickdrift._errors import KickdriftError, needs
from kickdrift._map import _ends
from kickdrift._numbers import Exact, Range, text
from kickdrift._system import System
from kickdrift._verdict import TIERS, VERDICTS

__all__ = ["map", "scan", "survey"]

try:
    import xarray
    import zarr
except ImportError:
    raise needs("dask", "xarray", "zarr") from None

#: About as many pairs make a task: some tenths of a second.
PAIRS = 1 << 18


def map(
    store: str | PathLike[str],
    *,
    client: Any = None,
    lambda1: Exact,
    lambda2: Exact,
    h1: Range,
    h2: Range,
    step: Exact,
    label: bool = False,
    growth: bool = False,
    budget: int | None = None,
) -> xarray.Dataset:
    """Decide every pair of a grid into a Zarr store, a group of columns a task.

    Parameters
    ----------
    store : path
        A store of this very map goes on; one of another map is an error.
    client : dask.distributed.Client, optional
        Here, one task after the other, unless given.
    lambda1, lambda2, h1, h2, step, label, growth, budget
        As for :func:`kickdrift.map`.

    Returns
    -------
    xarray.Dataset
        The store, opened: ``verdict`` and what else was asked for over the coordinates h1 and h2. Growth rates are
        enclosures: they agree with :func:`kickdrift.map` within ``growth_rate_error``.

    Raises
    ------
    KickdriftError
        Bad input; a store of something else.

    Examples
    --------
    >>> import tempfile
    >>> import kickdrift.dask
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     data = kickdrift.dask.map(folder + "/map.zarr", lambda1="pi^2", lambda2=1, step="1/20",
    ...                               h1=("1/20", "2/pi"), h2=("1/20", 2))
    ...     int(data.verdict.size), dict(data.sizes)
    (480, {'h1': 12, 'h2': 40})
    """
    question: dict[str, Any] = {
        "lambda1": text("lambda1", lambda1),
        "lambda2": text("lambda2", lambda2),
        "step": text("step", step),
        "h1": "..".join(_texts("h1", h1)),
        "h2": "..".join(_texts("h2", h2)),
        "label": label,
        "growth": growth,
    }
    stiffness, steps = [question["lambda1"], question["lambda2"]], [question["step"]] * 2
    columns, rows = _native.multipliers(stiffness, steps, [_texts("h1", h1), _texts("h2", h2)])
    shape = (columns[1] - columns[0] + 1, rows[1] - rows[0] + 1)
    width = min(max(PAIRS // shape[1], 1), shape[0])
    planes: dict[str, Any] = {"verdict": np.uint8, "tier": np.uint8}
    planes |= {"m": np.int64, "a": np.int64, "b": np.int64} if label else {}
    planes |= {"growth_rate": np.float64, "growth_rate_error": np.float64} if growth else {}
    parts = -(-shape[0] // width)

    def template(group: zarr.Group) -> None:
        size = float(kd.number(question["step"]))
        for name, (first, last) in (("h1", columns), ("h2", rows)):
            _array(group, name, np.float64, (last - first + 1,), None, (name,))[:] = size * np.arange(first, last + 1)
        for name, kind in planes.items():
            _array(group, name, kind, shape, (width, shape[1]), ("h1", "h2"))

    names = {"verdict_names": list(VERDICTS), "tier_names": list(TIERS)}
    missing = _prepare(store, "map", question, parts, template, names)
    tasks = [(fspath(store), question, budget, columns[0], width, part, shape[0]) for part in missing]
    _run(client, _map_part, tasks)
    return xarray.open_zarr(fspath(store), consolidated=False).drop_vars("done")


def _texts(field: str, value: Range) -> list[str]:
    return [text(field, end) for end in _ends(field, value)]


def _map_part(task: tuple[str, dict[str, Any], int | None, int, int, int, int]) -> int:
    store, question, budget, first, width, part, count = task
    begin, end = part * width, min((part + 1) * width, count)
    step = question["step"]
    found = kd.map(
        lambda1=question["lambda1"],
        lambda2=question["lambda2"],
        step=step,
        h1=(f"({step})*{first + begin}", f"({step})*{first + end - 1}"),
        h2=question["h2"],
        label=question["label"],
        growth=question["growth"],
        budget=budget,
        threads=1,
    )
    group = zarr.open_group(store, mode="r+", use_consolidated=False)
    for name, values in found.arrays.items():
        if values.ndim == 2:
            _own(group, name)[begin:end] = values
    _own(group, "done")[part] = True
    return int(found.verdict.size)


def survey(store: str | PathLike[str], *, client: Any = None, max_sum: int, rho: Exact) -> xarray.DataTree:
    """List every tongue of all ratios p + q <= max_sum into a Zarr store, a task for each sum.

    Parameters
    ----------
    store : path
        A store of this very survey goes on; one of another is an error.
    client : dask.distributed.Client, optional
        Here, one task after the other, unless given.
    max_sum : int
    rho : Exact
        lambda2/lambda1, rational, not negative.

    Returns
    -------
    xarray.DataTree
        A node for each sum, ``sum-00007`` and so on, with p, q, m, a, b and the ends of both edges in
        s = h1² lambda1 over the coordinate ``tongue``; the upper edge is infinite where a tongue has no end.

    Raises
    ------
    KickdriftError
        Bad input; a store of something else.

    Examples
    --------
    >>> import tempfile
    >>> import kickdrift.dask
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     tree = kickdrift.dask.survey(folder + "/survey.zarr", max_sum=5, rho="1/25")
    ...     len(tree.children), int(tree["sum-00005"].sizes["tongue"])
    (4, 16)
    """
    if max_sum < 2:
        raise KickdriftError("max_sum", str(max_sum), "choose 2 or more")
    question = {"max_sum": max_sum, "rho": text("rho", rho)}

    def template(group: zarr.Group) -> None:
        for total in range(2, max_sum + 1):
            count = sum(total - 1 for p in range(1, total) if gcd(p, total) == 1)
            table = group.create_group(f"sum-{total:05}")
            _array(table, "tongue", np.int64, (count,), None, ("tongue",))[:] = np.arange(count)
            for name, kind in _COLUMNS.items():
                _array(table, name, kind, (count,), (count,), ("tongue",))

    missing = _prepare(store, "survey", question, max_sum - 1, template, {})
    _run(client, _survey_part, [(fspath(store), question["rho"], part) for part in missing])
    return xarray.open_datatree(fspath(store), engine="zarr", consolidated=False)


_COLUMNS: dict[str, Any] = dict.fromkeys(("p", "q", "m", "a", "b"), np.int64)
_COLUMNS |= dict.fromkeys(("lower_lo", "lower_hi", "upper_lo", "upper_hi"), np.float64)


def _survey_part(task: tuple[str, Any, int]) -> int:
    store, rho, part = task
    total = part + 2
    columns: dict[str, list[float]] = {name: [] for name in _COLUMNS}
    for p in (p for p in range(1, total) if gcd(p, total) == 1):
        for row in kd.tongues(f"{p}/{total - p}", rho=rho, columns=["edges"]):
            upper = row["upper"] or {"lo": np.inf, "hi": np.inf}
            ends = (row["lower"]["lo"], row["lower"]["hi"], upper["lo"], upper["hi"])
            values = (*(row[name] for name in ("p", "q", "m", "a", "b")), *ends)
            for name, value in zip(_COLUMNS, values, strict=True):
                columns[name].append(value)
    group = zarr.open_group(store, mode="r+", use_consolidated=False)
    for name, values_ in columns.items():
        _own(group, f"sum-{total:05}/{name}")[:] = np.array(values_, dtype=_COLUMNS[name])
    _own(group, "done")[part] = True
    return len(columns["m"])


def scan(
    store: str | PathLike[str],
    make: Callable[[Any, Any], System],
    *,
    client: Any = None,
    x: tuple[str, Sequence[Exact]],
    y: tuple[str, Sequence[Exact]],
    budget: int | None = None,
) -> xarray.Dataset:
    """Decide a system at every pair of two parameters into a Zarr store, a task for each x.

    Parameters
    ----------
    store : path
        A store of these parameters goes on; that ``make`` is the same is up to the caller.
    make : callable
        The system at (x, y); a function that workers can import or unpickle.
    client : dask.distributed.Client, optional
        Here, one task after the other, unless given.
    x, y : (str, sequence of Exact)
        The names and values of the parameters.
    budget : int, optional
        The most work of one verdict.

    Returns
    -------
    xarray.Dataset
        ``stable``, ``proven`` and ``growth_rate`` over the coordinates, which are rounded.

    Raises
    ------
    KickdriftError
        Parameters of one name or without values; a store of another question; what ``make`` or a verdict raises.

    Examples
    --------
    >>> import tempfile
    >>> import kickdrift as kd, kickdrift.dask
    >>> def make(step, k):
    ...     return kd.System({"masses": [1], "potentials": [{"step": step, "springs": [[0, None, k]]}]})
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     data = kickdrift.dask.scan(folder + "/scan.zarr", make, x=("step", [1, 2]), y=("k", ["1/2", 3]))
    ...     data.stable.values.tolist()
    [[True, True], [True, False]]
    """
    axes = {name: [text(name, value) for value in values] for name, values in (x, y)}
    if len(axes) != 2 or not all(axes.values()):
        raise KickdriftError("x, y", str(list(axes)), "give two parameters by different names, with values")
    (first, xs), (second, ys) = axes.items()

    def template(group: zarr.Group) -> None:
        for name, values in axes.items():
            _array(group, name, np.float64, (len(values),), None, (name,))[:] = [float(kd.number(v)) for v in values]
        for name, kind in (("stable", np.bool_), ("proven", np.bool_), ("growth_rate", np.float64)):
            _array(group, name, kind, (len(xs), len(ys)), (1, len(ys)), (first, second))

    missing = _prepare(store, "scan", {"axes": axes}, len(xs), template, {})
    _run(client, _scan_part, [(fspath(store), make, xs[part], ys, part, budget) for part in missing])
    return xarray.open_zarr(fspath(store), consolidated=False).drop_vars("done")


def _scan_part(task: tuple[str, Callable[[Any, Any], System], str, list[str], int, int | None]) -> int:
    store, make, x, ys, part, budget = task
    found = [make(x, y).decide(budget=budget) for y in ys]
    group = zarr.open_group(store, mode="r+", use_consolidated=False)
    for name in ("stable", "proven", "growth_rate"):
        _own(group, name)[part] = np.array([getattr(tongue, name) for tongue in found])
    _own(group, "done")[part] = True
    return len(found)


def _own(group: zarr.Group, name: str) -> Any:
    """An array of a group: the library's types allow for groups, too."""
    return group[name]


def _array(
    group: zarr.Group,
    name: str,
    kind: Any,
    shape: tuple[int, ...],
    chunks: tuple[int, ...] | None,
    dimensions: tuple[str, ...],
) -> Any:
    return group.create_array(name, shape=shape, dtype=kind, chunks=chunks or shape, dimension_names=dimensions)


def _prepare(
    store: str | PathLike[str],
    kind: str,
    question: dict[str, Any],
    parts: int,
    template: Callable[[zarr.Group], None],
    names: dict[str, Any],
) -> list[int]:
    """The parts that the store does not hold yet; a new store gets its coordinates and empty arrays first."""
    attributes = {"kickdrift": kind, "question": question, **names}
    group = zarr.open_group(fspath(store), mode="a", use_consolidated=False)
    if "done" not in group:
        if group.attrs.asdict() not in ({}, attributes):
            raise _another(store)
        group.attrs.update(attributes)
        for name in list(group.keys()):
            # A template that was cut short.
            del group[name]
        template(group)
        # Last: where it is, the template is whole. A chunk a part, so that no two tasks write the same file.
        _array(group, "done", np.bool_, (parts,), (1,), ("part",))
    elif group.attrs.asdict() != attributes:
        raise _another(store)
    return [int(part) for part in np.flatnonzero(~np.asarray(_own(group, "done")[:]))]


def _another(store: str | PathLike[str]) -> KickdriftError:
    return KickdriftError("store", fspath(store), "holds something else: name another one")


def _run(client: Any, work: Callable[[Any], int], tasks: Iterable[Any]) -> None:
    """All tasks, on the client or here. A result is a count, so a task that is computed again does no harm."""
    if client is None:
        for task in tasks:
            work(task)
        return
    from distributed import wait

    futures = [client.submit(work, task, pure=False) for task in tasks]
    wait(futures)
    client.gather(futures)
