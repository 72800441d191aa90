"""Odd arrays are answered or refused by name, and none of them ends the interpreter."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import kickdrift as kd

LOOP = np.empty(1, dtype=object)
LOOP[0] = LOOP

ODD: dict[str, Any] = {
    "empty": np.array([]),
    "0-d": np.array(0.3),
    "0-d None": np.array(None, dtype=object),
    "no stride": np.lib.stride_tricks.as_strided(np.array([0.1, 0.2]), (1000,), (0,)),
    "backwards": np.array([0.1, 0.2, 0.3])[::-1],
    "objects": np.array([0.1, "1/3"], dtype=object),
    "objects, one None": np.array([0.1, None], dtype=object),
    "arrays in an array": np.array([np.array([1, 2]), np.array([1, 2, 3])], dtype=object),
    "itself": LOOP,
    "nan": np.array([0.1, np.nan]),
    "inf": np.array([-np.inf, 0.1]),
    "negative": np.array([-0.1, 0.2]),
    "zero": np.array([0.0]),
    "masked": np.ma.array([0.1, 0.2], mask=[0, 1]),
    "none masked": np.ma.array([0.1, 0.2], mask=[0, 0]),
    "the masked constant": np.ma.masked,
    "fortran": np.asfortranarray([[0.1, 0.2], [0.3, 0.4]]),
    "float32": np.array([0.1], dtype=np.float32),
    "long double": np.array([0.1], dtype=np.longdouble),
    "other byte order": np.array([0.1]).astype(">f8"),
    "complex": np.array([0.1 + 1j]),
    "structured": np.array([(0.1, 2)], dtype=[("a", "f8"), ("b", "i4")]),
    "void": np.zeros(2, dtype="V8"),
    "dates": np.array(["2020-01-01"], dtype="M8[D]"),
    "bytes": np.array([b"1/3"]),
    "bool": np.array([True, False]),
    "uint64": np.array([2**64 - 1], dtype=np.uint64),
    "subnormal": np.array([5e-324]),
    "largest": np.array([1.7e308]),
    "five axes": np.full((1, 1, 1, 1, 2), 0.1),
    "ragged": [[0.1], [0.2, 0.3]],
    "dict": {},
    "none": None,
    "half a surrogate": "\ud800",
    "many digits": 10**5000,
    "true": True,
}

IDENTITY = np.eye(6) / 100
BUDGET = 100_000


def measured(**changed: Any) -> kd.System:
    given: dict[str, Any] = {"masses": [1.0, 1.0], "fast": IDENTITY, "step": "1/2", **changed}
    potentials = {"fast": (given.pop("step"), given.pop("fast")), "slow": (2, IDENTITY / 9)}
    return kd.System.from_hessians(given.pop("masses"), given.pop("potentials", potentials), **given)


ASKED: dict[str, Callable[[Any], object]] = {
    "decide": lambda x: kd.decide(lambda1=x, lambda2=1, h1="1/10", h2="1/5", budget=BUDGET),
    "verdicts": lambda x: kd.verdicts(lambda1=x, lambda2=1, h1="1/10", h2="1/5", budget=BUDGET),
    "broadcast": lambda x: kd.verdicts(lambda1=1, lambda2=1, h1=np.ones((2, 1)), h2=x, budget=BUDGET),
    "step": lambda x: kd.map(lambda1=10, lambda2=1, step=x, h1=("1/10", "1/2"), h2=("1/10", "1/2"), budget=BUDGET),
    "range": lambda x: kd.map(lambda1=10, lambda2=1, step="1/10", h1=x, h2=("1/10", "1/2"), budget=BUDGET),
    "number": kd.number,
    "exact": kd.exact,
    "simplest": kd.simplest,
    "labels": lambda x: kd.tongues(ratio="3/2", rho="1/4", m=x),
    "half": lambda x: kd.half("3/2", s=x, rho=1),
    "bands": lambda x: kd.bands(lambda1=10, lambda2=1, h1=x, h2=("1/10", "1/2"), sectors=1000),
    "closings": lambda x: kd.closings(max_sum=x),
    "periods": lambda x: kd.advise(x, steps="0.5fs,2fs"),
    "steps": lambda x: kd.advise(["10fs", "40fs"], steps=x),
    "Hessian": lambda x: measured(fast=x).decide(),
    "masses": lambda x: measured(masses=x).decide(),
    "positions": lambda x: measured(positions=x).decide(),
    "accuracy": lambda x: measured(accuracy=x).decide(),
    "potentials": lambda x: measured(potentials=x),
    "step of a system": lambda x: measured(step=x).decide(),
    "friction": lambda x: measured().decide(friction=x),
}

# A step of 10^5000 is decided, in half a minute.
SLOW = {("decide", "many digits"), ("verdicts", "many digits"), ("broadcast", "many digits")}


@pytest.mark.parametrize("call", ASKED)
def test_what_is_odd_is_answered_or_refused_in_a_line(call: str) -> None:
    for name, value in ODD.items():
        if (call, name) in SLOW:
            continue
        try:
            ASKED[call](value)
        except kd.KickdriftError as error:
            assert error.field and "\n" not in str(error), (name, str(error))


@pytest.mark.parametrize(
    "name", ["nan", "inf", "masked", "complex", "structured", "void", "objects, one None", "itself"]
)
@pytest.mark.parametrize("call", ["verdicts", "broadcast", "Hessian", "masses", "positions"])
def test_entries_that_are_no_numbers_are_refused(call: str, name: str) -> None:
    with pytest.raises(kd.KickdriftError):
        ASKED[call](ODD[name])


def test_an_array_is_read_whatever_its_layout() -> None:
    plain = np.array([[0.1, 0.2, 0.3], [0.4, 0.5, 0.6]])
    code = kd.verdicts(lambda1=10, lambda2=1, h1=plain, h2=2, budget=BUDGET).code
    strided = np.zeros((4, 9))[::2, ::3]
    strided[:] = plain
    frozen = plain.copy()
    frozen.setflags(write=False)
    for steps in (np.asfortranarray(plain), plain[:, ::-1].copy()[:, ::-1], strided, frozen, plain.astype(">f8")):
        assert (kd.verdicts(lambda1=10, lambda2=1, h1=steps, h2=2, budget=BUDGET).code == code).all()
    odd = np.asfortranarray(IDENTITY + np.diag(np.full(5, 1e-3), 1) + np.diag(np.full(5, 1e-3), -1))
    assert measured(fast=odd).decide() == measured(fast=np.ascontiguousarray(odd)).decide()
