"""Verdicts and rates beside the engines' own maps: every setting agrees, or is refused with the reason.

The engine's integrator is run from the orbit that was found, and from states a little beside it: differences give the
map of a period, whose eigenvalues are compared. Minutes of work, so these are behind the mark ``heavy``.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import openmm as mm
import pytest
from openmm import app, unit
from test_openmm import box, chain, groups, own_multipliers, published_runs

import kickdrift as kd
import kickdrift.openmm as ko
from kickdrift import _minimum
from kickdrift._openmm.forces import engine_of
from kickdrift._openmm.rest import at_rest

pytestmark = pytest.mark.heavy


def cluster(count: int, model: str) -> tuple[mm.System, np.ndarray]:
    """Flexible waters in vacuum, neighbours in OpenMM's own box."""
    pdb = app.PDBFile(str(Path(app.__file__).parent / "data" / "tip3p.pdb"))
    every = np.array(pdb.positions.value_in_unit(unit.nanometer)).reshape(-1, 3, 3)
    near = np.argsort(np.linalg.norm(every[:, 0] - every[:, 0].mean(axis=0), axis=1))[:count]
    topology = app.Topology()
    group = topology.addChain()
    for _ in near:
        residue = topology.addResidue("HOH", group)
        atoms = [topology.addAtom(name, app.Element.getBySymbol(name[0]), residue) for name in ("O", "H1", "H2")]
        topology.addBond(atoms[0], atoms[1]), topology.addBond(atoms[0], atoms[2])
    field = app.ForceField(f"amber14/{model}.xml")
    system = field.createSystem(topology, nonbondedMethod=app.NoCutoff, rigidWater=False, removeCMMotion=False)
    return groups(system), every[near].reshape(-1, 3)


def of_engine(system: mm.System, found: Any, levels: Sequence[tuple[int, int]]) -> np.ndarray:
    """As ``own_multipliers``, of orbits that close to a tenth of what is displaced: the mesh of a box pulls a little at
    the whole."""
    return own_multipliers(system, found, levels, closed=1e-5)


def agrees(found: Any, measured: np.ndarray, proven: bool = True) -> None:
    """Verdicts are equal and rates within 2 %, as the engine's map has them; the verdict is proven, the rate in its
    bounds."""
    assert found.proven == proven, found.words
    if proven:
        lo, hi = found.growth_bounds
        assert found.stable == (hi == 0.0) and lo <= found.growth_rate <= hi
    # Rigid motions are defective eigenvalues at 1, which differences part by the root of their error.
    firm = measured[np.abs(measured - 1) > 1e-2]
    rate = np.log(np.abs(firm).max()) / float(found.period)
    if found.stable:
        # Differences leave 1e-6 of eigenvalues, and the root of that where two meet.
        assert np.abs(firm).max() < 1 + 3e-3, rate
    else:
        assert rate == pytest.approx(found.growth_rate, rel=0.02)


OUTER = ["3", "4", "4.4", "4.5", "4.6", "5", "5.4"]


@pytest.mark.parametrize("model", ["tip3pfb", "spce", "tip3p"])
@pytest.mark.parametrize("count", [2, 3, 6])
def test_clusters_of_water_grow_as_the_engine_has_it(count: int, model: str) -> None:
    system, positions = cluster(count, model)
    at = at_rest(engine_of(system), positions, [], ko.DIFFERENCE)[0]
    grown = refused = 0
    for outer in OUTER:
        step = Fraction(outer) / 1000
        inner = int(-(-step // Fraction(1, 2000)))
        try:
            found = ko.oscillations(system, at, steps={0: step / inner, 1: step}, minimize=False)
        except kd.KickdriftError as error:
            assert error.field == "about" and "folds at" in error.remedy
            refused += 1
            continue
        agrees(found, of_engine(system, found, [(1, 1), (0, inner)]))
        grown += not found.stable
    # The softest motion of six waters of SPC/E folds at 2.5 fs.
    assert refused == (len(OUTER) if (count, model) == (6, "spce") else 0)
    assert refused or 0 < grown < len(OUTER)


@pytest.mark.parametrize(("model", "rate"), [("tip3pfb", 10.398), ("spce", 10.693), ("tip3p", 9.616)])
def test_orbits_beyond_the_period_of_stretches_grow_as_the_engine_has_it(model: str, rate: float) -> None:
    """Four waters at 8.9 fs, where the orbit of other neighbours has folded: Hessians are known to 1e-8, which proves
    nothing here."""
    system, positions = cluster(4, model)
    step = Fraction("0.0089")
    found = ko.oscillations(system, positions, steps={0: step / 18, 1: step})
    agrees(found, of_engine(system, found, [(1, 1), (0, 18)]), proven=found.proven)
    assert found.growth_rate == pytest.approx(rate, rel=1e-3)


@pytest.mark.parametrize("outer", ["2", "3.2", "4.4", "4.8"])
def test_three_clocks_grow_as_the_engine_has_it(outer: str) -> None:
    """Bonds, angles, the rest."""
    system, positions = cluster(3, "tip3pfb")
    for force in system.getForces():
        if isinstance(force, mm.HarmonicAngleForce):
            force.setForceGroup(2)
    step = Fraction(outer) / 1000
    found = ko.oscillations(system, positions, steps={0: step / 8, 2: step / 2, 1: step})
    agrees(found, of_engine(system, found, [(1, 1), (2, 2), (0, 8)]))


@cache
def switched_box() -> tuple[mm.System, np.ndarray]:
    """Forces that go to 0 at the cutoff, but for 1e-5 of the charges': so they have a minimum."""
    system, positions = mm.XmlSerializer.clone(box(2)[0]), box(2)[1]
    for force in system.getForces():
        if isinstance(force, mm.NonbondedForce):
            force.setUseSwitchingFunction(True)
            force.setSwitchingDistance(0.2)
            force.setEwaldErrorTolerance(1e-5)
    at, notes = at_rest(engine_of(system), positions + 0.0137, [], ko.DIFFERENCE)
    assert notes == []
    return system, at


def test_a_box_whose_forces_jump_and_have_no_minimum_is_refused_with_what_helps() -> None:
    system, positions = box(2)
    with pytest.raises(kd.KickdriftError, match=r"jump at a cutoff.*a switching function"):
        at_rest(engine_of(system), positions + 0.0137, [], ko.DIFFERENCE)


def test_27_waters_with_ljpme_come_to_rest_within_some_hessians(monkeypatch: pytest.MonkeyPatch) -> None:
    """Energies that jump stop OpenMM's minimizer far from rest, and steps of Newton's method are short there. Before:
    60 Hessians, 259 s, and a refusal. Pairs that no side of the cutoff holds are told."""
    system = mm.XmlSerializer.clone(box(3)[0])
    for force in system.getForces():
        if isinstance(force, mm.NonbondedForce):
            force.setNonbondedMethod(mm.NonbondedForce.LJPME)
    made: list[int] = []
    measure = _minimum.hessian
    monkeypatch.setattr(_minimum, "hessian", lambda *given: [made.append(1), measure(*given)][1])
    found = ko.system(system, box(3)[1], steps={0: "0.5fs", 1: "2fs", 2: "4fs"})
    assert len(made) < 20 and found.accuracy is not None and found.accuracy < 1e-5
    assert "kept on one side of it" in found.notes[0] and "no switching function with LJPME" in found.notes[0]


def test_no_switching_function_is_recommended_where_openmm_leaves_it_out() -> None:
    hints = []
    for method in (mm.NonbondedForce.PME, mm.NonbondedForce.LJPME):
        system = mm.XmlSerializer.clone(box(2)[0])
        for force in system.getForces():
            if isinstance(force, mm.NonbondedForce):
                force.setNonbondedMethod(method)
        hints.append(engine_of(system).smoother)
    assert hints[0].startswith("a switching function, a smaller Ewald tolerance")
    assert hints[1].startswith("a smaller Ewald tolerance") and "no switching function with LJPME" in hints[1]


@pytest.mark.parametrize(
    ("outer", "inner", "pairs", "grows"), [("2", 4, 1, False), ("4.4", 5, 1, True), ("4.6", 5, 5, True)]
)
def test_a_reciprocal_group_on_two_clocks_grows_as_the_engine_has_it(
    outer: str, inner: int, pairs: int, grows: bool
) -> None:
    """PME's pairs go with the reciprocal space, or with bonds and angles: ``pairs`` steps of theirs in a long one."""
    system, at = switched_box()
    step = Fraction(outer) / 1000
    found = ko.oscillations(system, at, steps={0: step / inner, 1: step / pairs, 2: step}, minimize=False)
    slow = [(1, 1), (2, 1)] if pairs == 1 else [(2, 1), (1, pairs)]
    agrees(found, of_engine(system, found, [*slow, (0, inner)]))
    assert found.stable is not grows


def test_a_reciprocal_group_whose_orbit_ends_is_refused() -> None:
    """At 4.6 fs, 5 inner steps, the branch from rest turns back. Orbits of other families are not meant."""
    system, at = switched_box()
    step = Fraction("4.6") / 1000
    with pytest.raises(kd.KickdriftError, match=r"it ends there\. From shorter steps"):
        ko.oscillations(system, at, steps={0: step / 5, 1: step, 2: step}, minimize=False)


@pytest.mark.parametrize("outer", ["2", "4.6"])
def test_a_box_with_a_reciprocal_group_grows_as_the_engine_has_it(outer: str) -> None:
    """Eight waters with PME, on three clocks."""
    system, at = switched_box()
    step = Fraction(outer) / 1000
    steps = {0: step / 10, 1: step / 2, 2: step}
    found = ko.oscillations(system, at, steps=steps, minimize=False)
    # At 2 fs a pair of hydrogens stands 6e-5 nm outside of the cutoff at the first kick, within a difference of it.
    agrees(found, of_engine(system, found, [(2, 1), (1, 2), (0, 10)]))
    assert found.along is not None and found.along.accuracy < 1e-6


def dipeptide(**options: Any) -> tuple[mm.System, np.ndarray]:
    _, topology, positions = published_runs().dipeptide()
    field = app.ForceField("amber96.xml")
    return groups(
        field.createSystem(topology, nonbondedMethod=app.NoCutoff, removeCMMotion=False, **options)
    ), positions


@pytest.mark.parametrize(
    ("options", "outer"),
    [({}, step) for step in ("4", "5.03", "5.5")]
    + [({"constraints": app.HBonds}, step) for step in ("6", "9.65")]
    + [({"constraints": app.HBonds, "hydrogenMass": 3.024 * unit.amu}, step) for step in ("8", "8.53", "8.6")],
)
def test_the_dipeptide_grows_as_the_engine_has_it(options: dict[str, Any], outer: str) -> None:
    system, positions = dipeptide(**options)
    step = Fraction(outer) / 1000
    inner = int(-(-step // Fraction(1, 2000)))
    found = ko.oscillations(system, positions, steps={0: step / inner, 1: step})
    agrees(found, of_engine(system, found, [(1, 1), (0, inner)]))


@pytest.mark.parametrize(("outer", "rate"), [("4.4", 0.0), ("4.5", 8.26)])
def test_27_waters_are_proven_about_their_orbit(outer: str, rate: float) -> None:
    system, positions = cluster(27, "tip3pfb")
    at = at_rest(engine_of(system), positions, [], ko.DIFFERENCE)[0]
    step = Fraction(outer) / 1000
    found = ko.oscillations(system, at, steps={0: step / 9, 1: step}, minimize=False)
    assert found.proven and found.stable == (rate == 0.0)
    assert found.growth_rate == pytest.approx(rate, rel=2e-3)


def test_120_waters_are_decided_and_advised_on_within_default_budgets() -> None:
    """1,080 degrees of freedom: half a minute of Hessians, 3 s, 20 s."""
    system, positions = cluster(120, "tip3pfb")
    made = ko.system(system, positions, steps={0: "0.5fs", 1: "4fs"})
    verdict = made.decide()
    assert verdict.stable and verdict.proven and verdict.measured is not None
    assert verdict.measured["holds"] == "stable" and "with as many inner ones: 0.0043" in str(verdict)
    assert str(made.advise()).startswith("advice: outer step 2.5 fs")


#: 1/ps² of a mass of 1 u: without it the chain bends freely, and drifts.
TETHER = 20.0


def tethered_chain() -> tuple[mm.System, np.ndarray]:
    system, where = chain()
    tethers = mm.CustomExternalForce(f"{TETHER / 2}*((x-a)^2+(y-b)^2+(z-c)^2)")
    for name in "abc":
        tethers.addPerParticleParameter(name)
    for bead, place in enumerate(where):
        tethers.addParticle(bead, list(place))
    tethers.setForceGroup(1)
    system.addForce(tethers)
    return system, where


def test_a_chain_on_three_clocks_grows_as_the_engine_has_it() -> None:
    """FENE bonds, repulsion and tethers, from the inside out."""
    system, where = tethered_chain()
    for force in system.getForces():
        if isinstance(force, mm.CustomExternalForce):
            force.setForceGroup(2)
    kinds = []
    for outer, loops in [("0.02", 8), ("0.05", 8), ("0.06", 6), ("0.07", 8), ("0.08", 8), ("0.09", 6), ("0.1", 8)]:
        step = Fraction(outer)
        found = ko.oscillations(system, where, steps={0: step / loops, 1: step / 2, 2: step})
        agrees(found, of_engine(system, found, [(2, 1), (1, 2), (0, loops)]))
        kinds.append(found.stable)
    assert kinds[:2] == [True, True] and kinds[-2:] == [False, False]
