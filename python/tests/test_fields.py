"""The fields of the library's questions, as the program declares them, and the parameters of the functions here."""

from __future__ import annotations

import inspect
import json
import subprocess
import sys
from collections.abc import Callable
from typing import Any

import kickdrift as kd
import kickdrift.dask
from kickdrift import System

#: What asks each question.
ASKED: dict[str, list[Callable[..., Any]]] = {
    "verdict": [kd.decide],
    "map": [kd.map, kickdrift.dask.map],
    "tongues": [kd.tongues],
    "curves": [kd.curves],
    "compare": [kd.compare],
    "compare-methods": [kd.compare],
    "proposition": [kd.proposition],
    "half": [kd.half],
    "closings": [kd.closings],
    "survey": [kickdrift.dask.survey],
    "bands": [kd.bands],
    "word": [kd.word],
    "methods": [kd.methods],
    "family": [kd.family],
    "system": [System.decide, System.nearest, System.intervals, System.scan],
    "simulate": [kd.simulate],
    "advise": [kd.advise, System.advise],
    "aperture": [kd.aperture],
}

#: Questions that Python does not ask: a half period as polynomials, words against the claims of a file.
NOT_ASKED = {"polynomial", "word-check"}

#: The fields that hold a system, which is an object here.
SYSTEM = {"file", "title", "system"}

#: Fields whose parameters have other names, as a range that is named by its number.
RENAMED = {
    "h1_range": "h1",
    "h2_range": "h2",
    "rho_range": "rho",
    "h_range": "h",
    "h2_step": "h_step",
    "step1": "step",
    "step2": "step",
    "shard": "store",
    "form": "staggered",
    "width": "resolution",
    "nearest": "resolution",
    "intervals": "outer",
    "period": "periods",
    "bond": "bonds",
    "no_levers": "levers",
    "scan_x": "over",
    "scan_y": "over",
}

#: Fields of one question whose parameters have other names: ``bonds`` of advice are the bonds themselves.
OF_ONE = {("advise", "bonds"): "bond_count"}

#: Fields without a parameter: spacings of curves belong to a scene's grid, the width of thin tongues is the program's
#: default.
WITHOUT = {
    ("curves", "step1"),
    ("curves", "step2"),
    ("survey", "thinnest"),
}


def fields() -> dict[str, list[str]]:
    """The fields of every question by its name, as `kickdrift mcp` lists them."""
    line = json.dumps({"jsonrpc": "2.0", "id": 1, "method": "tools/list"})
    told = subprocess.run(
        [sys.executable, "-P", "-m", "kickdrift", "mcp"],
        input=line + "\n",
        capture_output=True,
        text=True,
        check=True,
    )
    tools = json.loads(told.stdout)["result"]["tools"]
    return {tool["name"]: list(tool["inputSchema"]["properties"]) for tool in tools}


def test_every_field_of_a_question_has_a_parameter() -> None:
    missing = []
    asked = fields()
    for name, every in asked.items():
        functions = ASKED.get(name, [])
        if not functions and name not in NOT_ASKED:
            missing.append(name)
            continue
        has = {parameter for function in functions for parameter in inspect.signature(function).parameters}
        has |= SYSTEM if has & {"self", "system"} else set()
        lacks = [field for field in every if not has & _parameters(name, field)]
        missing += [f"{name}: {field}" for field in lacks if functions and (name, field) not in WITHOUT]
    assert not missing
    # What is listed above is there.
    assert set(ASKED) | NOT_ASKED == set(asked)
    assert {field for every in asked.values() for field in every} >= {*RENAMED, *(field for _, field in WITHOUT)}
    assert all(field in asked[name] for name, field in OF_ONE)


def _parameters(name: str, field: str) -> set[str]:
    """Whose values a field may have."""
    of_one = OF_ONE.get((name, field))
    return {of_one} if of_one else {field, RENAMED.get(field, field)}
