"""What droplets of flexible water cost: their sparse Hessians, the verdict with margin and first unstable step.

Weak springs hold each atom where it is, as in an equilibration: so the place is a minimum, and the verdict has a
margin.

Run, from python/, with a release build installed:  python tests/bench/droplets.py 500 2000 [0.5nm] [droplets.svg]

A length is the cutoff of the slow forces. The name of a picture, last, has the seconds of processors drawn over the
degrees of freedom.
"""

from __future__ import annotations

import resource
import sys
import time
from fractions import Fraction

import matplotlib.pyplot as plt
import numpy as np
import openmm as mm
from openmm import app, unit

import kickdrift.openmm as ko

#: Molecules a nm³, the cutoff in nm unless another is given, kJ/mol/nm.
DENSITY, CUTOFF, REST = 33.0, 0.9, 1.0
#: kJ/mol/nm², and the outer steps in ps: stable, and above the first resonance.
SPRING, STEPS = 2000.0, ("1/250", "0.004424")


def droplet(count: int, cutoff: float = CUTOFF) -> tuple[mm.System, np.ndarray]:
    """So many waters next to the middle of a box, cooled and at rest but for what single precision leaves."""
    field = app.ForceField("amber14/tip3pfb.xml")
    modeller = app.Modeller(app.Topology(), [])
    edge = 1.6 * (count / DENSITY) ** (1 / 3) + 1
    modeller.addSolvent(field, boxSize=mm.Vec3(edge, edge, edge) * unit.nanometer)
    positions = np.array(modeller.positions.value_in_unit(unit.nanometer))
    residues = list(modeller.topology.residues())
    first = np.array([next(residue.atoms()).index for residue in residues])
    away = np.linalg.norm(positions[first] - positions.mean(axis=0), axis=1)
    modeller.delete([residues[n] for n in np.argsort(away)[count:]])
    system = field.createSystem(
        modeller.topology,
        nonbondedMethod=app.CutoffNonPeriodic,
        nonbondedCutoff=cutoff,
        switchDistance=cutoff - 0.1,
        rigidWater=False,
        removeCMMotion=False,
    )
    for force in system.getForces():
        force.setForceGroup(int(isinstance(force, mm.NonbondedForce)))
    integrator = mm.LangevinMiddleIntegrator(150, 5, 0.0005)
    context = mm.Context(system, integrator, mm.Platform.getPlatformByName("CPU"))
    context.setPositions(modeller.positions)
    mm.LocalEnergyMinimizer.minimize(context, 10 * REST)
    for temperature in (150, 60, 10):
        integrator.setTemperature(temperature)
        integrator.step(500)
    mm.LocalEnergyMinimizer.minimize(context, REST)
    return system, np.array(context.getState(getPositions=True).getPositions(asNumpy=True)._value)


def draw(path: str, sizes: list[int], seconds: list[float]) -> None:
    """The cost of a verdict over n, both by their logarithms, beside powers of n."""
    figure, axes = plt.subplots(figsize=(4.6, 3.4), layout="constrained")
    axes.loglog(sizes, seconds, "o-", color="black", label="verdict, margin, first unstable step")
    for power, style in ((1.5, "--"), (2, ":")):
        line = [seconds[0] * (n / sizes[0]) ** power for n in sizes]
        axes.loglog(sizes, line, style, color="grey", label=f"$n^{{{power}}}$")
    axes.set(xlabel="degrees of freedom n", ylabel="time of processors (s)", title="Droplets of flexible water")
    axes.legend(frameon=False)
    figure.savefig(path, metadata={"Date": None} if path.endswith(".svg") else None)


def main() -> None:
    """Print a line for each number of waters."""
    counts = [int(word) for word in sys.argv[1:] if word.isdigit()]
    cutoff = next((float(word[:-2]) for word in sys.argv[1:] if word.endswith("nm")), CUTOFF)
    seconds = []
    for count in counts:
        system, positions = droplet(count, cutoff)
        held = mm.CustomExternalForce(f"{SPRING / 2}*((x-x0)^2+(y-y0)^2+(z-z0)^2)")
        for name in ("x0", "y0", "z0"):
            held.addPerParticleParameter(name)
        for atom, place in enumerate(positions):
            held.addParticle(atom, place)
        held.setForceGroup(1)
        system.addForce(held)
        for outer in STEPS:
            steps = {0: Fraction(outer) / 16, 1: Fraction(outer)}
            times = [(time.perf_counter(), time.process_time())]
            droplet_system = ko.system(system, positions, steps=steps, sparse=True, minimize=False)
            times.append((time.perf_counter(), time.process_time()))
            found = droplet_system.decide(budget=10**15)
            times.append((time.perf_counter(), time.process_time()))
            (made, _), (decided, processor) = np.diff(times, axis=0)
            peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
            if outer == STEPS[0]:
                seconds.append(processor)
            print(f"{count} waters, {outer} ps: Hessians {made:.1f} s, answer {decided:.1f} s", end=" ")
            print(f"({processor:.1f} s of processors), at most {peak:.1f} GB")
            print("\n".join(f"  {line}" for line in str(found).splitlines()), flush=True)
    if sys.argv[-1].endswith((".svg", ".pdf", ".png")):
        draw(sys.argv[-1], [9 * count for count in counts], seconds)


if __name__ == "__main__":
    main()
