# %% [markdown]
# # How much energy does a bond hold at a stable step?
# A droplet of 27 flexible waters at 298 K. Its O-H bonds are harmonic, with the curvature of q-TIP4P/F water and a
# period of 8.58 fs. Two Langevin schemes differ only in where the thermostat acts: OBABO beside the kicks,
# LangevinMiddle in the middle of the drift.

# %%
from pathlib import Path

import numpy as np
import pandas as pd
from openmm import (
    Context,
    CustomExternalForce,
    CustomIntegrator,
    HarmonicBondForce,
    LangevinMiddleIntegrator,
    LocalEnergyMinimizer,
    Platform,
    app,
    unit,
)

STIFFNESS = 2 * 254049.483068  # kJ/mol/nm^2
REDUCED_MASS = 15.999 * 1.008 / (15.999 + 1.008)  # amu
KELVIN, FRICTION = 298.0, 1.0  # 1/ps
HALF_KT = 0.5 * 8.31446261815324e-3 * KELVIN  # kJ/mol
PERIOD = 2e3 * np.pi * np.sqrt(REDUCED_MASS / STIFFNESS)  # fs

# %% [markdown]
# The droplet: the waters of OpenMM's box nearest to its middle, and a wall that keeps them together.

# %%
pdb = app.PDBFile(str(Path(app.__file__).parent / "data" / "tip3p.pdb"))
modeller = app.Modeller(pdb.topology, pdb.positions)
modeller.topology.setPeriodicBoxVectors(None)
positions = np.array(modeller.positions.value_in_unit(unit.nanometer))
residues = list(modeller.topology.residues())
oxygens = np.array([next(residue.atoms()).index for residue in residues])
far = np.linalg.norm(positions[oxygens] - positions.mean(axis=0), axis=1)
modeller.delete([residues[i] for i in np.argsort(far)[27:]])
system = app.ForceField("amber14-all.xml", "amber14/tip3pfb.xml").createSystem(
    modeller.topology, rigidWater=False, removeCMMotion=False
)
for force in system.getForces():
    if isinstance(force, HarmonicBondForce):
        force.setForceGroup(1)
        bonds = force.getNumBonds()
        for i in range(bonds):
            first, second, length, _ = force.getBondParameters(i)
            force.setBondParameters(i, first, second, length, STIFFNESS)
wall = CustomExternalForce("50*max(0, sqrt(x^2 + y^2 + z^2) - 0.8)^2")
for i in range(system.getNumParticles()):
    wall.addParticle(i)
system.addForce(wall)


def obabo(step):
    """Half a thermostat, velocity Verlet, half a thermostat; the step in ps."""
    scheme = CustomIntegrator(step)
    scheme.addGlobalVariable("keep", np.exp(-0.5 * FRICTION * step))
    scheme.addGlobalVariable("kT", 2 * HALF_KT)
    thermostat = "keep*v + sqrt((1 - keep^2)*kT/m)*gaussian"
    scheme.addUpdateContextState()
    scheme.addComputePerDof("v", thermostat)
    scheme.addComputePerDof("v", "v + 0.5*dt*f/m")
    scheme.addComputePerDof("x", "x + dt*v")
    scheme.addComputePerDof("v", "v + 0.5*dt*f/m")
    scheme.addComputePerDof("v", thermostat)
    scheme.setRandomNumberSeed(7)
    return scheme


def middle(step):
    """LangevinMiddle of OpenMM; the step in ps."""
    scheme = LangevinMiddleIntegrator(KELVIN, FRICTION, step)
    scheme.setRandomNumberSeed(7)
    return scheme


def energy(scheme, step, length):
    """The energy of a bond over kT/2, and its standard error from 20 blocks; the step in fs, the length in ps."""
    context = Context(system, scheme(1e-3 * step), Platform.getPlatformByName("Reference"))
    start = np.array(modeller.positions.value_in_unit(unit.nanometer))
    context.setPositions(start - start.mean(axis=0))
    LocalEnergyMinimizer.minimize(context)
    context.setVelocitiesToTemperature(KELVIN, 7)
    run = context.getIntegrator().step
    run(round(10e3 / step))
    samples = []
    for _ in range(round(1e3 * length / (5 * step))):
        run(5)
        samples.append(context.getState(getEnergy=True, groups={1}).getPotentialEnergy()._value)
    blocks = [block.mean() for block in np.array_split(np.array(samples) / (bonds * HALF_KT), 20)]
    return np.mean(blocks), np.std(blocks, ddof=1) / np.sqrt(len(blocks))


# %% [markdown]
# Neighbours stretch the bonds a little, whatever the step. A run at 0.25 fs has only this static part above 1. It is
# taken off.

# %%
LENGTH = 20.0  # ps
base, base_error = energy(middle, 0.25, LENGTH / 2)
rows = []
for step in (1.0, 1.8, 2.2):
    row = {"step (fs)": step, "R at the kicks": f"{1 / (1 - (np.pi * step / PERIOD) ** 2):.3f}"}
    for name, scheme in {"OBABO": obabo, "LangevinMiddle": middle}.items():
        mean, error = energy(scheme, step, LENGTH)
        row[name] = f"{mean - base + 1:.3f} ± {np.hypot(error, base_error):.3f}"
    rows.append(row)

# %%
pd.DataFrame(rows).set_index("step (fs)")
