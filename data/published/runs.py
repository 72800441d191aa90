"""Predictions beside runs of OpenMM itself: does a run blow up where it is said to?

Two systems, twelve outer steps each, MTSIntegrator with bonds and angles inside, the rest outside. Predicted about the minimum by
``kickdrift.openmm.system``, and about the integrator's own orbit by ``kickdrift.openmm.oscillations``. Run on the
Reference platform, which computes in doubles, without a thermostat, with velocities of 1 K: so small that what grows is what linear theory
speaks of. One run begins at the minimum, and one on the orbit.

    python data/published/runs.py > data/published/runs.json

takes some ten minutes on one core, with kickdrift and OpenMM installed. With the file's name behind it the predictions alone are made anew, some
three minutes, and stand beside the runs of the file.
"""

import json
import sys
from fractions import Fraction
from pathlib import Path

import numpy as np
import openmm as mm
from openmm import app, unit

import kickdrift.openmm as ko

ROOT = Path(__file__).resolve().parent.parent
INNER = Fraction(1, 2)
"""The longest inner step, fs."""
TEMPERATURE, LENGTH, BLOWN = 1.0, 60.0, 300.0
"""K; ps; K: a run has blown up where its energy above the minimum is that of harmonic oscillators at this temperature."""


def grouped(system):
    """Bonds and angles in group 0, the rest in group 1."""
    for force in system.getForces():
        force.setForceGroup(0 if isinstance(force, (mm.HarmonicBondForce, mm.HarmonicAngleForce)) else 1)
    return system


def waters(count=27):
    """Neighbouring waters of OpenMM's own box, amber14 tip3pfb, flexible, in vacuum."""
    pdb = app.PDBFile(str(Path(app.__file__).parent / "data" / "tip3p.pdb"))
    every = np.array(pdb.positions.value_in_unit(unit.nanometer))
    centre = every[::3].mean(axis=0)
    near = np.argsort(np.linalg.norm(every[::3] - centre, axis=1))[:count]
    topology = app.Topology()
    chain = topology.addChain()
    for _ in near:
        residue = topology.addResidue("HOH", chain)
        atoms = [topology.addAtom(name, app.Element.getBySymbol(name[0]), residue) for name in ("O", "H1", "H2")]
        topology.addBond(atoms[0], atoms[1])
        topology.addBond(atoms[0], atoms[2])
    field = app.ForceField("amber14-all.xml", "amber14/tip3pfb.xml")
    own = field.createSystem(topology, nonbondedMethod=app.NoCutoff, rigidWater=False, removeCMMotion=False)
    return grouped(own), topology, np.concatenate([every[3 * n : 3 * n + 3] for n in near])


def dipeptide():
    """Alanine dipeptide, amber96, in vacuum, nothing held, at the positions of data/scenes/alanine-dipeptide.json."""
    labels = json.loads((ROOT / "scenes" / "alanine-dipeptide.json").read_text())["labels"]
    positions = np.load(ROOT / "hessians" / "alanine-dipeptide.npz")["positions"]
    topology = app.Topology()
    chain, residue = topology.addChain(), None
    for label in labels:
        name, kind = label.split()
        if residue is None or residue.name != kind:
            residue = topology.addResidue(kind, chain)
        topology.addAtom(name, app.Element.getBySymbol(name[0]), residue)
    topology.createStandardBonds()
    own = app.ForceField("amber96.xml").createSystem(topology, nonbondedMethod=app.NoCutoff, removeCMMotion=False)
    return grouped(own), topology, positions.reshape(-1, 3)


def steps_of(outer):
    """The steps of both groups, ps, and how many inner ones there are."""
    inner = -(-outer // INNER)
    return {0: outer / inner / 1000, 1: outer / 1000}, int(inner)


def run(system, positions, outer, inner):
    """When the molecule is hotter than BLOWN, ps, or None; and else the hottest it was, K."""
    integrator = mm.MTSIntegrator(float(outer) * unit.femtoseconds, [(1, 1), (0, inner)])
    context = mm.Context(system, integrator, mm.Platform.getPlatformByName("Reference"))
    context.setPositions(positions)
    least = energy(context)
    context.setVelocitiesToTemperature(TEMPERATURE * unit.kelvin, 1)
    kelvin = (3 * len(positions) - 6) * unit.MOLAR_GAS_CONSTANT_R.value_in_unit(unit.kilojoule_per_mole / unit.kelvin)
    hottest = 0.0
    for done in range(0, int(LENGTH * 1000 / outer), 20):
        integrator.step(20)
        now = (energy(context) - least) / kelvin
        if not now < BLOWN:
            return round((done + 20) * float(outer) / 1000, 3), None
        hottest = max(hottest, now)
    return None, round(hottest, 3)


def energy(context):
    state = context.getState(getEnergy=True)
    return (state.getPotentialEnergy() + state.getKineticEnergy()).value_in_unit(unit.kilojoule_per_mole)


def compared(name, made, outers, known=None):
    """A row for each outer step; with the rows that are known their runs, and the predictions anew."""
    system, topology, positions = made
    at = ko._minimized(ko._engine(system), positions, [], ko.DIFFERENCE)
    rows = []
    for place, text in enumerate(outers):
        outer = Fraction(text)
        steps, inner = steps_of(outer)
        verdict = ko.system(system, at, topology=topology, steps=steps, minimize=False).decide()
        row = {"outer": text, "inner_steps": inner, "minimum": {"stable": verdict.stable, "rate": verdict.growth_rate}}
        try:
            found = ko.oscillations(system, at, steps=steps, minimize=False)
            row["orbit"] = predicted(found)
        except ko.KickdriftError as error:
            row["orbit"] = {"refused": str(error)}
        if known is None:
            row["blown_up"], row["hottest"] = run(system, at, outer, inner)
            if "stable" in row["orbit"]:
                row["orbit"]["blown_up"], row["orbit"]["hottest"] = run(system, found.positions, outer, inner)
        else:
            before = known[place]
            row["orbit"] |= {key: before["orbit"][key] for key in ("blown_up", "hottest") if key in before["orbit"]}
            row |= {key: before[key] for key in ("blown_up", "hottest")}
        print(name, json.dumps(row), file=sys.stderr, flush=True)
        rows.append(row)
    return {"system": name, "atoms": len(at), "rows": rows}


def predicted(found):
    """What is said of the orbit: proven or an estimate, and for all Hessians within which accuracy."""
    bounds = found.growth_bounds
    row = {"stable": found.stable, "rate": found.growth_rate, "away": found.away, "proven": found.proven}
    accuracy = None if found.along is None else found.along.accuracy
    return row | {"accuracy": accuracy, "bounds": None if bounds is None else list(bounds)}


WATERS = "2.5 3 3.5 4 4.2 4.4 4.5 4.6 4.7 4.8 5 5.5".split()
DIPEPTIDE = "4 4.8 5 5.03 5.04 5.3 5.5 5.58 5.61 5.64 5.8 6".split()

if __name__ == "__main__":
    told = {"openmm": mm.version.version, "temperature": TEMPERATURE, "length": LENGTH, "blown": BLOWN}
    known = [None, None]
    if len(sys.argv) > 1:
        told = json.loads(Path(sys.argv[1]).read_text())
        known = [own["rows"] for own in told["systems"]]
    told["systems"] = [
        compared("27 flexible waters", waters(), WATERS, known[0]),
        compared("alanine dipeptide", dipeptide(), DIPEPTIDE, known[1]),
    ]
    print(json.dumps(told, indent=1))
