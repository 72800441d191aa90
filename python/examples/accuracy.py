# %% [markdown]
# # Stable, safe, accurate: ten bonds at four steps
# Each bond has its usual wavenumber and, as a Morse bond, its usual energy. For each step the table has R, the bias of
# velocity Verlet, or `unstable`, and E\*, the energy in kT from which on a Morse bond is lost at 298 K.

# %%
import math

import pandas as pd

import kickdrift as kd

# Wavenumber in 1/cm, bond energy in kJ/mol, masses in amu.
BONDS = {
    "O-H": (3650, 463, 15.999, 1.008),
    "N-H": (3450, 391, 14.007, 1.008),
    "C-H, aromatic": (3100, 413, 12.011, 1.008),
    "C-H, alkyl": (2980, 413, 12.011, 1.008),
    "S-H": (2600, 363, 32.06, 1.008),
    "C≡N": (2260, 891, 12.011, 14.007),
    "C=O": (1750, 743, 12.011, 15.999),
    "C=C": (1680, 614, 12.011, 12.011),
    "C-C": (1200, 348, 12.011, 12.011),
}
STEPS = ["0.5", "1", "2", "4"]
LIGHT = 2.99792458e-5  # cm/fs


def morse(wavenumber, energy, *masses):
    """The bond in the words of `kickdrift aperture`: a² = k/(2 D), k = μ (2π c w)²."""
    mass = math.prod(masses) / sum(masses)
    stiffness = 1e6 * mass * (2 * math.pi * LIGHT * wavenumber) ** 2  # kJ/mol/nm^2
    steepness = math.sqrt(stiffness / (2 * energy))
    return f"bond:morse:D={energy}kJ/mol,a={steepness:.4f}/nm,{masses[0]},{masses[1]}"


shapes = {name: (f"{bond[0]}/cm", morse(*bond)) for name, bond in BONDS.items()}
# The O-H bond of q-TIP4P/F water in its Morse form.
shapes["O-H, q-TIP4P/F"] = ("8.5836fs", "bond:morse:D=485.72kJ/mol,a=22.87/nm,15.999,1.008")

# %%
rows = {}
for name, (period, shape) in shapes.items():
    steps = [[f"{step}fs"] for step in STEPS]
    advice = kd.advise({"bond": period}, steps=steps, harmonic=True, levers=False)
    aperture = kd.aperture(shape, steps=[f"{step}fs" for step in STEPS])
    rows[name] = {"T (fs)": f"{advice.data['modes'][0]['period']['lo']:.2f}"}
    for step, linear, hot in zip(STEPS, advice.data["rows"], aperture.data["steps"], strict=True):
        bias, energy = linear["bias"], hot["aperture"]
        told = "unstable" if bias is None else f"{bias['lo']:.3f}"
        rows[name][f"R, {step} fs"] = told
        rows[name][f"E*, {step} fs"] = "> 40" if energy is None else f"{energy:g}"
pd.DataFrame(rows).T
