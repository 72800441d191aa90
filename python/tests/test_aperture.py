"""How hot a bond may be, beside a loop in NumPy."""

from __future__ import annotations

import json
from collections.abc import Callable

import numpy as np
import pytest

import kickdrift as kd

MORSE = "OH:morse:D=485.72kJ/mol,a=22.87/nm,15.999,1.008"
#: kJ/mol, 1/nm, amu; kT at 350 K in kJ/mol.
DEPTH, A, MASS, THERMAL = 485.72, 22.87, 15.999 * 1.008 / 17.007, 8.31446261815324e-3 * 350


def lost(h: float, energy: float, steps: int) -> int:
    """How many of 48 phases of a Morse bond leave velocity Verlet, at an energy in kT and a step in ps."""
    curvature = 2 * DEPTH * A**2
    phase = 2 * np.pi * (np.arange(48) + 0.5) / 48
    x = np.sqrt(2 * energy * THERMAL / curvature) * np.cos(phase)
    v = np.sqrt(2 * energy * THERMAL / MASS) * np.sin(phase)
    is_lost = np.zeros(48, dtype=bool)
    with np.errstate(all="ignore"):
        for _ in range(steps):
            v -= h * DEPTH * A * np.exp(-A * x) * -np.expm1(-A * x) / MASS
            x += h * v
            is_lost |= ~(np.abs(x) <= 1)
            v -= h * DEPTH * A * np.exp(-A * x) * -np.expm1(-A * x) / MASS
    return int(is_lost.sum())


@pytest.mark.parametrize("h", [1.65, 1.8, 1.9, 2.2])
def test_a_bond_is_lost_where_a_loop_in_numpy_loses_it(h: float) -> None:
    row = kd.aperture(MORSE, temperature=350, steps=h)[0]
    aperture, half = row["aperture"], row["half_aperture"]
    # A rung or two, or a tenth: another order of sums tells some chaotic orbits otherwise.
    room = max(0.5, 0.1 * aperture)
    assert aperture <= room or lost(h / 1000, aperture - room, 20_000) == 0
    assert any(lost(h / 1000, aperture + part * room, 20_000) for part in (0, 0.5, 1))
    assert half is None or lost(h / 1000, half + max(0.5, 0.1 * half), 20_000) >= 24


def test_steps_ranges_and_units_mean_the_same() -> None:
    asked = kd.aperture(MORSE, steps=[1.95, "0.0022ps"])
    assert asked.column("h").tolist() == [1.95, 2.2] and asked.column("aperture").tolist() == [0.5, 2.25]
    ranged = kd.aperture(MORSE, h_range=(1.95, 2.2), step=0.25, temperature="298K", method="velocity-verlet")
    assert ranged.column("share_lost").tolist() == asked.column("share_lost").tolist()
    assert "no proof" in asked.data["kind"] and asked.data["level"] == pytest.approx(np.log(1e9))
    assert kd.recheck(asked).holds


def test_the_program_writes_the_same_document(program: Callable[..., str]) -> None:
    document = program("aperture", "--bond", MORSE, "--steps=1.95fs,2.2fs", "--format", "json", "--quiet")
    assert document == kd.aperture(MORSE, steps="1.95fs,2.2fs").to_json()
    assert json.loads(document)["steps"][0]["k"] == 4


def test_what_is_drawn_has_resonances_steps_and_the_level() -> None:
    pytest.importorskip("matplotlib")
    canvas = kd.aperture(MORSE, h_range="1.9fs..2.4fs", step="0.1fs", steps="2fs").plot()
    assert {text.get_text() for text in canvas.texts} == {"k = 4", "k = 3"}
    legend = canvas.get_legend()
    assert legend is not None
    names = [text.get_text() for text in legend.get_texts()]
    assert names == ["half of all phases are lost", "some phase is lost", "ln N", "the steps asked for"]


def test_what_is_no_bond_is_refused_with_what_is_one() -> None:
    with pytest.raises(kd.KickdriftError, match="write NAME:SHAPE,MASS,MASS"):
        kd.aperture("OH", steps=1)
    with pytest.raises(kd.KickdriftError, match="give the slow one"):
        kd.aperture(MORSE, steps=1, word="K2(1/2) K1(1) D(1) K2(1/2)")
    with pytest.raises(kd.BudgetError):
        kd.aperture(MORSE, steps=1, budget=1000)
