"""Stores: resumable, the same bytes whoever writes them."""

from __future__ import annotations

import hashlib
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
import zarr
from distributed import Client, LocalCluster

import kickdrift as kd
import kickdrift.dask as kdask

GRID = {"lambda1": "pi^2", "lambda2": "pi^2/25", "step": "1/100", "h1": ("1/100", "2/pi"), "h2": ("1/100", "7/2")}


def fingerprint(store: Path) -> str:
    """SHA-256 over all files of a store, names included."""
    total = hashlib.sha256()
    for path in sorted(path for path in store.rglob("*") if path.is_file()):
        total.update(str(path.relative_to(store)).encode() + path.read_bytes())
    return total.hexdigest()


@pytest.fixture
def small_tasks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kdask, "PAIRS", 700)


@pytest.fixture
def cluster() -> LocalCluster:
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as local:
        yield local


@pytest.mark.usefixtures("small_tasks")
def test_a_store_holds_the_map(tmp_path: Path) -> None:
    whole = kd.map(**GRID, label=True, growth=True)
    data = kdask.map(tmp_path / "map.zarr", **GRID, label=True, growth=True)
    for name in ("verdict", "tier", "m", "a", "b"):
        np.testing.assert_array_equal(data[name].values, whole.arrays[name])
    # Rates are enclosed, and their last digits depend on the pairs that ran side by side.
    apart = np.abs(data.growth_rate.values - whole.growth_rate)
    within = data.growth_rate_error.values + whole.arrays["growth_rate_error"]
    grows = ~np.isnan(whole.growth_rate)
    assert (np.isnan(data.growth_rate.values) == ~grows).all() and (apart[grows] <= within[grows]).all()
    np.testing.assert_allclose(data.h1.values, whole.h1, rtol=4e-16)
    assert data.attrs["verdict_names"] == list(whole.names)


@pytest.mark.usefixtures("small_tasks")
def test_what_is_written_is_not_computed_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    kdask.map(tmp_path / "whole.zarr", **GRID)
    done: list[int] = []
    part = kdask._map_part

    def until_five(task: tuple) -> int:
        if len(done) == 5:
            raise KeyboardInterrupt
        done.append(task[5])
        return part(task)

    monkeypatch.setattr(kdask, "_map_part", until_five)
    with pytest.raises(KeyboardInterrupt):
        kdask.map(tmp_path / "part.zarr", **GRID)
    monkeypatch.setattr(kdask, "_map_part", lambda task: done.append(task[5]) or part(task))
    kdask.map(tmp_path / "part.zarr", **GRID)
    assert done == sorted(set(done)), "each part once"
    assert fingerprint(tmp_path / "part.zarr") == fingerprint(tmp_path / "whole.zarr")
    with pytest.raises(kd.KickdriftError, match="something else"):
        kdask.map(tmp_path / "part.zarr", **{**GRID, "lambda2": 1})


@pytest.mark.usefixtures("small_tasks")
def test_killed_workers_lose_nothing(tmp_path: Path, cluster: LocalCluster) -> None:
    kdask.map(tmp_path / "serial.zarr", **GRID, growth=True)
    with Client(cluster) as client:
        victim = next(iter(client.run(os.getpid).values()))
        killer = subprocess.Popen([sys.executable, "-c", f"import os,time; time.sleep(0.6); os.kill({victim}, 9)"])
        data = kdask.map(tmp_path / "killed.zarr", client=client, **GRID, growth=True)
        assert killer.wait() == 0
    assert bool(np.isin(data.verdict.values, range(7)).all())
    assert fingerprint(tmp_path / "killed.zarr") == fingerprint(tmp_path / "serial.zarr")


JOB = """
import sys, time
import kickdrift.dask as kdask
kdask.PAIRS = 700
part = kdask._map_part
def slow(task):
    time.sleep(0.1)
    done = part(task)
    print(task[5], flush=True)
    return done
if sys.argv[2] == "slow":
    kdask._map_part = slow
kdask.map(sys.argv[1], lambda1="pi^2", lambda2="pi^2/25", step="1/100", h1=("1/100", "2/pi"), h2=("1/100", "7/2"))
"""


@pytest.mark.usefixtures("small_tasks")
def test_a_killed_job_goes_on_where_it_stopped(tmp_path: Path) -> None:
    kdask.map(tmp_path / "whole.zarr", **GRID)
    script = tmp_path / "job.py"
    script.write_text(JOB)
    store = tmp_path / "killed.zarr"
    with subprocess.Popen([sys.executable, script, store, "slow"], stdout=subprocess.PIPE, text=True) as job:
        assert job.stdout is not None
        for _ in range(4):
            job.stdout.readline()
        job.send_signal(signal.SIGKILL)
    before = {path: path.stat().st_mtime_ns for path in (store / "verdict").rglob("*") if path.is_file()}
    assert 4 < len(before) < 32
    time.sleep(0.02)
    subprocess.run([sys.executable, script, store, "fast"], check=True)
    written = [path for path, when in before.items() if path.stat().st_mtime_ns != when]
    # The one under way when it was killed, at most.
    assert len(written) <= 1
    assert fingerprint(store) == fingerprint(tmp_path / "whole.zarr")


SCHEDULED = """
import sys
import kickdrift.dask as kdask
from distributed import Client
kdask.PAIRS = 700
kdask.map(sys.argv[1], client=Client(scheduler_file=sys.argv[2], timeout=60), lambda1="pi^2", lambda2="pi^2/25",
          step="1/100", h1=("1/100", "2/pi"), h2=("1/100", "7/2"), growth=True)
"""


@contextmanager
def scheduled(folder: Path, name: str) -> Iterator[tuple[subprocess.Popen[bytes], Path]]:
    """A scheduler and two workers, each a process of its own, as a cluster has them: the scheduler, and its file."""
    file = folder / name
    dask = [sys.executable, "-m", "dask"]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "cwd": folder}
    scheduler = subprocess.Popen(
        [*dask, "scheduler", "--port=0", "--no-dashboard", f"--scheduler-file={file}"], **quiet
    )
    worker = [*dask, "worker", f"--scheduler-file={file}", "--nthreads=1", "--no-nanny", "--no-dashboard"]
    worker += ["--death-timeout=60"]
    workers = [subprocess.Popen(worker, **quiet) for _ in range(2)]
    try:
        yield scheduler, file
    finally:
        for process in [scheduler, *workers]:
            process.kill()
            process.wait()


def written(store: Path) -> dict[Path, int]:
    """The chunks of verdicts that there are, and when each was written."""
    return {path: path.stat().st_mtime_ns for path in (store / "verdict" / "c").rglob("*") if path.is_file()}


@pytest.mark.usefixtures("small_tasks")
def test_a_job_whose_scheduler_was_killed_goes_on_where_it_stopped(tmp_path: Path) -> None:
    kdask.map(tmp_path / "whole.zarr", **GRID, growth=True)
    script, store = tmp_path / "job.py", tmp_path / "killed.zarr"
    script.write_text(SCHEDULED)
    with scheduled(tmp_path, "first.json") as (scheduler, file):
        job = subprocess.Popen([sys.executable, script, store, file], stderr=subprocess.DEVNULL)
        deadline = time.monotonic() + 120
        while len(written(store)) < 5:
            assert job.poll() is None and time.monotonic() < deadline, "the job does not begin"
            time.sleep(0.01)
        scheduler.kill()
        # What is under way is lost; the job has nobody to ask, and is killed too where it waits.
        time.sleep(1.0)
        job.kill()
        job.wait()
    before = written(store)
    done = set(np.flatnonzero(zarr.open_group(store, mode="r")["done"][:]))
    assert 5 <= len(before) < 32 and len(before) - 2 <= len(done) <= len(before)
    with scheduled(tmp_path, "second.json") as (_, file):
        subprocess.run([sys.executable, script, store, file], check=True)
    again = [path for path, when in before.items() if path.stat().st_mtime_ns != when]
    # Those under way when it was killed, at most one a worker.
    assert len(again) == len(before) - len(done) <= 2
    assert fingerprint(store) == fingerprint(tmp_path / "whole.zarr")


def test_a_survey_lists_all_tongues(tmp_path: Path) -> None:
    tree = kdask.survey(tmp_path / "survey.zarr", max_sum=9, rho="1/25")
    found = {
        (int(p), int(q), int(m))
        for node in tree.children.values()
        for p, q, m in zip(node["p"].values, node["q"].values, node["m"].values, strict=True)
    }
    assert found == {(row["p"], row["q"], row["m"]) for row in kd.tongues(max_sum=9, rho="1/25", columns=["edges"])}
    again = kdask.survey(tmp_path / "survey.zarr", max_sum=9, rho="1/25")
    assert again.equals(tree)
    with pytest.raises(kd.KickdriftError):
        kdask.survey(tmp_path / "none.zarr", max_sum=1, rho=1)


def make(step: str, k: str) -> kd.System:
    return kd.System({"masses": [1], "potentials": [{"step": step, "springs": [[0, None, k]]}]})


def test_a_scan_decides_each_system(tmp_path: Path) -> None:
    steps, stiffnesses = ["1/2", "1", "3/2"], ["1", "3", "5"]
    data = kdask.scan(tmp_path / "scan.zarr", make, x=("step", steps), y=("k", stiffnesses))
    for row, step in enumerate(steps):
        for column, k in enumerate(stiffnesses):
            assert data.stable.values[row, column] == make(step, k).decide().stable
    assert data.growth_rate.dims == ("step", "k") and bool(data.proven.values.all())
    with pytest.raises(kd.KickdriftError):
        kdask.scan(tmp_path / "other.zarr", make, x=("k", []), y=("k", [1]))
