"""The same from ASE's calculators."""

from __future__ import annotations

import ase
import numpy as np
import pytest
from ase import units
from ase.calculators.calculator import Calculator, all_changes
from ase.calculators.emt import EMT
from ase.cluster import Octahedron
from ase.constraints import FixAtoms

import kickdrift as kd
import kickdrift.ase as ka


class Springs(Calculator):
    """Each atom on a spring of its own, eV/Å²."""

    implemented_properties = ("energy", "forces")

    def __init__(self, stiffness: float) -> None:
        super().__init__()
        self.stiffness = stiffness

    def calculate(self, atoms=None, properties=("energy",), system_changes=all_changes) -> None:
        super().calculate(atoms, properties, system_changes)
        where = self.atoms.positions
        self.results = {"energy": self.stiffness / 2 * (where**2).sum(), "forces": -self.stiffness * where}


def test_springs_are_the_oscillators_that_they_are() -> None:
    atoms = ase.Atoms("H", [[0.1, 0.0, 0.0]])
    # 1/fs²; a tenth of this is the slow force.
    stiffness = 30.0
    fast = stiffness * units.fs**2 / atoms.get_masses()[0]
    for step, inner in ((1, "1/4"), (4, "1/4"), ("21/5", "3/10")):
        groups = {"fast": (Springs(stiffness), inner), "slow": (Springs(stiffness / 10), step)}
        found = ka.system(atoms, groups).decide()
        one = kd.decide(lambda1=float(fast), lambda2=float(fast / 10), h1=inner, h2=step)
        assert found.stable == one.stable
        if not one.stable:
            assert found.growth_rate == pytest.approx(one.growth_rate, rel=1e-6)
        small = ka.oscillations(atoms, groups)
        assert small.stable == one.stable and small.about == "orbit" and small.away < 1e-9


def test_copper_is_stable_at_five_and_not_at_fifty() -> None:
    atoms = ase.Atoms("Cu4", [[0, 0, 0], [2.2, 0, 0], [1.1, 1.9, 0], [1.1, 0.6, 1.8]])
    slow, fast = (ka.system(atoms, {"all": (EMT(), step)}) for step in (5, 50))
    assert slow.decide().stable and not fast.decide().stable
    measured = slow.decide().measured
    assert measured is not None and measured["rigid_motions"]["count"] == 6


class Swirling(Springs):
    """Springs, and a force across them: no gradient."""

    def __init__(self, stiffness: float, across: float) -> None:
        super().__init__(stiffness)
        self.across = across

    def calculate(self, atoms=None, properties=("energy",), system_changes=all_changes) -> None:
        super().calculate(atoms, properties, system_changes)
        x, y, _ = self.atoms.positions.T
        self.results["forces"] = self.results["forces"] + self.across * np.array([-y, x, 0 * x]).T


def test_a_direct_force_grows_as_its_own_eigenvalues_say() -> None:
    atoms = ase.Atoms("H", [[0.0, 0.0, 0.0]])
    cheap, dear = Springs(30.0), Swirling(33.0, 0.6)
    groups = {"cheap": (cheap, "0.5fs"), "correction": ((dear, cheap), "2fs")}
    system = ka.system(atoms, groups, symmetric=False, minimize=False)
    found = system.decide()
    assert found.kind == "hyperbolic" and found.proven and not found.stable
    beside = found.no_gradient
    assert beside is not None and found.local_steps is None
    # x'' = -(33 -+ 0.6 i) x, over the mass.
    rate = np.sqrt(complex(33.0, 0.6) * units.fs**2 / atoms.get_masses()[0]).imag
    assert beside["without_steps"]["lo"] <= rate <= beside["without_steps"]["hi"]
    assert beside["within_accuracy"]["lo"] <= found.growth_rate <= beside["within_accuracy"]["hi"]
    # |J - J'|/|J + J'| of diag(3, 3, 3) and a turn of 0.6.
    assert beside["asymmetries"] == pytest.approx([0, 0.6 * 2**0.5 / (3 * 3**0.5)], abs=1e-6)
    advice = system.advise(friction="1/ps", levers=False)
    assert advice.status == "little" and [row["multiple"] for row in advice.ladder[:4]] == [1, 2, 3, 4]
    assert advice.ladder[3]["growth_rate"] == advice.schemes[0]["growth_rate"]
    assert advice.plot().get_ylabel() == "growth (1/ps)"
    # Of a force that is a gradient this asymmetry is an error, and larger than any verdict bears.
    with pytest.raises(kd.KickdriftError, match="too uncertain"):
        ka.system(atoms, groups, minimize=False)


@pytest.mark.parametrize(
    ("groups", "field"),
    [
        ({}, "groups"),
        ({"all": (EMT(), 0)}, "groups[all]"),
        ({"all": (EMT(), "x")}, "groups[all]"),
        ({"all": EMT()}, "groups[all]"),
    ],
)
def test_bad_groups_are_refused(groups: dict, field: str) -> None:
    with pytest.raises(kd.KickdriftError) as caught:
        ka.system(ase.Atoms("Cu2", [[0, 0, 0], [2.2, 0, 0]]), groups)
    assert caught.value.field == field


def test_advice_asks_for_the_groups() -> None:
    with pytest.raises(kd.KickdriftError, match="of ASE give groups="):
        kd.advise(ase.Atoms("Cu2", [[0, 0, 0], [2.2, 0, 0]]))


def test_what_newton_alone_does_not_reach_comes_to_rest() -> None:
    """An octahedron of copper turns into an icosahedron. Before: "not near a minimum"."""
    copper = Octahedron("Cu", 3, 1)
    copper.positions += 0.01 * np.random.default_rng(1).normal(size=copper.positions.shape)
    found = ka.system(copper, {"all": (EMT(), 5)})
    assert found.decide().stable
    copper.positions, copper.calc = found.arrays["positions"], EMT()
    assert np.abs(copper.get_forces()).max() < 1e-4


def test_constraints_and_far_positions_are_refused() -> None:
    atoms = ase.Atoms("Cu2", [[0, 0, 0], [2.2, 0, 0]], constraint=FixAtoms([0]))
    with pytest.raises(kd.KickdriftError, match="constraints"):
        ka.system(atoms, {"all": (EMT(), 5)})
    far = ase.Atoms("Cu2", [[0, 0, 0], [15, 0, 0]])
    with pytest.raises(kd.KickdriftError, match="minimum"):
        ka.system(far, {"all": (EMT(), 5)})
    assert np.allclose(ka.system(far, {"all": (EMT(), 5)}, minimize=False).arrays["positions"], far.positions)


class Pair(Calculator):
    """Two atoms and the spring between them, eV/Å², of some length."""

    implemented_properties = ("energy", "forces")

    def __init__(self, stiffness: float, length: float) -> None:
        super().__init__()
        self.spring = stiffness, length

    def calculate(self, atoms=None, properties=("energy",), system_changes=all_changes) -> None:
        super().calculate(atoms, properties, system_changes)
        stiffness, length = self.spring
        apart = self.atoms.positions[1] - self.atoms.positions[0]
        long = np.linalg.norm(apart)
        pull = stiffness * (long - length) * apart / long
        self.results = {"energy": stiffness / 2 * (long - length) ** 2, "forces": np.array([pull, -pull])}


def test_groups_that_pull_against_each_other_are_told_of() -> None:
    atoms = ase.Atoms("H2", [[0, 0, 0], [1.0, 0, 0]])
    at_rest = ka.system(atoms, {"fast": (Pair(30, 1.0), "0.25fs"), "slow": (Pair(1, 1.0), "0.001ps")})
    measured = at_rest.decide().measured
    assert at_rest.notes == () and measured is not None and measured["rigid_motions"]["count"] == 5
    against = ka.system(atoms, {"fast": (Pair(30, 1.0), 0.25), "slow": (Pair(1, 1.5), 1)})
    assert "fast and of slow do not vanish" in against.notes[0] and "eV/Å" in against.notes[0]
    assert against.document["potentials"][0]["step"] == "1/4"


def test_the_orbit_that_a_run_is_about_stands_first() -> None:
    """Against the scheme itself, step by step: two springs that pull against each other, at steps on both sides of the
    first unstable one, where the outer step meets half the period of the spring."""
    atoms = ase.Atoms("H2", [[0, 0, 0], [1.0, 0, 0]])
    kinds = []
    for outer in ("1fs", "4fs"):
        made = {"fast": (Pair(30, 1.0), "0.25fs"), "slow": (Pair(3, 1.1), outer)}
        system = ka.system(atoms, made)
        verdict, found = system.decide(), ka.oscillations(atoms, made)
        first, second = str(verdict).splitlines()[:2]
        assert first == str(system.advise()).splitlines()[0]
        assert first.startswith(f"own orbit: at {outer[0]} fs a run swings about an orbit beside the minimum, ")
        assert found.proven and found.words in first and f"{found.away:.2g} Å away" in first
        assert not second.startswith("warning") and any("swings" in note for note in verdict.warnings)
        assert verdict.orbit is not None and verdict.orbit.stable == found.stable
        kinds.append(found.stable)
    assert kinds == [True, False]


def test_a_cell_has_three_rigid_motions_and_a_field_none() -> None:
    cell = ase.Atoms("H2", [[0, 0, 0], [1.0, 0, 0]], cell=[5, 5, 5], pbc=True)
    found = ka.system(cell, {"fast": (Pair(30, 1.0), "1/4"), "slow": (Pair(1, 1.0), 1)})
    boxed = found.decide().measured
    assert boxed is not None
    assert (boxed["rigid_motions"]["count"], boxed["rigid_motions"]["found_by"]) == (3, "periodic box")
    field = {"fast": (Springs(30), "1/4"), "slow": (Springs(1), 1)}
    measured = ka.system(ase.Atoms("H2", np.eye(2, 3)), field).decide().measured
    assert measured is not None and measured["rigid_motions"] is None


def test_a_number_of_fs_that_no_molecule_bears_asks_for_a_unit() -> None:
    with pytest.raises(kd.KickdriftError, match="name the unit"):
        ka.system(ase.Atoms("Cu2", [[0, 0, 0], [2.2, 0, 0]]), {"all": (EMT(), 500)})


class Broken(Springs):
    """Springs whose forces come out of it changed."""

    def __init__(self, change) -> None:
        super().__init__(30.0)
        self.change = change

    def calculate(self, atoms=None, properties=("energy",), system_changes=all_changes) -> None:
        super().calculate(atoms, properties, system_changes)
        self.results["forces"] = self.change(self.results["forces"])


@pytest.mark.parametrize(
    ("given", "field", "remedy"),
    [
        ({"groups": Broken(lambda forces: forces * np.nan)}, "forces", "no finite force at these positions"),
        ({"groups": Broken(lambda forces: forces[:1])}, "forces", r"give shape \(2, 3\)"),
        ({"groups": None}, "groups[all]", "give a calculator"),
        ({"groups": EMT}, "groups[all]", "give a calculator"),
        ({"groups": (EMT(), EMT(), EMT())}, "groups[all]", "give a calculator"),
        ({"atoms": ase.Atoms()}, "atoms", "at least one"),
        ({"atoms": ase.Atoms("H2", [[0, 0, 0], [1, 0, 0]], masses=[1, 0])}, "atoms", "must be positive"),
        ({"difference": 0}, "difference", "positive finite"),
        ({"difference": np.nan}, "difference", "positive finite"),
        ({"difference": "1e-3"}, "difference", "positive finite"),
        ({"longest": np.nan}, "system", "longest"),
    ],
)
def test_what_no_hessian_can_be_made_of_is_refused_by_name(given: dict, field: str, remedy: str) -> None:
    """Before: eigenvalues that did not converge, arrays of no shape, a NaN that let everything pass."""
    given = {"atoms": ase.Atoms("H2", [[0, 0, 0], [1, 0, 0]]), "groups": Springs(30.0)} | given
    given["groups"] = {"all": (given["groups"], 1)}
    for ask in (ka.system, ka.oscillations):
        with pytest.raises(kd.KickdriftError, match=remedy) as caught:
            ask(**given)
        assert caught.value.field == field
