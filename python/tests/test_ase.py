"""The same from ASE's calculators."""

from __future__ import annotations

import ase
import numpy as np
import pytest
from ase import units
from ase.calculators.calculator import Calculator, all_changes
from ase.calculators.emt import EMT
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
            assert found.growth_rate == pytest.approx(one.growth_rate[0], rel=1e-6)
        small = ka.oscillations(atoms, groups)
        assert small.stable == one.stable and small.about == "orbit" and small.away < 1e-9


def test_copper_is_stable_at_five_and_not_at_fifty() -> None:
    atoms = ase.Atoms("Cu4", [[0, 0, 0], [2.2, 0, 0], [1.1, 1.9, 0], [1.1, 0.6, 1.8]])
    slow, fast = (ka.system(atoms, {"all": (EMT(), step)}) for step in (5, 50))
    assert slow.decide().stable and not fast.decide().stable
    measured = slow.decide().measured
    assert measured is not None and measured["rigid_motions"]["count"] == 6


@pytest.mark.parametrize(
    ("groups", "field"), [({}, "groups"), ({"all": (EMT(), 0)}, "groups[all]"), ({"all": (EMT(), "x")}, "number")]
)
def test_bad_groups_are_refused(groups: dict, field: str) -> None:
    with pytest.raises(kd.KickdriftError) as caught:
        ka.system(ase.Atoms("Cu2", [[0, 0, 0], [2.2, 0, 0]]), groups)
    assert caught.value.field == field


def test_constraints_and_far_positions_are_refused() -> None:
    atoms = ase.Atoms("Cu2", [[0, 0, 0], [2.2, 0, 0]], constraint=FixAtoms([0]))
    with pytest.raises(kd.KickdriftError, match="constraints"):
        ka.system(atoms, {"all": (EMT(), 5)})
    far = ase.Atoms("Cu2", [[0, 0, 0], [5.5, 0, 0]])
    with pytest.raises(kd.KickdriftError, match="minimum"):
        ka.system(far, {"all": (EMT(), 5)})
    assert np.allclose(ka.system(far, {"all": (EMT(), 5)}, minimize=False).arrays["positions"], far.positions)
