"""Work that was killed goes on from what it kept."""

from __future__ import annotations

import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import openmm as mm
import pytest
from test_openmm import box, waters

import kickdrift as kd
import kickdrift.openmm as ko
from kickdrift._journal import Journal
from kickdrift._openmm.forces import Forces

STEPS = {0: "0.5fs", 1: "4fs"}

#: Each column is said, and waits for a line: so the process is killed between two of them.
CHILD = """
import sys
import numpy as np, openmm as mm
import kickdrift.openmm as ko
system = mm.XmlSerializer.deserialize(open(sys.argv[1]).read())
def said(done, total):
    print(done, total, flush=True)
    sys.stdin.readline()
ko.system(system, np.load(sys.argv[2]), steps={0: "0.5fs", 1: "4fs"}, resume=sys.argv[3], progress=said)
"""


def counted(monkeypatch: pytest.MonkeyPatch) -> Callable[[], int]:
    """How many forces were asked for since this was last called."""
    count, force = [0], Forces.__call__

    def call(self: Forces, positions: np.ndarray) -> np.ndarray:
        count[0] += 1
        return force(self, positions)

    def since() -> int:
        asked, count[0] = count[0], 0
        return asked

    monkeypatch.setattr(Forces, "__call__", call)
    return since


def bits(system: kd.System, folder: Path) -> list[bytes]:
    """The file of a system and its arrays."""
    file = system.save(folder)
    return [file.read_bytes(), *(array.tobytes() for _, array in sorted(system.arrays.items()))]


def test_hessians_that_were_killed_go_on_and_are_the_same_to_the_last_bit(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    system, positions = waters()
    (tmp_path / "system.xml").write_text(mm.XmlSerializer.serialize(system))
    np.save(tmp_path / "positions.npy", positions)
    (tmp_path / "child.py").write_text(CHILD)
    kept = tmp_path / "kept"
    # Without -P the sources beside the tests would be imported.
    line = [sys.executable, "-P", "child.py", "system.xml", "positions.npy", "kept"]
    # On the way to the minimum; in the Hessian of the second group.
    for done in (50, 3 * positions.size + 20):
        with subprocess.Popen(line, stdin=-1, stdout=-1, text=True, cwd=tmp_path) as job:
            assert job.stdin is not None and job.stdout is not None
            for _ in range(done):
                assert job.stdout.readline()
                job.stdin.write("\n")
                job.stdin.flush()
            job.send_signal(signal.SIGKILL)
        assert job.returncode == -signal.SIGKILL
    since = counted(monkeypatch)
    plain = ko.system(system, positions, steps=STEPS)
    every = since()
    resumed = ko.system(system, positions, steps=STEPS, resume=kept)
    assert 0 < since() < every / 2
    assert bits(plain, tmp_path / "plain") == bits(resumed, tmp_path / "resumed")
    # All is kept then, and serves other steps; what is no difference is asked for again.
    size = kept.stat().st_size
    assert ko.system(system, positions, steps={0: "1fs", 1: "3fs"}, resume=kept).decide().stable
    assert since() < every / 20 and kept.stat().st_size == size


def test_an_orbit_goes_on_where_it_was_stopped(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    system, positions = waters()
    steps, since = {0: "0.46fs", 1: "4.6fs"}, counted(monkeypatch)
    plain = ko.oscillations(system, positions, steps=steps)
    every = since()

    def stop(done: int, total: int) -> None:
        if total < 3 * len(positions) and done == 4:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        ko.oscillations(system, positions, steps=steps, resume=tmp_path / "kept", progress=stop)
    begun = since()
    resumed = ko.oscillations(system, positions, steps=steps, resume=tmp_path / "kept")
    assert begun > every / 10 and since() < every - 0.9 * begun
    assert resumed.half.tobytes() == plain.half.tobytes() and resumed.growth_rate == plain.growth_rate > 0


def test_pairs_at_a_cutoff_and_single_precision_are_kept_too(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    rng, force = np.random.default_rng(1), Forces.__call__

    # The CPU platform's threads add up in any order: no force comes twice with the same bits.
    def unlike(self: Forces, positions: np.ndarray) -> np.ndarray:
        found = force(self, positions)
        return np.asarray(found * (1 + 1e-12 * rng.normal(size=found.shape)))

    monkeypatch.setattr(Forces, "__call__", unlike)
    since = counted(monkeypatch)
    for name, made, how in [
        ("box", box(2), {"steps": {0: "0.5fs", 1: "2fs", 2: "4fs"}, "minimize": False}),
        ("cpu", waters(), {"steps": STEPS, "platform": "CPU"}),
    ]:
        first, again = (ko.system(*made, resume=tmp_path / name, **how) for _ in range(2))
        assert since() < 1000 and bits(first, tmp_path / f"{name}1") == bits(again, tmp_path / f"{name}2")


def test_what_is_kept_of_something_else_is_refused(tmp_path: Path) -> None:
    system, positions = waters()
    kept = tmp_path / "kept"
    ko.system(system, positions, steps=STEPS, resume=kept, minimize=False)
    before = kept.read_bytes()
    heavier = mm.XmlSerializer.clone(system)
    heavier.setParticleMass(0, 17.0)
    for other, where in [(system, positions + 1e-9), (heavier, positions)]:
        with pytest.raises(kd.KickdriftError, match="other positions or another system: name another file"):
            ko.system(other, where, steps=STEPS, resume=kept, minimize=False)
    assert kept.read_bytes() == before
    (tmp_path / "text").write_text("a letter")
    for name, why in [("text", "holds something else"), ("none/kept", "No such file"), (".", "Is a directory")]:
        with pytest.raises(kd.KickdriftError, match=why) as refused:
            ko.system(system, positions, steps=STEPS, resume=tmp_path / name)
        assert refused.value.field == "resume"
    assert (tmp_path / "text").read_text() == "a letter"


def test_a_journal_cut_anywhere_keeps_its_whole_records(tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    arrays = [rng.normal(size=size) for size in [(3,), (2, 4), (), (0,), (2, 1, 2)]]

    def ask(path: Path) -> tuple[int, list[np.ndarray]]:
        journal, made = Journal.at(path, "one", 2.0), [0]
        assert journal is not None

        def make(array: np.ndarray) -> np.ndarray:
            made[0] += 1
            return array

        found = [
            journal.under("array").kept(lambda array=array: make(array), float(k)) for k, array in enumerate(arrays)
        ]
        return made[0], found

    path = tmp_path / "whole"
    assert ask(path)[0] == len(arrays) and ask(path)[0] == 0
    whole = path.read_bytes()
    counts = []
    for end in range(len(whole)):
        path.write_bytes(whole[:end])
        count, found = ask(path)
        counts.append(count)
        assert all(
            kept.shape == array.shape and (kept == array).all() for kept, array in zip(found, arrays, strict=True)
        )
        assert path.read_bytes() == whole
    assert counts == sorted(counts, reverse=True) and set(counts) == set(range(1, len(arrays) + 1))
    # A byte that was changed ends what stands.
    for at in range(len(whole) - 8 * 10, len(whole)):
        path.write_bytes(whole[:at] + bytes([whole[at] ^ 1]) + whole[at + 1 :])
        assert ask(path)[0] >= 1
    assert list(tmp_path.iterdir()) == [path]
