# %% [markdown]
# # Growth in OpenMM beside its prediction
# Four neighbouring waters of OpenMM's own box at their minimum, on the Reference platform.

# %%
from fractions import Fraction
from pathlib import Path

import numpy as np
import openmm as mm
import pandas as pd
from openmm import app, unit

import kickdrift.openmm

pdb = app.PDBFile(str(Path(app.__file__).parent / "data" / "tip3p.pdb"))
modeller = app.Modeller(pdb.topology, pdb.positions)
oxygens = np.array(pdb.positions.value_in_unit(unit.nanometer))[::3]
far = np.argsort(np.linalg.norm(oxygens - oxygens.mean(axis=0), axis=1))[4:]
residues = list(modeller.topology.residues())
modeller.delete([residues[n] for n in far])
modeller.topology.setPeriodicBoxVectors(None)
field = app.ForceField("amber14-all.xml", "amber14/tip3pfb.xml")
system = field.createSystem(modeller.topology, rigidWater=False, removeCMMotion=False)
for force in system.getForces():
    force.setForceGroup(0 if isinstance(force, mm.HarmonicBondForce | mm.HarmonicAngleForce) else 1)
root = np.sqrt(np.repeat([system.getParticleMass(n)._value for n in range(12)], 3))


# %% [markdown]
# The run starts beside the orbit, a billionth of a unit away along the fastest mode, and goes on until that deviation
# has grown by five decades. Where nothing is predicted to grow, it starts with a deviation in every direction and takes
# 600 outer steps.


# %%
def measured(outer, inner, found):
    """The growth rate that OpenMM's integrator shows, 1/ps."""
    values, vectors = np.linalg.eig(found.matrix)
    fastest = np.argmax(np.abs(values))
    start = np.random.default_rng(1).normal(size=len(values)) if found.stable else vectors[:, fastest].real
    start = 1e-9 * start / np.linalg.norm(start[: len(root)])
    # What is watched: the part of the deviation along the fastest mode, or along all modes but rigid motions.
    watch = np.linalg.inv(vectors)[np.abs(values - 1) > 1e-4 if found.stable else [fastest]]
    integrator = mm.MTSIntegrator(float(outer) * unit.picoseconds, [(1, 1), (0, inner)])
    context = mm.Context(system, integrator, mm.Platform.getPlatformByName("Reference"))
    context.setPositions(found.positions + (start[: len(root)] / root).reshape(-1, 3))
    context.setVelocities((start[len(root) :] / root).reshape(-1, 3))
    sizes = []
    for _ in range(600 if found.stable else 5000):
        integrator.step(1)
        state = context.getState(getPositions=True, getVelocities=True)
        moved = (state.getPositions(asNumpy=True)._value - found.positions).ravel() * root
        speed = state.getVelocities(asNumpy=True)._value.ravel() * root
        sizes.append(np.log(np.linalg.norm(watch @ np.concatenate([moved, speed]))))
        if sizes[-1] > sizes[0] + 5 * np.log(10):
            break
    return np.polyfit(np.arange(len(sizes)), sizes, 1)[0] / float(outer)


# %%
rows = []
for fs in ["2", "3", "4", "4.3", "4.4", "4.5", "4.6", "4.7", "5", "5.5", "7", "8"]:
    outer = Fraction(fs) / 1000
    inner = int(-(-outer // Fraction(1, 2000)))
    steps = {0: outer / inner, 1: outer}
    orbit = kickdrift.openmm.oscillations(system, modeller.positions, steps=steps)
    minimum = kickdrift.openmm.oscillations(system, modeller.positions, steps=steps, about="minimum")
    rows.append(
        {
            "outer step (fs)": fs,
            "inner steps": inner,
            "minimum (1/ps)": minimum.growth_rate,
            "orbit (1/ps)": orbit.growth_rate,
            "OpenMM's run (1/ps)": measured(outer, inner, orbit),
        }
    )
table = pd.DataFrame(rows).set_index("outer step (fs)").round(4) + 0.0
table
