"""What advice on a peptide in water costs: alanine dipeptide in boxes of flexible water with PME, nm an edge.

Run, from python/, with a release build installed:  python tests/bench/solvated.py 3 5.9
"""

from __future__ import annotations

import importlib.util
import resource
import sys
import time
from pathlib import Path

import openmm as mm
from openmm import app, unit

import kickdrift as kd

RUNS = Path(__file__).resolve().parents[3] / "data" / "published" / "runs.py"


def solvated(edge: float) -> tuple[mm.System, app.Modeller]:
    """Bonded forces in group 0, all others in group 1."""
    spec = importlib.util.spec_from_file_location("runs", RUNS)
    assert spec is not None and spec.loader is not None
    runs = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(runs)
    _, topology, positions = runs.dipeptide()
    field = app.ForceField("amber14-all.xml", "amber14/tip3pfb.xml")
    modeller = app.Modeller(topology, positions * unit.nanometer)
    modeller.addSolvent(field, boxSize=mm.Vec3(edge, edge, edge) * unit.nanometer)
    system = field.createSystem(
        modeller.topology,
        nonbondedMethod=app.PME,
        nonbondedCutoff=min(1.0, 0.45 * edge) * unit.nanometer,
        rigidWater=False,
        removeCMMotion=False,
    )
    for force in system.getForces():
        force.setForceGroup(1 if isinstance(force, mm.NonbondedForce) else 0)
    return system, modeller


def main() -> None:
    for edge in map(float, sys.argv[1:]):
        system, made = solvated(edge)
        for changed in ({}, {"constraints": "h-bonds", "hmr": "3.024"}):
            begin = time.perf_counter()
            steps = {0: "0.5fs", 1: "4fs"}
            given = {"positions": made.positions, "topology": made.topology, "steps": steps, "levers": False}
            advice = kd.advise(system, **given, **changed)
            taken, used = time.perf_counter() - begin, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
            print(f"{system.getNumParticles()} atoms {changed}: {taken:.1f} s, {used:.2f} GB")
            print(*[line for line in str(advice).splitlines() if line.startswith(("  looked", "advice"))], sep="\n")


if __name__ == "__main__":
    main()
