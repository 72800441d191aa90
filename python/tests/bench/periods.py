"""Typical fastest periods, as `fast=protein,h-bonds` names them: molecules of OpenMM, at a minimum of their energy.

Of each molecule the shortest period of all its forces and that of the bonded ones alone, whichever is shorter:
free, with bonds to hydrogen held,
with hydrogens of 3.024 amu, and with both. Hessians by central differences of forces on OpenMM's Reference platform.

Run:  python tests/bench/periods.py [water | amino | villin | dna | lipid] ...
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import openmm as mm
from openmm import app, unit

DATA = Path(app.__file__).parent / "data"
STEP = 1e-4  # nm: the error of a central difference is near 1e-7 of the Hessian here.
HEAVY = 3.024  # amu
AMINO = [
    *("ALA", "ARG", "ASN", "ASP", "CYS", "GLN", "GLU", "GLY", "HID", "HIE", "HIP"),
    *("ILE", "LEU", "LYS", "MET", "PHE", "PRO", "SER", "THR", "TRP", "TYR", "VAL"),
]


def hessian(context: mm.Context, x: np.ndarray) -> np.ndarray:
    """Of the potential at x, in kJ/mol/nm^2."""

    def force(at: np.ndarray) -> np.ndarray:
        context.setPositions(at.reshape(-1, 3))
        return np.asarray(context.getState(getForces=True).getForces(asNumpy=True)._value).ravel()

    flat = x.ravel()
    rows = np.empty((flat.size, flat.size))
    for i in range(flat.size):
        moved = np.zeros_like(flat)
        moved[i] = STEP
        rows[i] = (force(flat - moved) - force(flat + moved)) / (2 * STEP)
    return (rows + rows.T) / 2


def shortest(k: np.ndarray, masses: np.ndarray, x: np.ndarray, held: list[tuple[int, int]]) -> tuple[float, str]:
    """The shortest period in fs of what is free, and the atom that moves most in it."""
    root = 1 / np.sqrt(np.repeat(masses, 3))
    weighted = k * root[:, None] * root
    if held:
        along = np.zeros((len(held), x.size))
        for n, (i, j) in enumerate(held):
            along[n, 3 * i : 3 * i + 3] = x[i] - x[j]
            along[n, 3 * j : 3 * j + 3] = x[j] - x[i]
        basis, _ = np.linalg.qr((along * root).T)
        free = np.eye(x.size) - basis @ basis.T
        weighted = free @ weighted @ free
    squares, modes = np.linalg.eigh(weighted)
    moving = (modes[:, -1].reshape(-1, 3) ** 2).sum(axis=1)
    return 2 * np.pi / np.sqrt(squares[-1]) * 1000, str(np.argsort(moving)[::-1][:3].tolist())


def minimum(system: mm.System, x: np.ndarray, warm: bool = False) -> np.ndarray:
    context = mm.Context(system, mm.LangevinMiddleIntegrator(600, 10, 0.0005), mm.Platform.getPlatformByName("CPU"))
    context.setPositions(x)
    mm.LocalEnergyMinimizer.minimize(context, 10, 20000)
    if warm:
        context.setVelocitiesToTemperature(600, 1)
        context.getIntegrator().step(2000)
    mm.LocalEnergyMinimizer.minimize(context, 1e-2, 50000)
    return np.asarray(context.getState(getPositions=True).getPositions(asNumpy=True)._value)


def bonds_with_hydrogen(topology: app.Topology) -> list[tuple[int, int]]:
    pairs = [(a, b) for a, b in topology.bonds()]
    return [(a.index, b.index) for a, b in pairs if "H" in (a.element.symbol, b.element.symbol)]


def heavier(masses: np.ndarray, held: list[tuple[int, int]]) -> np.ndarray:
    new = masses.copy()
    for i, j in held:
        h, other = (i, j) if masses[i] < masses[j] else (j, i)
        new[other] -= HEAVY - masses[h]
        new[h] = HEAVY
    return new


def from_nowhere(field: app.ForceField, topology: app.Topology) -> np.ndarray:
    """The lowest of eight minima from random places: in a higher one a bond may thread a ring."""
    system = field.createSystem(topology, nonbondedMethod=app.NoCutoff, constraints=None, removeCMMotion=False)
    context = mm.Context(system, mm.VerletIntegrator(0.001), mm.Platform.getPlatformByName("Reference"))
    found = []
    for seed in range(8):
        x = np.random.default_rng(seed).normal(size=(topology.getNumAtoms(), 3)) * 0.4
        x = minimum(system, x, warm=True)
        context.setPositions(x)
        found.append((context.getState(getEnergy=True).getPotentialEnergy()._value, x))
    return min(found, key=lambda pair: pair[0])[1]


def measured(name: str, field: app.ForceField, topology: app.Topology, x: np.ndarray) -> None:
    cutoff = app.NoCutoff
    free = {"constraints": None, "rigidWater": False, "removeCMMotion": False}
    system = field.createSystem(topology, nonbondedMethod=cutoff, **free)
    x = minimum(system, x)
    bonded = mm.XmlSerializer.clone(system)
    slow = [n for n, force in enumerate(bonded.getForces()) if "onbonded" in type(force).__name__]
    for n in reversed(slow):
        bonded.removeForce(n)
    masses = np.array([system.getParticleMass(i)._value for i in range(system.getNumParticles())])
    held = bonds_with_hydrogen(topology)
    both = []
    for each in (system, bonded):
        context = mm.Context(each, mm.VerletIntegrator(0.001), mm.Platform.getPlatformByName("Reference"))
        both.append(hessian(context, x))
    shown = []
    atoms = list(topology.atoms())
    for way, m, pairs in [
        ("free", masses, []),
        ("h-bonds", masses, held),
        ("hmr3", heavier(masses, held), []),
        ("h-bonds,hmr3", heavier(masses, held), held),
    ]:
        period, who = min((shortest(k, m, x, pairs) for k in both), key=lambda one: one[0])
        first = [atoms[int(i)].residue.name + "." + atoms[int(i)].name for i in who.strip("[]").split(",")]
        shown.append(f"{way} {period:.2f} ({' '.join(first)})")
    print(f"{name:28} {len(masses):5} atoms  " + ";  ".join(shown), flush=True)


def chained(field: app.ForceField, names: list[str]) -> app.Topology:
    """Residues one after the other, atoms and bonds by their templates."""
    topology = app.Topology()
    chain = topology.addChain()
    before = None
    for name in names:
        template = field._templates[name]
        residue = topology.addResidue(name, chain)
        atoms = [topology.addAtom(atom.name, atom.element, residue) for atom in template.atoms]
        for a, b in template.bonds:
            topology.addBond(atoms[a], atoms[b])
        by = {atom.name: atom for atom in atoms}
        ends = ("N", "C") if "P" not in by and "O3'" not in by else ("P", "O3'")
        if before is not None:
            topology.addBond(before, by[ends[0]])
        before = by.get(ends[1])
    return topology


def water() -> None:
    pdb = app.PDBFile(str(DATA / "tip3p.pdb"))
    x = np.asarray(pdb.getPositions(asNumpy=True)._value)
    first = x[::3]
    near = np.argsort(np.linalg.norm(first - first.mean(axis=0), axis=1))[:64]
    modeller = app.Modeller(pdb.topology, pdb.positions)
    gone = [r for r in pdb.topology.residues() if r.index not in set(near.tolist())]
    modeller.delete(gone)
    places = [p.value_in_unit(unit.nanometer) for p in modeller.positions]
    x = np.asarray([[c._value if hasattr(c, "_value") else c for c in place] for place in places])
    fields = ["amber14/tip3pfb.xml", "amber14/tip3p.xml", "amber14/spce.xml", "charmm36/water.xml"]
    for name in fields:
        field = app.ForceField(name)
        measured(f"64 waters, {name}", field, modeller.topology, x)
        cutoff = app.NoCutoff
        system = field.createSystem(modeller.topology, nonbondedMethod=cutoff, rigidWater=True, removeCMMotion=False)
        still = minimum(system, x)
        pairs = [system.getConstraintParameters(n)[:2] for n in range(system.getNumConstraints())]
        masses = np.array([system.getParticleMass(i)._value for i in range(system.getNumParticles())])
        context = mm.Context(system, mm.VerletIntegrator(0.001), mm.Platform.getPlatformByName("Reference"))
        for way, at in [("at a minimum", still), ("at 300 K", hot(system, still))]:
            period, _ = shortest(hessian(context, at), masses, at, pairs)
            print(f"64 rigid waters, {name} {way}: {period:.2f}", flush=True)


def hot(system: mm.System, x: np.ndarray) -> np.ndarray:
    integrator = mm.LangevinMiddleIntegrator(300, 10, 0.001)
    context = mm.Context(system, integrator, mm.Platform.getPlatformByName("CPU"))
    context.setPositions(x)
    context.setVelocitiesToTemperature(300, 1)
    integrator.step(5000)
    return np.asarray(context.getState(getPositions=True).getPositions(asNumpy=True)._value)


def amino() -> None:
    field = app.ForceField("amber14/protein.ff14SB.xml")
    for name in AMINO:
        topology = chained(field, ["ACE", name, "NME"])
        measured(f"ACE-{name}-NME amber14", field, topology, from_nowhere(field, topology))


def villin() -> None:
    pdb = app.PDBFile(str(DATA / "test.pdb"))
    modeller = app.Modeller(pdb.topology, pdb.positions)
    modeller.delete([r for r in pdb.topology.residues() if r.name in ("HOH", "Cl", "CL")])
    x = np.asarray(modeller.positions.value_in_unit(unit.nanometer))
    for file in ["amber14/protein.ff14SB.xml", "charmm36.xml"]:
        measured(f"villin {file[:8]}", app.ForceField(file), modeller.topology, x)


def dna() -> None:
    for file in ["amber14/DNA.OL15.xml", "amber14/RNA.OL3.xml"]:
        field = app.ForceField(file)
        names = ["DA5", "DC", "DG", "DT3"] if "DNA" in file else ["A5", "C", "G", "U3"]
        topology = chained(field, names)
        measured(f"{'-'.join(names)} {file[8:]}", field, topology, from_nowhere(field, topology))


def lipid() -> None:
    for name in ["POPC", "DPPC"]:
        pdb = app.PDBFile(str(DATA / f"{name}.pdb"))
        modeller = app.Modeller(pdb.topology, pdb.positions)
        first = next(r for r in pdb.topology.residues() if r.name != "HOH")
        modeller.delete([r for r in pdb.topology.residues() if r != first])
        x = np.asarray(modeller.positions.value_in_unit(unit.nanometer))
        for file in ["amber14/lipid17.xml", "charmm36.xml"]:
            try:
                measured(f"{name} {file}", app.ForceField(file), modeller.topology, x)
            except Exception as error:
                print(name, file, "skipped:", str(error)[:100], flush=True)


if __name__ == "__main__":
    known = {"water": water, "amino": amino, "villin": villin, "dna": dna, "lipid": lipid}
    for which in sys.argv[1:] or known:
        known[which]()
