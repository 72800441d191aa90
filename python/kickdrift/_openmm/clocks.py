"""Integrators of OpenMM's, or steps by group, as clocks."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any

import numpy as np

from kickdrift._errors import KickdriftError
from kickdrift._numbers import Exact, duration, rational, simplest
from kickdrift._openmm import mm, unit

#: Sums whose forces have no cutoff.
EWALD = (mm.NonbondedForce.Ewald, mm.NonbondedForce.PME, mm.NonbondedForce.LJPME)


def mask_of(groups: Sequence[int]) -> int:
    """The bits by which OpenMM knows some groups."""
    return sum(1 << group for group in groups)


def levels_of(clocks: Mapping[int, Fraction]) -> dict[Fraction, list[int]]:
    """The groups of each step, the smallest first."""
    levels: dict[Fraction, list[int]] = {}
    for group, step in sorted(clocks.items(), key=lambda item: (item[1], item[0])):
        levels.setdefault(step, []).append(group)
    return levels


def clocks_of(system: Any, integrator: Any, steps: Mapping[int, Any] | None) -> dict[int, Fraction]:
    """The step of each force group, ps; all groups of the system are there."""
    if (steps is None) == (integrator is None):
        remedy = "of OpenMM give either steps={group: step} or an integrator"
        raise KickdriftError("steps", "both" if steps is not None else None, remedy)
    acting = _acting(system)
    if not acting:
        raise KickdriftError("system", "no forces", "give it forces to integrate")
    for group in steps or ():
        if not isinstance(group, int | np.integer):
            raise KickdriftError("steps", str(group), "is no number of a force group: write steps={0: ..., 1: ...}")
    if steps is None:
        clocks = clocks_of_integrator(integrator, set(acting))
    else:
        clocks = {group: duration(f"steps[{group}]", _plain(step), "ps") for group, step in steps.items()}
    missing = sorted(acting.keys() - clocks.keys())
    if missing:
        remedy = f"is never integrated ({', '.join(acting[missing[0]])}): give it a step"
        raise KickdriftError("steps", f"group {missing[0]}", remedy)
    idle = sorted(clocks.keys() - acting.keys())
    if idle and steps is not None:
        there = ", ".join(str(group) for group in sorted(acting))
        raise KickdriftError("steps", f"group {idle[0]}", f"has no force: forces are in {there}; leave its step out")
    return {group: step for group, step in clocks.items() if group in acting}


def _acting(system: Any) -> dict[int, list[str]]:
    """The names of the forces by group; the reciprocal space of an Ewald sum has one of its own where it is set."""
    acting: dict[int, list[str]] = {}
    for force in system.getForces():
        if moves_nothing(force):
            continue
        acting.setdefault(force.getForceGroup(), []).append(force.getName())
        reciprocal = getattr(force, "getReciprocalSpaceForceGroup", lambda: -1)()
        if reciprocal >= 0 and force.getNonbondedMethod() in EWALD:
            acting.setdefault(reciprocal, []).append(f"reciprocal space of {force.getName()}")
    return acting


def moves_nothing(force: Any) -> bool:
    return isinstance(force, mm.CMMotionRemover) or is_bath(force)


def is_bath(force: Any) -> bool:
    return "Barostat" in type(force).__name__ or isinstance(force, mm.AndersenThermostat)


def _plain(value: Any) -> Exact:
    """A quantity as a text in ps: its number as it prints, and the unit's factor, a power of ten or near one."""
    if not unit.is_quantity(value):
        return value
    factor = simplest(value.unit.conversion_factor_to(unit.picosecond), ulps=2)
    return f"{rational('steps', value._value) * factor}ps"


#: How OpenMM's multiple-time-step integrators write a kick of group G, N times a step.
_KICK = re.compile(r"v\+(?P<half>0?\.5\*)?\(?dt(?:/(?P<parts>\d+))?\)?\*f(?P<group>\d*)/m$")


def clocks_of_integrator(integrator: Any, groups: set[int]) -> dict[int, Fraction]:
    size = integrator.getStepSize()._value
    if not size > 0:
        remedy = "has no step of its own: give it a fixed one, or steps={group: step} instead"
        raise KickdriftError("integrator", type(integrator).__name__, remedy)
    step = simplest(size, ulps=2)
    plain = (mm.VerletIntegrator, mm.LangevinIntegrator, mm.LangevinMiddleIntegrator)
    if isinstance(integrator, plain):
        mask = integrator.getIntegrationForceGroups()
        return {group: step for group in groups if mask >> group & 1}
    clocks: dict[int, Fraction] = {}
    if isinstance(integrator, mm.CustomIntegrator):
        for number_ in range(integrator.getNumComputations()):
            _, variable, expression = integrator.getComputationStep(number_)
            found = _KICK.match(expression.replace(" ", "")) if variable == "v" else None
            if found:
                moved = [int(found["group"])] if found["group"] else sorted(groups)
                clocks |= dict.fromkeys(moved, step / int(found["parts"] or 1))
    if not clocks:
        remedy = "its steps are not known from its form: give steps={group: step} instead"
        raise KickdriftError("integrator", type(integrator).__name__, remedy)
    return clocks
