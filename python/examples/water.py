# %% [markdown]
# # Is 5 fs safe for flexible water?
# Bonds and angles each 0.5 fs, everything else each outer step: OpenMM's own multiple-time-step integrator.

# %%
from pathlib import Path

import numpy as np
from openmm import HarmonicAngleForce, HarmonicBondForce, app, unit

import kickdrift.openmm

pdb = app.PDBFile(str(Path(app.__file__).parent / "data" / "tip3p.pdb"))
modeller = app.Modeller(pdb.topology, pdb.positions)
residues = list(modeller.topology.residues())
modeller.delete(residues[4:])
field = app.ForceField("amber14-all.xml", "amber14/tip3pfb.xml")
modeller.topology.setPeriodicBoxVectors(None)
system = field.createSystem(modeller.topology, rigidWater=False, removeCMMotion=False)
for force in system.getForces():
    force.setForceGroup(0 if isinstance(force, HarmonicBondForce | HarmonicAngleForce) else 1)

# %% [markdown]
# About the minimum the verdict is proven, for all Hessians within the error that was measured.

# %%
five = kickdrift.openmm.system(system, modeller.positions, steps={0: "1/2000", 1: 5 * unit.femtoseconds}).decide()
print(five)

# %% [markdown]
# Which step to take instead, and why:

# %%
kickdrift.openmm.system(system, modeller.positions, steps={0: "1/2000", 1: "1/250"}).advise()

# %% [markdown]
# What a run shows is the neighbourhood of the integrator's own periodic orbit. Its growth rates, beside those about the
# minimum:

# %%
import matplotlib.pyplot as plt

outer = np.array(["4", "4.3", "4.4", "4.5", "4.6", "4.7", "4.8", "5"])
rates = {}
for about in ("minimum", "orbit"):
    rates[about] = [
        kickdrift.openmm.oscillations(
            system, modeller.positions, steps={0: f"{h}/10000", 1: f"{h}/1000"}, about=about
        ).growth_rate
        for h in outer
    ]
    plt.plot(outer.astype(float), rates[about], "o-", label=f"about the {about}")
plt.xlabel("outer step (fs)")
plt.ylabel("growth rate (1/ps)")
plt.legend()

# %% [markdown]
# 5 fs may lie in a window of stability above the first unstable step: that is no advice. Periods move with temperature
# and surroundings, so a step is safe below the first unstable one, with a margin.

# %%
five.measured["first_unstable"], five.measured["above_unstable"]
