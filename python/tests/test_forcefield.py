"""Sparse Hessians of force fields against differences of every coordinate, and their systems against dense ones."""

from __future__ import annotations

from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np
import openmm as mm
import pytest
from openmm import app

import kickdrift as kd
import kickdrift.openmm as ko
from kickdrift import _covered, _forcefield, _lanczos, _sparse_held
from kickdrift._held import Held
from kickdrift._hessians import hessian
from kickdrift._openmm.forces import engine_of
from kickdrift._openmm.rest import at_rest

#: Bonds and angles, and what OpenMM's own pairs are, by groups.
SLOW = 1


@cache
def waters(side: int, method: str, switched: bool = False) -> tuple[mm.System, np.ndarray]:
    """Flexible waters on a grid of 0.31 nm, somewhat turned, with a cutoff of 0.43 edges' thirds."""
    field = app.ForceField("amber14/tip3pfb.xml")
    topology, places = app.Topology(), []
    topology.setUnitCellDimensions(mm.Vec3(0.31, 0.31, 0.31) * side)
    random, chain = np.random.default_rng(3), topology.addChain()
    for corner in 0.31 * np.indices((side, side, side)).reshape(3, -1).T:
        residue = topology.addResidue("HOH", chain)
        atoms = [topology.addAtom(name, app.Element.getBySymbol(name[0]), residue) for name in ("O", "H1", "H2")]
        topology.addBond(atoms[0], atoms[1])
        topology.addBond(atoms[0], atoms[2])
        first, across = (vector / np.linalg.norm(vector) for vector in random.normal(size=(2, 3)))
        second = across - across @ first * first
        second = -0.25 * first + 0.97 * second / np.linalg.norm(second)
        places += [corner, corner + 0.0957 * first, corner + 0.0957 * second]
    system = field.createSystem(
        topology,
        nonbondedMethod=getattr(app, method),
        nonbondedCutoff=0.15 * side,
        switchDistance=0.11 * side if switched else None,
        rigidWater=False,
        removeCMMotion=False,
    )
    for force in system.getForces():
        force.setForceGroup(SLOW if isinstance(force, mm.NonbondedForce) else 0)
    return system, np.array(places)


def by_differences(system: mm.System, group: int, positions: np.ndarray, columns: list[int]) -> np.ndarray:
    """Not mass-weighted, at displacements so small that few pairs cross a cutoff."""
    forces = [force for force in system.getForces() if force.getForceGroup() == group]
    force = _forcefield._alone(system, forces)
    return hessian(force, positions, np.ones(len(positions)), 2e-6, columns)[0]


@pytest.mark.parametrize(
    ("method", "switched"),
    [("NoCutoff", False), ("CutoffNonPeriodic", False), ("CutoffNonPeriodic", True), ("CutoffPeriodic", True)],
)
def test_pairs_have_the_second_derivatives_that_differences_show(method: str, switched: bool) -> None:
    system, positions = waters(3, method, switched)
    matrix, error = _forcefield.hessian(system, [SLOW], positions, 1e-5)
    columns = list(range(0, positions.size, 5))
    measured = by_differences(system, SLOW, positions, columns)
    formulas = matrix.toarray()[np.ix_(columns, columns)]
    # Forces of some 1e4 kJ/mol/nm are rounded at 1e-12 of themselves, the differences are 4e-6 wide.
    assert np.abs(formulas - measured).max() < 0.02 and np.abs(measured).max() > 1e4
    assert np.abs(matrix - matrix.T).max() < 1e-9 * np.abs(measured).max()
    assert error < 1e-3, "what the formulas leave out would be seen"
    assert matrix.nnz < 0.9 * positions.size**2 or method != "CutoffNonPeriodic"


def peptide() -> tuple[mm.System, np.ndarray]:
    """A chain of eight atoms with bonds, angles, both kinds of torsions, a map of two torsions and scaled pairs."""
    system, random = mm.System(), np.random.default_rng(5)
    bonds, angles, periodic, rb = (
        mm.HarmonicBondForce(),
        mm.HarmonicAngleForce(),
        mm.PeriodicTorsionForce(),
        mm.RBTorsionForce(),
    )
    cmap, pairs = mm.CMAPTorsionForce(), mm.NonbondedForce()
    cmap.addMap(8, (10 * random.normal(size=64)).tolist())
    for n in range(8):
        system.addParticle(12.0)
        pairs.addParticle(0.3 * (-1) ** n, 0.3, 0.4)
    for n in range(7):
        bonds.addBond(n, n + 1, 0.15, 2e5)
    for n in range(6):
        angles.addAngle(n, n + 1, n + 2, 1.9, 400.0)
    for n in range(5):
        periodic.addTorsion(n, n + 1, n + 2, n + 3, 3, 0.3, 5.0)
        rb.addTorsion(n, n + 1, n + 2, n + 3, 1.0, 2.0, -1.0, 0.5, 0.2, 0.1)
    cmap.addTorsion(0, 0, 1, 2, 3, 1, 2, 3, 4)
    pairs.createExceptionsFromBonds([(n, n + 1) for n in range(7)], 0.8, 0.5)
    for force in (bonds, angles, periodic, rb, cmap, pairs):
        system.addForce(force)
    pairs.setForceGroup(SLOW)
    turns = 0.1 * np.arange(8)[:, None] * [1.2, 0.3, 0.2]
    return system, turns + 0.03 * random.normal(size=(8, 3))


def test_a_few_differences_give_the_hessian_of_all_bonded_terms() -> None:
    system, positions = peptide()
    every = list(range(positions.size))
    for group in (0, SLOW):
        matrix, error = _forcefield.hessian(system, [group], positions, 1e-5)
        force = _forcefield._alone(system, [each for each in system.getForces() if each.getForceGroup() == group])
        measured, rough = hessian(force, positions, np.ones(8), 1e-5, every)
        assert np.linalg.norm(matrix.toarray() - measured, 2) <= error + rough < 1e-3 * np.abs(measured).max()


def test_bonded_terms_have_the_second_derivatives_that_differences_show() -> None:
    system, positions = peptide()
    for force in system.getForces():
        if type(force).__name__ not in _forcefield._terms_of.LAWS:
            continue
        matrix = _forcefield.by_formulas([force], positions)
        near = _forcefield._neighbours(_forcefield._terms(force), 8)
        measured, _ = _forcefield.coloured(_forcefield._alone(system, [force]), positions, near, 2e-5)
        # Fourth-order differences of torsions at 2e-5 of 0.1 nm leave 1e-13 of them, rounding of forces over 2e-5 more.
        assert abs(matrix - measured).max() < 1e-8 * abs(measured).max() and abs(measured).max() > 100
        assert abs(matrix - matrix.T).max() < 1e-12 * abs(measured).max()


def test_a_term_without_second_derivatives_is_left_to_differences() -> None:
    """A straight angle at its rest: the formula divides by the sine."""
    system, angles = mm.System(), mm.HarmonicAngleForce()
    for _ in range(3):
        system.addParticle(12.0)
    angles.addAngle(0, 1, 2, np.pi, 400.0)
    system.addForce(angles)
    straight = np.outer([0.0, 0.15, 0.3], [1.0, 0, 0])
    assert not np.isfinite(_forcefield.by_formulas([angles], straight).data).all()
    matrix, error = _forcefield.hessian(system, [0], straight, 1e-5)
    # Across the line 400 (2/0.15)² at its middle, along it nothing.
    assert matrix[4, 4] == pytest.approx(400 * (2 / 0.15) ** 2, rel=1e-3) and abs(matrix[3, 3]) < 1e-3 * matrix[4, 4]
    assert np.isfinite(error)


def strand(count: int) -> tuple[Any, Held, np.ndarray]:
    """A zigzag of carbons, each with a hydrogen at a held distance: the mass-weighted stiffness of bonds and angles."""
    random = np.random.default_rng(2)
    heavy = np.column_stack([0.12 * np.arange(count), 0.05 * (np.arange(count) % 2), 0.01 * random.normal(size=count)])
    light = heavy + [0.0, 0.05, 0.09]
    where, masses = np.concatenate([heavy, light]), np.repeat([12.0, 1.0], count)
    bonds, angles = mm.HarmonicBondForce(), mm.HarmonicAngleForce()
    for n in range(count - 1):
        bonds.addBond(n, n + 1, 0.13, 2e5 * (1 + 0.2 * random.random()))
        angles.addAngle(count + n, n, n + 1, 1.9, 400.0)
    for n in range(count):
        bonds.addBond(n, count + n, 0.1, 3e5)
    held = Held(masses, [(n, count + n, float(np.linalg.norm(where[n] - where[count + n]))) for n in range(count)])
    return _sparse_held.weighted(_forcefield.by_formulas([bonds, angles], where), held.root), held, where


@pytest.mark.parametrize("whole", [400, 60, 30])
def test_windows_bracket_the_stiffest_mode_of_a_chain(whole: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(_covered, "WHOLE", whole)
    matrix, held, where = strand(80)
    free = _covered.projected(matrix, held, where)
    frame = held.frame(where)
    exact = np.linalg.eigvalsh(frame.T @ matrix.toarray() @ frame)
    found = _covered.modes(free, ["C"] * 160)
    assert found is not None and found.molecules == 1 and (found.windows == 0) == (whole == 400)
    assert found.largest <= exact[-1] * (1 + 1e-12) and exact[-1] <= found.largest + found.beyond
    # By so little that advice is not shortened; without windows rounding alone is between them.
    assert found.beyond < {400: 1e-10, 60: 0.05, 30: 0.2}[whole] * exact[-1], found.beyond / exact[-1]
    # Modes that two windows see in parts are counted once.
    stretches = int((exact > exact[-1] / 4).sum())
    assert abs(found.count(exact[-1] / 4, 2 * exact[-1]) - stretches) <= (0 if whole == 400 else 0.05 * stretches)
    assert found.count(-np.inf, np.inf) == matrix.shape[0]
    # What is held vibrates no more: without the projection it is stiffer by far.
    assert np.linalg.eigvalsh(matrix.toarray())[-1] > 2 * exact[-1]


def test_windows_too_thin_to_bound_anything_are_not_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(_covered, "WHOLE", 8)
    matrix, held, where = strand(30)
    assert _covered.modes(_covered.projected(matrix, held, where), ["C"] * 60) is None
    monkeypatch.setattr(_covered, "_JOINED", 0)
    assert _covered.projected(matrix, held, where) is None


def test_all_modes_of_all_molecules_are_those_of_the_dense_matrix() -> None:
    """27 waters, each turned otherwise, bonds and angles away from rest."""
    system, positions = waters(3, "NoCutoff")
    positions = positions + 1e-3 * np.random.default_rng(1).normal(size=positions.shape)
    matrix, _ = _forcefield.hessian(system, [0], positions, 1e-5)
    weighted = _sparse_held.weighted(matrix, np.sqrt(np.repeat([15.99943, 1.007947, 1.007947] * 27, 3)))
    found = _covered.modes(weighted, ["O", "H", "H"] * 27)
    exact = np.linalg.eigvalsh(weighted.toarray())
    assert found is not None and found.molecules == 27
    assert np.abs(np.sort(found.values) - exact).max() < 1e-11 * exact[-1]
    (shown,) = found.shown.values()
    assert shown.count == 27 and shown.values[-1] == pytest.approx(exact[-1], rel=1e-12)


def test_the_evaluations_do_not_grow_with_the_number_of_molecules() -> None:
    counts = []
    for side in (2, 4):
        system, positions = waters(side, "CutoffNonPeriodic")
        bonded = [force for force in system.getForces() if force.getForceGroup() == 0]
        alone, asked = _forcefield._alone(system, bonded), []

        def counted(at: np.ndarray, alone: Any = alone, asked: list[int] = asked) -> np.ndarray:
            asked.append(1)
            return alone(at)

        terms = [
            atoms
            for force in bonded
            if type(force).__name__ in _forcefield._BONDED
            for atoms in _forcefield._terms(force)
        ]
        near = _forcefield._neighbours(terms, len(positions))
        for atoms in _forcefield._colours(near):
            # Every atom is a neighbour of one of a colour at most.
            assert near[atoms].sum(axis=0).max() == 1
        _forcefield.coloured(counted, positions, near, 1e-5)
        counts.append(len(asked))
    assert counts == [36, 36]


#: nm: reduced, as OpenMM wants them.
SKEW = [[0.93, 0, 0], [0.1, 0.97, 0], [-0.3, 0.25, 0.95]]


def own_pairs(given: mm.NonbondedForce, cutoff: float) -> mm.CustomNonbondedForce:
    """Screened charges and Lennard-Jones as a force of one's own, cut off at once."""
    custom = mm.CustomNonbondedForce("138.9*q1*q2*exp(-r)/r + 4*sqrt(e1*e2)*(s^12 - s^6); s = 0.5*(s1+s2)/r")
    for name in "qse":
        custom.addPerParticleParameter(name)
    for n in range(given.getNumParticles()):
        custom.addParticle(given.getParticleParameters(n))
    for n in range(given.getNumExceptions()):
        custom.addExclusion(*given.getExceptionParameters(n)[:2])
    custom.setNonbondedMethod(custom.CutoffPeriodic)
    custom.setCutoffDistance(cutoff)
    custom.setForceGroup(SLOW)
    return custom


@pytest.mark.parametrize(
    ("method", "switched", "box"),
    [
        ("CutoffNonPeriodic", False, None),
        ("CutoffPeriodic", True, None),
        ("CutoffPeriodic", False, SKEW),
        ("Ewald", False, None),
        ("PME", True, SKEW),
        ("LJPME", False, None),
        ("LJPME", True, None),
        # Two oxygens stand at the cutoff there: OpenMM leaves the switching function out.
        ("LJPME", True, SKEW),
        ("LJPME", False, SKEW),
        ("custom", False, None),
        ("custom", False, SKEW),
    ],
)
def test_pairs_that_cross_the_cutoff_stay_on_their_side(
    method: str, switched: bool, box: list[list[float]] | None
) -> None:
    """Before: a pair that a difference takes across the cutoff leaves its force, over the step, as stiffness."""
    system, positions = waters(3, "CutoffPeriodic" if method == "custom" else method, switched)
    system = mm.XmlSerializer.clone(system)
    if method == "custom":
        place = [isinstance(force, mm.NonbondedForce) for force in system.getForces()].index(True)
        # A pair at the cutoff, along the axis of a column.
        apart = positions[3:] - positions[0]
        r = np.linalg.norm(apart, axis=1)
        chosen = np.argmax(np.where((r > 0.3) & (r < 0.42), np.abs(apart[:, 0]) / r, 0.0))
        system.addForce(own_pairs(system.getForce(place), float(r[chosen]) + 2e-5))
        system.removeForce(place)
    if box is not None:
        system.setDefaultPeriodicBoxVectors(*[mm.Vec3(*edge) for edge in box])
    engine, columns = engine_of(system), list(range(0, positions.size, 6))
    force = engine.force(1 << SLOW)
    raw, before = hessian(lambda at: force(at), positions, engine.masses, ko.DIFFERENCE, columns)
    found, after = hessian(force, positions, engine.masses, ko.DIFFERENCE, columns)
    # So near that no pair crosses; forces in doubles of 1e4 kJ/mol/nm leave some 1e-8 over this step.
    true, _ = hessian(force, positions, engine.masses, ko.DIFFERENCE / 100, columns)
    size = np.linalg.norm(true, 2)
    assert np.linalg.norm(raw - true, 2) > 0.01 * size and before > 0.01 * size
    assert np.linalg.norm(found - true, 2) < 1e-7 * size and after < 1e-5 * size


@pytest.mark.parametrize("box", [np.diag([2.0, 2.2, 2.5]), np.array([[2.5, 0, 0], [0.4, 2.4, 0], [-1.0, 0.9, 2.2]])])
def test_pairs_of_a_shell_are_those_of_nearest_images(box: np.ndarray) -> None:
    where = np.random.default_rng(0).uniform(-3, 3, size=(200, 3))
    apart = where[:, None] - where
    for k in (2, 1, 0):
        apart = apart - np.round(apart[..., k] / box[k, k])[..., None] * box[k]
    far = np.linalg.norm(apart, axis=-1)
    i, j = np.where((far > 0.7) & (far < 0.9))
    exact = np.array([(a, b) for a, b in zip(i, j, strict=True) if a < b])
    assert len(exact) > 1000 and (_forcefield._shell(where, box, 0.7, 0.9) == exact).all()


def test_a_product_with_all_atoms_moved_sees_no_cutoff_either() -> None:
    system, positions = waters(3, "CutoffPeriodic")
    engine = engine_of(system)
    force, held = engine.force(1 << SLOW), Held(engine.masses)
    vector = np.random.default_rng(2).normal(size=positions.size)
    exact = _sparse_held.weighted(_forcefield.hessian(system, [SLOW], positions, 1e-5)[0], held.root) @ vector
    off = [
        np.linalg.norm(_lanczos.by_differences(given, positions, held.root, ko.WIDE)(vector) - exact)
        for given in (force, lambda at: force(at))
    ]
    # Second-order differences of 0.001 nm leave 1e-4 of a stiffness that turns within 0.1 nm.
    assert off[0] < 1e-3 * np.linalg.norm(exact) < 0.05 * off[1]


def test_sparse_and_dense_systems_have_one_first_unstable_step() -> None:
    system, positions = waters(2, "NoCutoff")
    steps = {0: "0.5fs", SLOW: "4fs"}
    where = at_rest(engine_of(system), positions, [], ko.DIFFERENCE)[0]
    both = [ko.system(system, where, steps=steps, sparse=sparse, minimize=False).decide() for sparse in (True, False)]
    assert all(verdict.stable for verdict in both)
    first, same = (verdict.data["measured"]["first_unstable"] for verdict in both)
    # The dense step is enclosed in 1e-7 of itself, each for Hessians known to 1e-6.
    assert first["lo"] <= same["hi"] * (1 + 1e-5) and same["lo"] <= first["hi"] * (1 + 1e-5), (first, same)


def test_what_the_minimizer_leaves_is_told() -> None:
    system, positions = waters(2, "CutoffNonPeriodic")
    steps = {0: "0.5fs", SLOW: "4fs"}
    found = ko.system(system, positions, steps=steps, sparse=True)
    assert any("are no minimum of all forces" in note for note in found.notes)
    assert any("do not vanish at the positions" in note for note in found.notes)
    assert found.decide().data["measured"]["rigid_motions"]["count"] == 6


def test_sparse_systems_take_the_names_of_a_topology() -> None:
    system, positions = peptide()
    topology = app.Topology()
    residue = topology.addResidue("PEP", topology.addChain())
    atoms = [topology.addAtom(f"C{n}", app.element.carbon, residue) for n in range(8)]
    for near, far in pairwise(atoms):
        topology.addBond(near, far)
    steps = {0: "0.5fs", SLOW: "2fs"}
    found = ko.system(system, positions, steps=steps, topology=topology, sparse=True, minimize=False)
    # At no minimum a third of the slow stiffness turns with the forces: rotations are not clearly free.
    with pytest.raises(kd.KickdriftError, match="rigid motions"):
        found.decide()
    assert found.document["labels"][7] == "C7 PEP 1" and found.document["bonded"][0] == [0, 1]


@pytest.mark.parametrize(
    ("make", "value"),
    [
        (lambda: box_of("PME"), "an Ewald sum"),
        (lambda: custom(), "CustomNonbondedForce"),
        (lambda: held(), "1 constraints"),
        (lambda: offset(), "offsets of parameters"),
    ],
)
def test_what_has_no_sparse_hessian_is_refused_by_name(make: Any, value: str) -> None:
    system, positions = make()
    with pytest.raises(kd.KickdriftError) as caught:
        ko.system(system, positions, steps={0: "0.5fs", SLOW: "2fs"}, sparse=True, minimize=False)
    assert caught.value.value == value and caught.value.remedy


def box_of(method: str) -> tuple[mm.System, np.ndarray]:
    return waters(3, method)


def custom() -> tuple[mm.System, np.ndarray]:
    system, positions = peptide()
    force = mm.CustomNonbondedForce("1e-6/r^6")
    for _ in range(8):
        force.addParticle([])
    force.setForceGroup(SLOW)
    system.addForce(force)
    return system, positions


def held() -> tuple[mm.System, np.ndarray]:
    system, positions = peptide()
    system.addConstraint(0, 1, float(np.linalg.norm(positions[0] - positions[1])))
    return system, positions


def offset() -> tuple[mm.System, np.ndarray]:
    system, positions = peptide()
    pairs = next(force for force in system.getForces() if isinstance(force, mm.NonbondedForce))
    pairs.addGlobalParameter("scale", 0.5)
    return system, positions
