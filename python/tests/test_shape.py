"""Shapes of bonds, scanned, and the apertures of these."""

from __future__ import annotations

import numpy as np
import pytest

import kickdrift as kd

#: O-H of q-TIP4P/F: kJ/mol, 1/nm, nm, rad, kJ/mol/rad².
DEPTH, A, REST, ANGLE, BEND = 485.72, 22.87, 0.09419, np.radians(107.4), 367.56
MASSES = (15.999, 1.008, 1.008)
THERMAL = 8.31446261815324e-3 * 298


def constants(bond: str) -> list[float]:
    return [float(term.split("=")[1].split("kJ")[0]) for term in bond.split(":poly:")[1].split(",")[:3]]


@pytest.fixture
def water() -> tuple[object, np.ndarray]:
    mm = pytest.importorskip("openmm")
    system, bond, angle = mm.System(), mm.CustomBondForce(""), mm.HarmonicAngleForce()
    bond = mm.CustomBondForce(f"{DEPTH}*(y^2-y^3+7/12*y^4); y={A}*(r-{REST})")
    for mass in MASSES:
        system.addParticle(mass)
    bond.addBond(0, 1)
    bond.addBond(0, 2)
    angle.addAngle(1, 0, 2, ANGLE, BEND)
    system.addForce(bond)
    system.addForce(angle)
    sides = [[REST * np.cos(side * ANGLE / 2), REST * np.sin(side * ANGLE / 2), 0] for side in (1, -1)]
    return system, np.array([[0, 0, 0], *sides])


def test_a_water_of_openmm_has_the_bonds_that_it_was_made_of(water: tuple[object, np.ndarray]) -> None:
    import kickdrift.openmm

    found = kickdrift.openmm.shapes(*water, count=2)
    assert [shape.pair for shape in found] in ([(0, 1), (0, 2)], [(0, 2), (0, 1)])
    for shape in found:
        # The oxygen moves by a seventeenth, which bends the angle and stretches the other bond a little.
        expected = [DEPTH * A**2, -DEPTH * A**3, 7 / 12 * DEPTH * A**4]
        assert constants(shape.bond) == pytest.approx(expected, rel=0.003)
        assert shape.period == pytest.approx(8.58, rel=0.01) and shape.misfit < 0.01
    # A share of a rung, or a tenth, as the constants are off by some percent.
    truth = kd.aperture(
        f"OH:poly:k2={expected[0]}kJ/mol/nm^2,k3={expected[1]}kJ/mol/nm^3,k4={expected[2]}kJ/mol/nm^4,15.999,1.008",
        steps=1.8,
    )
    assert kd.aperture(found[0].bond, steps=1.8)[0]["aperture"] == pytest.approx(truth[0]["aperture"], rel=0.1)
    name, shape_of = found[0].bond.split(":", 1)
    assert kd.advise(bonds={name: shape_of}, steps="1fs").data["measured"][0]["mode"] == name


def test_held_bonds_of_openmm_are_not_scanned(water: tuple[object, np.ndarray]) -> None:
    import kickdrift.openmm

    system, positions = water
    system.addConstraint(0, 1, REST)  # type: ignore[attr-defined]
    assert [shape.pair for shape in kickdrift.openmm.shapes(system, positions, count=9)] == [(0, 2)]
    with pytest.raises(kd.KickdriftError, match="all bonds are held"):
        kickdrift.openmm.shapes(system, positions, pairs=[(0, 1)])
    with pytest.raises(kd.KickdriftError, match="give two different atoms of 0 to 2"):
        kickdrift.openmm.shapes(system, positions, pairs=[(0, 7)])


def test_a_morse_bond_of_ase_is_lost_near_where_the_whole_potential_is() -> None:
    pytest.importorskip("ase")
    import ase
    from ase.calculators.morse import MorsePotential

    import kickdrift.ase

    # ASE's bond of exponent rho0/r0 and depth epsilon, in eV and Å; its energy is cut off far beyond 20 kT.
    atoms = ase.Atoms("OH", [[0, 0, 0], [0.9575, 0, 0]])
    atoms.set_masses(MASSES[:2])
    calculator = MorsePotential(epsilon=DEPTH / 96.485332, r0=0.9572, rho0=2.287 * 0.9572, rcut1=5, rcut2=6)
    [shape] = kickdrift.ase.shapes(atoms, calculator)
    assert shape.pair == (0, 1) and shape.bond.startswith("O0-H1:morse:")
    terms = shape.bond.split(":")[2].split(",")[:2]
    depth, a = (float(term.split("=")[1].split("kJ")[0].split("/")[0]) for term in terms)
    # Rest is where differences over 2e-4 nm say.
    assert (depth, a) == (pytest.approx(DEPTH, rel=1e-3), pytest.approx(A, rel=1e-3)) and shape.misfit < 1e-3
    whole = kd.aperture(f"OH:morse:D={DEPTH}kJ/mol,a={A}/nm,15.999,1.008", steps=[1.65, 1.8, 1.95])
    near = kd.aperture(shape.bond, steps=[1.65, 1.8, 1.95])
    # A rung or two, or a tenth: other last digits tell some chaotic orbits otherwise.
    for ours, theirs in zip(near.column("aperture"), whole.column("aperture"), strict=True):
        assert abs(ours - theirs) <= max(0.5, 0.1 * theirs)
