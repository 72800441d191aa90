"""Advice: the program's document, drawn and shown."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import REPOSITORY

import kickdrift as kd

TWO = {"OH": "10fs", "slow": "40fs"}
STEPS = [("0.5fs", "4fs"), ("0.5fs", 5)]
MORE = "more: the whole answer and its tables"
FLAGS = ["--period=OH=10fs", "--period=slow=40fs", "--steps=0.5fs,4fs", "--steps=0.5fs,5fs"]
GROMACS = "dt = 0.0005 ; ps\nmts = yes\nmts-level2-factor = 8\n"


def test_advice_is_that_of_the_program(program: Callable[..., str], tmp_path: Path) -> None:
    advice = kd.advise(TWO, steps=STEPS, length="10ns")
    flags = [*FLAGS, "--band=5%", "--length=10ns"]
    assert advice.to_json() == program("advise", *flags, "--format", "json")
    # The last line says where the rest is: in the other's own word.
    few = program("advise", *flags, "--format", "text").splitlines()
    assert str(advice).splitlines()[:-1] == few[:-1] and len(few) <= 12
    assert (str(advice).splitlines()[-1], few[-1]) == (f"{MORE} in .details", f"{MORE} with --details")
    assert advice.details == program("advise", *flags, "--details", "--format", "text")
    program("advise", *flags, "--output", str(tmp_path / "advice.svg"))
    assert advice.to_svg() == (tmp_path / "advice.svg").read_text()
    assert advice == kd.advise(TWO, steps=STEPS, length=10**7) and advice.engine is None
    assert kd.recheck(advice).holds


def test_each_kind_of_mode_and_of_input_is_taken(program: Callable[..., str], tmp_path: Path) -> None:
    advice = kd.advise(
        ["3700/cm", Fraction(100)],
        bonds={"CH": "K=340kcal/mol/A^2,12.011,1.008,3"},
        on={"CH": 1},
        hmr="3.024",
        band="1/25",
        steps="1fs,4fs",
    )
    flags = ["--bond=CH:K=340kcal/mol/A^2,12.011,1.008,3", "--period=3700/cm", "--period=100fs", "--on=CH=1"]
    flags += ["--hmr=3.024", "--band=1/25", "--steps=1fs,4fs", "--format", "json"]
    assert advice.to_json() == program("advise", *flags)
    path = tmp_path / "water.mdp"
    path.write_text(GROMACS)
    read = kd.advise(TWO, engine=path)
    assert read.to_json() == kd.advise(TWO, engine=GROMACS).to_json()
    assert read.to_json() == program("advise", *FLAGS[:2], f"--engine={path}", "--format", "json")
    # GROMACS refuses intervals that are no multiples of the factor; its defaults (100 and 1000 steps) are none of 6.
    intervals = ["nstlog = 1020", "nstenergy = 1020", "nstcalcenergy = 102"]
    assert read.engine is not None and read.engine["rewritten"] == ["mts-level2-factor = 6", *intervals]


def test_advice_is_shown_in_all_forms() -> None:
    advice = kd.advise(TWO, steps=STEPS)
    assert repr(advice) == "Advice(4 fs caution, 5 fs island)" and (advice.safe, advice.largest) == (3, 4)
    shown = advice._repr_html_()
    assert "4.6768-4.9679 fs" in shown and "<svg" in shown and "Each fast mode" not in shown
    frame = advice.to_pandas()
    assert list(frame.kind) == ["elliptic", "elliptic"]
    axes = advice.plot()
    # The proven part, that beyond T/3, the rest, the one unstable interval about the scheme; both outer steps, 3 fs.
    assert len(axes.patches) == 4 and len(axes.lines) == 3
    assert len(kd.advise(["10fs"], steps=["3fs"]).plot().patches) > 0
    assert [mode["name"] for mode in advice.modes] == ["OH", "slow"]
    assert kd.advise(TWO, steps=["0.5fs", "4.8fs"]).status == "unstable"


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"periods": {}}, "period"),
        ({"periods": ["10"]}, "period"),
        ({"periods": {"a=b": "10fs"}}, "periods"),
        ({"steps": ()}, "steps"),
        ({"steps": ["x"]}, "steps"),
        ({"on": {"none": 1}}, "on"),
        ({"band": 2}, "band"),
        ({"engine": "/nowhere.mdp"}, "/nowhere.mdp"),
    ],
)
def test_bad_questions_are_refused_by_name(change: dict[str, Any], field: str) -> None:
    question: dict[str, Any] = {"periods": TWO, "steps": ["0.5fs", "4fs"]} | change
    with pytest.raises(kd.KickdriftError) as caught:
        kd.advise(**question)
    assert caught.value.field == field and "--" not in str(caught.value)


@pytest.mark.parametrize("friction", ["1/10", "2"])
def test_friction_is_told_as_the_program_tells_it(program: Callable[..., str], friction: str) -> None:
    pair = {"lambda1": "pi^2", "lambda2": "pi^2/25", "h1": "1/100", "h2": "0.98"}
    verdict = kd.decide(**pair, friction=friction)
    flags = [f"--{name}={value}" for name, value in pair.items()]
    assert verdict.to_json() == program("verdict", *flags, f"--friction={friction}", "--format", "json")
    assert verdict.friction is not None and verdict.friction["rate"] == friction and not verdict.stable
    assert kd.decide(**pair).friction is None
    with pytest.raises(kd.KickdriftError) as caught:
        kd.decide(**pair, friction="pi")
    assert caught.value.field == "friction"


def test_friction_of_a_system(program: Callable[..., str], tmp_path: Path) -> None:
    system = kd.System({"masses": [1], "potentials": [{"step": "1/10", "springs": [[0, None, "10"]]},
                                                      {"step": "1", "springs": [[0, None, "2/5"]]}]})  # fmt: skip
    verdict = system.decide(friction="1/3")
    path = system.save(tmp_path)
    assert verdict.to_json() == program("system", str(path), "--friction=1/3", "--format", "json")
    assert verdict.friction is not None and verdict.friction["damping"] in ("damped", "growing")
    assert system.decide().friction is None


def test_advice_on_hessians_is_that_of_the_program(program: Callable[..., str], tmp_path: Path) -> None:
    system = kd.System.read(REPOSITORY / "data" / "scenes" / "flexible-water.json")
    advice = system.advise(steps=[("0.5fs", "4.5fs")], length="10ns")
    flags = [str(system._path), "--steps=0.5fs,4.5fs", "--band=5%", "--length=10ns"]
    assert advice.to_json() == program("advise", *flags, "--format", "json")
    assert advice.details == program("advise", *flags, "--details", "--format", "text")
    assert advice.schemes == advice.rows and len(advice.rows) == 2 and repr(advice).startswith("SystemAdvice(4 fs ")
    assert advice.groups[0]["shortest"] < 10 and advice.safe is not None and advice.safe < 4
    assert len(advice.to_pandas()) == 2 and "<pre" in advice._repr_html_()
    axes = advice.plot()
    assert len(axes.lines) == 2 and len(axes.patches) >= 4
    fast, slow = np.diag([0.39, 0.41]), np.array([[0.02, 0.01], [0.01, 0.02]])
    made = kd.System.from_hessians([1.0, 1.0], {"fast": ("1/2", fast), "slow": (4, slow)}, time_unit="fs")
    path = made.save(tmp_path)
    assert made.advise().to_json() == program("advise", str(path), "--band=5%", "--format", "json")
    with pytest.raises(kd.KickdriftError) as caught:
        kd.System.from_hessians([1.0, 1.0], {"fast": ("1/2", fast), "slow": (4, slow)}).advise()
    assert caught.value.field == "time_unit"


def test_a_process_killed_while_it_saves_leaves_the_files_of_before(tmp_path: Path) -> None:
    """SIGKILL in the middle of the arrays: nothing half stands under their name, and nothing is left to be read."""
    code = """
import os, signal, sys
import numpy as np
import kickdrift as kd
made = kd.System.from_hessians(np.ones(2), {"a": ("1/10", np.eye(6)), "b": ("1/5", 2 * np.eye(6))}, keep_rigid=True)
if sys.argv[2] == "killed":
    def half(file, **_):
        (file.write if hasattr(file, "write") else open(file, "wb").write)(b"PK half")
        getattr(file, "flush", lambda: None)()
        os.kill(os.getpid(), signal.SIGKILL)
    np.savez = half
made.save(sys.argv[1])
"""

    def run(how: str) -> int:
        # -P: the installed package, not the sources beside these tests.
        return subprocess.run([sys.executable, "-P", "-c", code, str(tmp_path), how], check=False).returncode

    assert run("killed") == -signal.SIGKILL
    assert not (tmp_path / "system.json").exists() and not (tmp_path / "arrays.npz").exists()
    assert run("whole") == 0
    before = kd.System.read(tmp_path / "system.json").decide().to_json()
    assert run("killed") == -signal.SIGKILL
    assert kd.System.read(tmp_path / "system.json").decide().to_json() == before
    assert run("whole") == 0
    assert kd.System.read(tmp_path / "system.json").decide().to_json() == before


def test_slips_are_told_what_to_give(tmp_path: Path) -> None:
    """A file of an engine in place of periods was an unknown period, a step alone was told of two."""
    path = tmp_path / "md.mdp"
    path.write_text(GROMACS)
    for given, steps, remedy in [
        (str(path), "2fs", "give an engine's input as engine="),
        (path, "2fs", "give an engine's input as engine="),
        (TWO, 2, "of one clock '2fs' or [2]"),
    ]:
        with pytest.raises(kd.KickdriftError, match=re.escape(remedy)):
            kd.advise(given, steps=steps)
    with pytest.raises(kd.KickdriftError, match="periods are a mapping, as"):
        kd.advise(OH="10fs", steps="2fs")


def test_an_archive_is_advised_about_as_the_program_does(program: Callable[..., str]) -> None:
    path = REPOSITORY / "data" / "hessians" / "water4.npz"
    advice = kd.advise(path, steps="0.5fs,4fs", levers=False)
    flags = [str(path), "--steps=0.5fs,4fs", "--no-levers", "--format", "json"]
    assert advice.to_json() == program("advise", *flags)
    assert advice.safe is not None and advice.safe < 4
    with pytest.raises(kd.KickdriftError, match="is for periods"):
        kd.advise(path, steps="0.5fs,4fs", on={"OH": 1})


def test_keywords_stand_where_the_program_names_flags() -> None:
    text = str(kd.advise(["10fs"], steps="2fs"))
    assert "say harmonic=True" in text and "--harmonic" not in text
