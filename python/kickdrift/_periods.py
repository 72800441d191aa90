"""Advice on periods, and what all advice is asked with."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from os import PathLike, fspath
from pathlib import Path
from typing import Any, TypeAlias

from kickdrift._advice import Advice, Engine, SystemAdvice, Time
from kickdrift._document import Asked
from kickdrift._errors import KickdriftError, shown
from kickdrift._files import text_of
from kickdrift._numbers import Exact, items, mapping_of, text, with_unit, written

Scales: TypeAlias = tuple[Exact, Time | None, Exact | None, str | None, Exact | None]
"""The band, the length of the run, friction, constraints, and the mass of hydrogens."""


def advise_periods(
    periods: Any,
    steps: str | Sequence[Any],
    engine: Engine | None,
    scales: Scales,
    *,
    bonds: Mapping[str, str] | Sequence[tuple[str, str]] | None = None,
    on: Mapping[str, int] | Sequence[tuple[str, int]] | None = None,
    temperature: Exact | None = None,
    bond_count: int | None = None,
    levers: bool = True,
    all_modes: bool = False,
    harmonic: bool = False,
) -> Advice:
    """Advice on periods, as :func:`kickdrift.advise` takes them."""
    alone = items(
        "periods",
        [periods] if isinstance(periods, str | PathLike) else periods,
        "give a list of periods in fs, or texts as '10fs'; or periods by name",
    )
    has_names = isinstance(periods, Mapping) or any(isinstance(value, list | tuple) for value in alone)
    named = mapping_of("periods", periods, _NAMED).items() if has_names else ((None, value) for value in alone)
    given: dict[str, list[str]] = {"period": [], "bond": [], "on": []}
    for name, value in named:
        if isinstance(value, PathLike) or (name is None and isinstance(value, str) and _is_file(value)):
            raise KickdriftError("periods", shown(value), _FILE)
        length = str(_time("periods", value))
        given["period"].append(length if name is None else f"{_name('periods', name)}={length}")
    bonded, clocks = mapping_of("bonds", bonds or {}, _BONDS), mapping_of("on", on or {}, _CLOCKS)
    given["bond"] = [f"{_name('bonds', name)}:{value}" for name, value in bonded.items()]
    given["on"] = [f"{_name('on', name)}={clock}" for name, clock in clocks.items()]
    hot = {"temperature": with_unit("temperature", temperature, "K"), "bonds": _count(bond_count)}
    every = given | {name: value for name, value in hot.items() if value is not None}
    question = asked(every, steps, engine, scales, levers=levers, all_modes=all_modes, harmonic=harmonic)
    try:
        return Advice(question.render("json"), question.render("text"), question.render("details"), question)
    except KickdriftError as error:
        # The program's flag --bonds is bond_count here.
        if error.field != "temperature or bonds":
            raise
        raise KickdriftError("temperature or bond_count", "given", _SHAPES) from None


def _count(bonds: int | None) -> str | None:
    if bonds is None or (isinstance(bonds, int) and not isinstance(bonds, bool)):
        return bonds if bonds is None else written("bond_count", bonds)
    raise KickdriftError("bond_count", shown(bonds), "give how many bonds the run has, as 1700")


def advise_archive(
    path: str | PathLike[str],
    steps: str | Sequence[Any],
    engine: Engine | None,
    scales: Scales,
    *,
    levers: bool = True,
    harmonic: bool = False,
) -> SystemAdvice:
    """Advice on the Hessians of an archive, whose first scheme is the system's own."""
    place = Path(path)
    given: Mapping[str, str | list[str]] = {"file": place.name}
    question = asked(given, steps, engine, scales, place=str(place.parent), levers=levers, harmonic=harmonic)
    return SystemAdvice(question.render("json"), question.render("text"), question.render("details"), ())


#: What to give in place of what is none.
_NAMED = "give periods by name, as {'OH': '10fs'}, or a list of them, as ['10fs', '40fs']"
_BONDS = (
    "give a mapping of names to bonds, as {'OH': 'k=1106kcal/mol/A^2,15.999,1.008'}; how many there are is bond_count"
)
_SHAPES = (
    "are about bonds of a known shape, and none is given: write one, as "
    "bonds={'OH': 'morse:D=485.72kJ/mol,a=22.87/nm,15.999,1.008'}"
)
_CLOCKS = "give a mapping of names to clocks, as {'OH': 1}"
_FILE = "is a file: give an engine's input as engine=, beside periods"
_STEPS = "give the steps of a scheme, the inner one first, as '0.5fs,4fs' or [0.5, 4]; of one clock '2fs' or [2]"
_INPUTS = "give the path of an input or its text, or several"


def asked(
    given: Mapping[str, str | list[str]],
    steps: str | Sequence[Any],
    engine: Engine | None,
    scales: Scales,
    place: str | Mapping[str, Any] = "",
    levers: bool = True,
    all_modes: bool = False,
    harmonic: bool = False,
) -> Asked:
    """The question about what is given, with all that any advice is asked with."""
    band, length, friction, constraints, hmr = scales
    engines = _inputs(engine)
    texts = [_text(path) for path in engines]
    rest = {
        "steps": _schemes(steps),
        "engine": texts,
        "band": band if isinstance(band, str) else text("band", band),
        "length": _time("length", length),
        "friction": friction if friction is None or isinstance(friction, str) else f"{text('friction', friction)}/ps",
        # OpenMM's own names are objects.
        "constraints": constraints if constraints is None or isinstance(constraints, str) else str(constraints),
        "hmr": hmr if hmr is None or isinstance(hmr, str) else text("hmr", hmr),
        "no_levers": None if levers else "true",
        "all_modes": "true" if all_modes else None,
        "harmonic": "true" if harmonic else None,
    }
    names = [
        f"engine{n}" if read == fspath(path) else fspath(path)
        for n, (path, read) in enumerate(zip(engines, texts, strict=True))
    ]
    every = {name: value for name, value in {**given, **rest}.items() if value}
    return Asked("advise", every, None, place, {"engine": names} if names else {})


def _inputs(engine: Engine | None) -> list[str | PathLike[str]]:
    """An engine's inputs: none, one or several."""
    if engine is None or isinstance(engine, str | PathLike):
        return [engine] if engine else []
    several = items("engine", engine, _INPUTS)
    for given in several:
        if not isinstance(given, str | PathLike):
            raise KickdriftError("engine", shown(given), _INPUTS)
    return several


def _text(engine: str | PathLike[str]) -> str:
    """An engine's input: it itself where it has several lines, or what stands in the file."""
    path = fspath(engine)
    if "\n" in path:
        return path
    # Letters in comments, which no engine reads, may be in Latin-1.
    return text_of(path, "name an engine's input", "latin-1")


def _is_file(period: str) -> bool:
    """Whether a period is the name of a file; long texts are none."""
    try:
        return Path(period).is_file()
    except (OSError, ValueError):
        return False


def _time(field: str, value: Time | None) -> str | None:
    if value is None or isinstance(value, str):
        return value and written(field, value)
    return f"{text(field, value)}fs"


def _name(field: str, name: str) -> str:
    if not name or set(name) & set("=:,"):
        raise KickdriftError(field, name, "give a name without the signs = : ,")
    return name


def _schemes(steps: str | Sequence[Any]) -> list[str]:
    """Schemes as the program reads them; one scheme may stand alone."""
    if isinstance(steps, str):
        return [written("steps", steps)]
    parts = items("steps", steps, _STEPS)
    several = bool(parts) and isinstance(parts[0], list | tuple)
    schemes = parts if several else [parts] if parts else []
    return [",".join(str(_time("steps", step)) for step in scheme) for scheme in schemes]


def listed(steps: str | Sequence[Any] | Mapping[int, Any]) -> str | Sequence[Any]:
    """Schemes that are lists; steps by force group are OpenMM's alone.

    Raises
    ------
    KickdriftError
        A mapping.
    """
    if isinstance(steps, Mapping):
        raise KickdriftError("steps", shown(steps), "steps by force group are OpenMM's: list them, the inner one first")
    return steps
