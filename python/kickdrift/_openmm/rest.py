"""Where the forces of a system of OpenMM's vanish."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from kickdrift._errors import KickdriftError
from kickdrift._held import Held
from kickdrift._hessians import Force
from kickdrift._minimum import cooled, minimum
from kickdrift._openmm import mm
from kickdrift._openmm.atoms import Constraint
from kickdrift._openmm.forces import Engine, Smooth, led_downhill
from kickdrift._progress import Progress
from kickdrift._rigid import Doubles


def near_minimum(engine: Engine, where: Doubles, held: Held, difference: float, is_small: bool) -> tuple[Doubles, str]:
    """The minimum of few atoms, or where OpenMM's minimizer ends; and in words which."""
    if is_small:
        try:
            return at_rest(engine, where, held.distances, difference)[0], "at the minimum beside the positions"
        except KickdriftError:
            # As where pairs cross a cutoff: no stiffness hangs on the last digits of a place.
            pass
    where = led_downhill(engine, where, maxIterations=_MINIMIZED)
    return where, f"at the positions after {_MINIMIZED} steps of OpenMM's minimizer at most, near a minimum, not at one"


#: Steps of OpenMM's minimizer: bonds and clashes have relaxed then, and no stiffness hangs on the rest.
_MINIMIZED = 200


def at_rest(
    engine: Engine,
    where: Doubles,
    constraints: Sequence[Constraint],
    difference: float,
    chosen: Sequence[int] | None = None,
    progress: Progress | None = None,
) -> tuple[Doubles, list[str]]:
    """The minimum in the engine's own context: the system given and its contexts stay as they are; and what to know of
    it.

    Newton's method first, since OpenMM's minimizer leaves a minimum that it is given; after the minimizer where that
    does not arrive close by. All but the chosen coordinates stand still. Forces that jump at a cutoff need
    have no minimum: then a note says so.

    Raises
    ------
    KickdriftError
        Where no minimum is found.
    """
    force, held = engine.force(-1), Held(engine.masses, constraints)
    is_boxed = engine.is_boxed and chosen is None

    def newton(near: Doubles, far: float) -> tuple[Doubles, Force]:
        reach = _REACH if engine.cuts else np.inf
        return minimum(force, near, held, difference, chosen, is_boxed, reach, far, progress)

    try:
        found, smooth = newton(where, _CLOSE)
    except (KickdriftError, mm.OpenMMException, np.linalg.LinAlgError):
        near = relaxed(engine, where, chosen)
        # A step of the minimizer may leave what bonds allow, as those of FENE, and has no way back.
        is_lost = not engine.energy(near) <= engine.energy(where)
        try:
            if is_lost:
                near = cooled(force, where, held, difference) if chosen is None else where
            try:
                found, smooth = newton(near, _CLOSE if engine.cuts and chosen is None else np.inf)
            except KickdriftError:
                # Thousands of forces, where energies that jump stopped the minimizer far from rest.
                if not engine.cuts or chosen is not None:
                    raise
                found, smooth = newton(cooled(force, near, held, difference), np.inf)
        except KickdriftError as error:
            if not engine.cuts:
                remedy = "is the lowest where the search from there ended, no minimum: give positions in nm, minimized"
                raise KickdriftError("positions", error.value, remedy) from error
            remedy = (
                f"is the least that was found, no minimum: forces jump at a cutoff; take {engine.smoother}; "
                "or minimize=False"
            )
            raise KickdriftError("positions", error.value, remedy) from error
    note = smooth.note(found) if isinstance(smooth, Smooth) else None
    return found, [note] if note else []


def relaxed(engine: Engine, where: Doubles, chosen: Sequence[int] | None) -> Doubles:
    """Where OpenMM's minimizer ends; what has no mass stands still for it."""
    context = engine.context
    if chosen is not None:
        copy = mm.XmlSerializer.clone(context.getSystem())
        still = {int(n) for n in np.delete(engine.moving, sorted({column // 3 for column in chosen}))}
        for n in still:
            copy.setParticleMass(n, 0.0)
        # Held distances to what stands still are the next step's: the minimizer knows none of massless particles.
        for n in reversed(range(copy.getNumConstraints())):
            if set(copy.getConstraintParameters(n)[:2]) & still:
                copy.removeConstraint(n)
        context = mm.Context(copy, mm.VerletIntegrator(0.001), context.getPlatform())
    return led_downhill(engine, where, context, tolerance=1e-4)


#: How far, nm, Newton's method alone may go: half a bond; and within which pairs are kept on their side of a cutoff.
_CLOSE, _REACH = 0.05, 0.04
