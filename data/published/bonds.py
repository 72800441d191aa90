"""Hot bonds in runs of OpenMM itself: are they lost where their aperture says so?

A droplet of 27 flexible waters, SPC/Fw, its O-H bonds with one curvature at rest, that of q-TIP4P/F, and three shapes: harmonic, Morse,
quartic. 298 K, friction 1/ps or none, on the Reference platform, which computes in doubles.

* One clock: three schemes, eighteen steps. A run ends where a bond is lost: off its length by more than 1 nm, or no number.
* Several clocks: bonds and angles every half fs or less, the rest each outer step. What is seen is the drift of the energy.

    python data/published/bonds.py > data/published/bonds.json

takes about half an hour on one core, with kickdrift and OpenMM installed. With the file's name behind it the predictions alone are made anew,
and stand beside the runs of the file.
"""

import json
import math
import sys
from itertools import product
from pathlib import Path

import numpy as np
import openmm as mm
from openmm import unit

import kickdrift

ROOM, FRICTION, LENGTH, FAR = 298.0, 1.0, 50.0, 1.0
"""K; 1/ps; ps; nm."""
STARTS = 5
"""Thermal starts; cases of one or several clocks take the first, bonds that are made hot all of them in turn."""
STEPS = [1.2, 1.3, 1.4, 1.45, 1.5, 1.55, 1.6, 1.65, 1.7, 1.75, 1.8, 1.85, 1.9, 1.95, 2.0, 2.2, 2.4, 2.6]
"""Of one clock, fs."""
SCHEMES = {"constant energy": "velocity-verlet", "OBABO": "obabo", "LangevinMiddle": "baoab"}
"""Each with its name in kickdrift's catalogue."""
SEVERAL = {
    ("harmonic", 0.0): [2.0, 2.15, 2.5, 2.85, 3.2, 4.3],
    ("harmonic", 1.0): [2.85, 4.3],
    ("quartic", 0.0): [2.0, 2.15, 2.25, 2.3, 2.35, 2.4, 2.7, 2.95, 3.05, 3.1, 3.5, 4.55],
    ("quartic", 1.0): [3.05, 3.1, 4.55],
}
"""Outer steps by shape and friction, fs: about T/4, T/3 and T/2 of the period, which neighbours make longer for quartic bonds."""
INNER, LONG = 0.5, 20.0
"""The longest inner step, fs; the length of a run of several clocks, ps."""

HOT, HOT_STEPS = (15, 20, 25), [1.2, 1.23, 1.245, 1.26, 1.3, 1.4, 1.42, 1.45, 1.5, 1.55, 1.6]
"""kT; fs: bonds that are made hot."""
HOT_LENGTH, PHASES = 2.0, 2
"""ps; how many phases of each bond."""

DEPTH, NARROW, REST_PERIOD = 485.72, 22.87, 8.5836
"""kJ/mol, 1/nm; fs."""
SHAPES = {
    "harmonic": "D*y^2",
    "Morse": "D*(1-exp(-y))^2",
    "quartic": "D*(y^2-y^3+7/12*y^4)",
}
BONDS = {
    "harmonic": f"OH:K={DEPTH * NARROW**2!r}kJ/mol/nm^2,15.999,1.008",
    "Morse": f"OH:morse:D={DEPTH}kJ/mol,a={NARROW}/nm,15.999,1.008",
    "quartic": f"OH:poly:k2={DEPTH * NARROW**2!r}kJ/mol/nm^2,k3={-DEPTH * NARROW**3!r}kJ/mol/nm^3,"
    f"k4={DEPTH * NARROW**4 * 7 / 12!r}kJ/mol/nm^4,15.999,1.008",
}
WATERS, REST, ANGLE, BEND = 27, 0.1012, math.radians(113.24), 75.90 * 4.184
"""How many; nm; rad; kJ/mol/rad^2: SPC/Fw."""
PAIRS = [[3 * n, 3 * n + m] for n in range(WATERS) for m in (1, 2)]


def droplet(shape):
    """The waters on three by three by three places, each turned somehow; bonds and angles in group 0."""
    own, around = mm.System(), np.random.default_rng(5)
    bond = mm.CustomBondForce(f"{SHAPES[shape]}; y=a*(r-r0); D={DEPTH}; a={NARROW}; r0={REST}")
    angle, pair = mm.HarmonicAngleForce(), mm.NonbondedForce()
    places = []
    for n in range(WATERS):
        for mass, charge, depth in ((15.999, -0.82, 0.1554253 * 4.184), (1.008, 0.41, 0.0), (1.008, 0.41, 0.0)):
            own.addParticle(mass)
            pair.addParticle(charge, 0.3165492, depth)
        oxygen, first, second = range(3 * n, 3 * n + 3)
        bond.addBond(oxygen, first)
        bond.addBond(oxygen, second)
        angle.addAngle(first, oxygen, second, ANGLE, BEND)
        for atoms in ((oxygen, first), (oxygen, second), (first, second)):
            pair.addException(*atoms, 0.0, 1.0, 0.0)
        frame = np.linalg.qr(around.normal(size=(3, 3)))[0]
        sides = [REST * np.array([math.cos(s * ANGLE / 2), math.sin(s * ANGLE / 2), 0.0]) for s in (1, -1)]
        at = 0.31 * np.array([n % 3, n // 3 % 3, n // 9])
        places += [at, at + frame @ sides[0], at + frame @ sides[1]]
    for force, group in ((bond, 0), (angle, 0), (pair, 1)):
        force.setForceGroup(group)
        own.addForce(force)
    return own, np.array(places)


def context_of(system, integrator):
    return mm.Context(system, integrator, mm.Platform.getPlatformByName("Reference"))


def prepared(shape):
    """The system, starts of 298 K each 5 ps after the other, and the periods of the bonds at a minimum, fs."""
    system, places = droplet(shape)
    integrator = mm.LangevinMiddleIntegrator(ROOM, FRICTION, 0.0005)
    integrator.setRandomNumberSeed(11)
    context = context_of(system, integrator)
    context.setPositions(places)
    mm.LocalEnergyMinimizer.minimize(context, 0.01)
    context.setVelocitiesToTemperature(ROOM, 3)
    integrator.step(20000)
    starts = []
    for _ in range(STARTS):
        integrator.step(10000)
        starts.append(context.getState(getPositions=True).getPositions(asNumpy=True)._value)
    mm.LocalEnergyMinimizer.minimize(context, 0.01)
    at = context.getState(getPositions=True).getPositions(asNumpy=True)._value
    return system, starts, sorted(period(context, at, *pair) for pair in PAIRS)


def period(context, at, oxygen, hydrogen):
    """2 pi over the frequency of one stretch alone, all else at rest."""
    along = (at[hydrogen] - at[oxygen]) / np.linalg.norm(at[hydrogen] - at[oxygen])
    total, by = 15.999 + 1.008, 2e-4
    energies = []
    for side in (-by, 0.0, by):
        moved = at.copy()
        moved[oxygen] -= side * 1.008 / total * along
        moved[hydrogen] += side * 15.999 / total * along
        context.setPositions(moved)
        energies.append(context.getState(getEnergy=True).getPotentialEnergy()._value)
    curvature = (energies[0] - 2 * energies[1] + energies[2]) / by**2
    return 2e3 * math.pi * math.sqrt(15.999 * 1.008 / total / curvature)


def integrator_of(scheme, step):
    if scheme == "constant energy":
        return mm.VerletIntegrator(step)
    if scheme == "LangevinMiddle":
        return mm.LangevinMiddleIntegrator(ROOM, FRICTION, step)
    own = mm.CustomIntegrator(step)
    own.addGlobalVariable("keep", math.exp(-FRICTION * step / 2))
    own.addGlobalVariable("noise", math.sqrt(unit.MOLAR_GAS_CONSTANT_R._value * 1e-3 * ROOM))
    own.addUpdateContextState()
    for letter in "OBABO":
        if letter == "O":
            own.addComputePerDof("v", "keep*v+sqrt((1-keep^2)/m)*noise*gaussian")
        elif letter == "B":
            own.addComputePerDof("v", "v+0.5*dt*f/m")
        else:
            own.addComputePerDof("x", "x+dt*v")
    return own


def started(system, positions, integrator, seed):
    """A context with thermal velocities; of the leapfrog integrator half a kick earlier."""
    if not isinstance(integrator, mm.VerletIntegrator | mm.MTSIntegrator):
        integrator.setRandomNumberSeed(seed)
    context = context_of(system, integrator)
    context.setPositions(positions)
    context.setVelocitiesToTemperature(ROOM, seed)
    if isinstance(integrator, mm.VerletIntegrator):
        state = context.getState(getVelocities=True, getForces=True)
        masses = np.array([system.getParticleMass(n)._value for n in range(3 * WATERS)])[:, None]
        back = 0.5 * integrator.getStepSize()._value * state.getForces(asNumpy=True)._value / masses
        context.setVelocities(state.getVelocities(asNumpy=True)._value - back)
    return context


def first_lost(system, positions, scheme, step, seed):
    """When a bond is lost, ps; None within LENGTH."""
    integrator = integrator_of(scheme, step / 1000)
    context = started(system, positions, integrator, seed)
    return until_lost(context, step, LENGTH)


def until_lost(context, step, length):
    """When a bond is lost, ps; None within the length."""
    every = max(1, round(50 / step))
    for done in range(0, round(length * 1000 / step), every):
        try:
            context.getIntegrator().step(every)
            at = context.getState(getPositions=True).getPositions(asNumpy=True)._value
        except mm.OpenMMException:
            at = np.full((3 * WATERS, 3), math.nan)
        lengths = np.linalg.norm(at[[b for _, b in PAIRS]] - at[[a for a, _ in PAIRS]], axis=1)
        if not (np.abs(lengths - REST) <= FAR).all():
            return round((done + every) * step / 1000, 2)
    return None


def drifted(system, positions, outer, friction, seed):
    """Of several clocks: the drift of the energy, kT an atom and ns; when the droplet was twice as hot, ps; kinetic energy over kT."""
    count = math.ceil(outer / INNER)
    groups = [(1, 1), (0, count)]
    step = outer / 1000
    integrator = mm.MTSLangevinIntegrator(ROOM, FRICTION, step, groups) if friction else mm.MTSIntegrator(step, groups)
    context = started(system, positions, integrator, seed)
    kt = unit.MOLAR_GAS_CONSTANT_R._value * 1e-3 * ROOM
    every, times, totals, kinetic = max(1, round(100 / outer)), [], [], []
    for done in range(0, round(LONG * 1000 / outer), every):
        try:
            integrator.step(every)
            state = context.getState(getEnergy=True)
            now = state.getKineticEnergy()._value / (4.5 * WATERS * kt), state.getPotentialEnergy()._value
        except mm.OpenMMException:
            now = math.nan, math.nan
        times.append((done + every) * step)
        kinetic.append(now[0])
        totals.append((now[0] * 4.5 * WATERS * kt + now[1]) / kt)
        if not kinetic[-1] < 2:
            return {"drift": None, "hot": round(times[-1], 2), "kinetic": None}
    drift = np.polyfit(times, totals, 1)[0] * 1000 / (3 * WATERS)
    return {"drift": round(float(drift), 2), "hot": None, "kinetic": round(float(np.mean(kinetic)), 3)}


def runs():
    """Everything that is seen."""
    told = {"openmm": mm.version.version, "temperature": ROOM, "friction": FRICTION, "length": LENGTH, "long": LONG}
    made = {shape: prepared(shape) for shape in SHAPES}
    told["periods"] = {shape: [round(value, 3) for value in periods] for shape, (_, _, periods) in made.items()}
    told["one"] = [one(made, *case) for case in product(SHAPES, SCHEMES, STEPS)]
    return told | {"hot": hot(made), "several": several(made)}


def one(made, shape, scheme, step):
    system, starts, _ = made[shape]
    lost = first_lost(system, starts[0], scheme, step, 100)
    print(shape, scheme, step, lost, file=sys.stderr, flush=True)
    return {"shape": shape, "scheme": scheme, "step": step, "lost": lost}


def made_hot(system, positions, energy, step, pair, phase):
    """When a bond of this energy in kT, in the droplet at 298 K and without a thermostat, is lost, ps; None within HOT_LENGTH."""
    context = started(system, positions, integrator_of("constant energy", step / 1000), 100)
    (oxygen, hydrogen), total = pair, 15.999 + 1.008
    mass, kt = 15.999 * 1.008 / total, unit.MOLAR_GAS_CONSTANT_R._value * 1e-3 * ROOM
    curvature = 2 * DEPTH * NARROW**2
    amplitude = math.sqrt(2 * energy * kt / curvature)
    along = positions[hydrogen] - positions[oxygen]
    length = np.linalg.norm(along)
    along = along / length
    more = REST + amplitude * math.cos(phase) - length
    at = np.array(positions)
    velocity = context.getState(getVelocities=True).getVelocities(asNumpy=True)._value
    faster = amplitude * math.sqrt(curvature / mass) * math.sin(phase) - (velocity[hydrogen] - velocity[oxygen]) @ along
    for own, share in ((hydrogen, 15.999 / total), (oxygen, -1.008 / total)):
        at[own] += share * more * along
        velocity[own] += share * faster * along
    context.setPositions(at)
    context.setVelocities(velocity)
    return until_lost(context, step, HOT_LENGTH)


def hot(made):
    """Of bonds that are made hot, each once in each phase: when they are lost."""
    found = []
    system, starts, _ = made["quartic"]
    for step in HOT_STEPS:
        for energy in HOT:
            lost = [
                made_hot(system, starts[n % STARTS], energy, step, pair, math.tau * (n + (m + 0.5) / PHASES) / 54)
                for n, pair in enumerate(PAIRS)
                for m in range(PHASES)
            ]
            found.append({"step": step, "energy": energy, "runs": len(lost), "lost": sorted(t for t in lost if t is not None)})
            print(json.dumps(found[-1]), file=sys.stderr, flush=True)
    return found


def several(made):
    """Several clocks: each shape, with friction and without."""
    found = []
    for (shape, friction), steps in SEVERAL.items():
        system, starts, _ = made[shape]
        for outer in steps:
            seen = drifted(system, starts[0], outer, friction, 7)
            found.append({"shape": shape, "friction": friction, "outer": outer} | seen)
            print(json.dumps(found[-1]), file=sys.stderr, flush=True)
    return found


def predicted(told):
    """E* at each step of one clock for the bond at rest, and the least over the periods that neighbours give, kT; None above 40."""
    for shape, bond in BONDS.items():
        if shape == "harmonic":
            continue
        for scheme, method in SCHEMES.items():
            asked = kickdrift.aperture(bond, method=method, h_range=(1, 2.6), step="0.01fs")
            known = {round(100 * row["h"]): row["aperture"] for row in asked}
            for row in told["one"]:
                if (row["shape"], row["scheme"]) == (shape, scheme):
                    step = round(100 * row["step"])
                    longest = told["periods"][shape][-1]
                    band = [known[n] for n in range(round(step * REST_PERIOD / longest), step + 1)]
                    row["aperture"] = known[step]
                    row["least"] = min((own for own in band if own is not None), default=None)
    return told


def written(told):
    """A line for each row."""
    parts = []
    for name, value in told.items():
        if isinstance(value, list):
            value = "[\n" + ",\n".join("  " + json.dumps(row) for row in value) + "\n ]"
        else:
            value = json.dumps(value)
        parts.append(f' "{name}": {value}')
    return "{\n" + ",\n".join(parts) + "\n}"


if __name__ == "__main__":
    print(written(predicted(json.loads(Path(sys.argv[1]).read_text()) if len(sys.argv) > 1 else runs())))
