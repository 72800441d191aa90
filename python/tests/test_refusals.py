"""Whatever is given in place of what belongs there, the error is ours; what is not about a value stays what it is."""

from __future__ import annotations

import inspect
import time
from collections.abc import Callable
from decimal import Decimal
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

import kickdrift as kd


class Ratio:
    """A number by its ratio alone."""

    def __init__(self, give: Callable[[], Any]) -> None:
        self.give = give

    def as_integer_ratio(self) -> Any:
        return self.give()

    def __repr__(self) -> str:
        return "Ratio()"


def raising(error: BaseException) -> Callable[[], Any]:
    def give() -> Any:
        raise error

    return give


@pytest.mark.parametrize("ratio", [(1, 0), (0, 0), (1,), (1, 2, 3), (0.5, 2), "12", None, (None, 1)])
def test_a_ratio_that_is_none_is_refused_and_named(ratio: object) -> None:
    with pytest.raises(kd.KickdriftError, match="as_integer_ratio") as told:
        kd.number(Ratio(lambda: ratio))
    assert (told.value.field, told.value.value) == ("number", "Ratio()")


def test_a_ratio_of_a_negative_denominator_is_a_number() -> None:
    assert kd.number(Ratio(lambda: (3, -6))).fraction == Fraction(-1, 2)


@pytest.mark.parametrize("error", [KeyboardInterrupt(), MemoryError(), RuntimeError("mine"), SystemExit(3)])
def test_what_is_raised_by_a_value_is_not_taken_for_a_value(error: BaseException) -> None:
    class Numerator:
        @property
        def numerator(self) -> int:
            raise error

    class Shown:
        def __repr__(self) -> str:
            raise error

    for value in (Ratio(raising(error)), Numerator(), *([] if isinstance(error, RuntimeError) else [Shown()])):
        with pytest.raises(type(error)):
            kd.decide(lambda1=value, lambda2=0, h1=1, h2=1)
        with pytest.raises(type(error)):
            kd.verdicts(lambda1=[1, value], lambda2=0, h1=1, h2=1)
        with pytest.raises(type(error)):
            _ = kd.number(1) == value


@pytest.mark.parametrize("error", [ValueError("nan"), OverflowError("inf"), TypeError("none")])
def test_a_value_that_has_no_ratio_is_not_finite(error: Exception) -> None:
    with pytest.raises(kd.KickdriftError, match="must be finite"):
        kd.number(Ratio(raising(error)))
    assert kd.number(1) != Ratio(raising(error))


@pytest.mark.parametrize("text", ["1E+999999", "1E-999999", "1E+999999999", "-7.5E-99999999"])
def test_a_decimal_of_too_many_digits_is_refused_at_once(text: str) -> None:
    for asked in (kd.number, kd.exact):
        start = time.process_time()
        with pytest.raises(kd.KickdriftError, match="bits above or below"):
            asked(Decimal(text))
        # Writing such a number takes a second at least, and of the longest ones minutes.
        assert time.process_time() - start < 0.2
    assert kd.number(Decimal("0E+999999")) == 0 and kd.number(Decimal("1.5E-30")).fraction == Fraction(3, 2 * 10**30)
    with pytest.raises(kd.KickdriftError):
        kd.number(Decimal("NaN"))


@pytest.mark.parametrize("threads", [[], "2", 1.5, -1, True, 1 << 70])
def test_threads_are_a_whole_number_or_none(threads: Any) -> None:
    grid = {"lambda1": 1, "lambda2": 0, "h1": (1, 2), "h2": (1, 2), "step": 1}
    for ask in (
        lambda: kd.verdicts(lambda1=1, lambda2=0, h1=1, h2=1, threads=threads),
        lambda: kd.map(**grid, threads=threads),
    ):
        with pytest.raises(kd.KickdriftError) as told:
            ask()
        assert told.value.field == "threads"


@pytest.mark.parametrize("budget", [[], "2", 1.5, -1, True, 1 << 70])
def test_a_budget_is_a_whole_number_or_none(budget: Any) -> None:
    grid = {"lambda1": 1, "lambda2": 0, "h1": (1, 2), "h2": (1, 2), "step": 1}
    for ask in (
        lambda: kd.decide(lambda1=1, lambda2=0, h1=1, h2=1, budget=budget),
        lambda: kd.verdicts(lambda1=1, lambda2=0, h1=1, h2=1, budget=budget),
        lambda: kd.map(**grid, budget=budget),
        lambda: kd.half("1/1", s=1, rho=0, budget=budget),
        lambda: kd.recheck(kd.proposition(max=2), budget=budget),
    ):
        with pytest.raises(kd.KickdriftError) as told:
            ask()
        assert told.value.field == "budget"
    assert kd.decide(lambda1=1, lambda2=0, h1=1, h2=1, budget=np.int64(10**6))


def test_errors_of_arrays_name_the_entry() -> None:
    fine = {"lambda1": 1, "lambda2": 0, "h1": 1, "h2": 1}
    for values, field, value in [
        ([1, 2, "x"], "h1[2]", "x"),
        ([[1, 2], [3, -4]], "h1[1, 1]", "-4"),
        (np.array([0.5, np.inf]), "h1[1]", "inf"),
        (np.array([[1.0], [0.0]], dtype=np.float32), "h1[1, 0]", "0"),
        ("x", "h1", "x"),
        (-1, "h1", "-1"),
    ]:
        with pytest.raises(kd.KickdriftError) as told:
            kd.verdicts(**fine | {"h1": values})
        assert (told.value.field, told.value.value) == (field, value)
    system = kd.System({"masses": [1, 1], "potentials": [{"step": "1/10", "springs": [[0, 1, 10]]}]})
    for asked, field in [
        (lambda: kd.simulate(system, periods=1, displace=["1/10", object()]), "displace[1]"),
        (lambda: kd.System({"masses": [1, object()]}).decide(), "document.masses[1]"),
        (lambda: kd.exact(np.array([[0.5, np.nan]])), "number[0, 1]"),
        (lambda: kd.System.from_hessians([1, "x"], {"k": (1, [[1, 0], [0, 1]])}), "masses[1]"),
        (lambda: kd.System.from_hessians([1, 1], {"k": (1, [[1, 0], [0, "x"]])}), "k[1, 1]"),
        (lambda: kd.tongues("5/3", rho="1/25", m=[1, "x\ud800"]), "m[1]"),
    ]:
        with pytest.raises(kd.KickdriftError) as told:
            asked()
        assert told.value.field == field


CHAIN = kd.System({"build": {"kind": "chain", "masses": 3, "stiffness": [1], "steps": [1]}})

#: What each function is asked in earnest.
ASKED: dict[str, dict[str, Any]] = {
    "advise": {"periods": ["10fs", "40fs"], "steps": ["0.5fs", "4fs"], "levers": False},
    "aperture": {"bond": "OH:K=553kcal/mol/A^2,15.999,1.008", "steps": 4},
    "closings": {"max_sum": 3},
    "compare": {"max_sum": 3, "rho": "1/25", "samples": 3},
    "curves": {"samples": 3},
    "decide": {"lambda1": 1, "lambda2": 0, "h1": 1, "h2": 1},
    "exact": {"value": 0.5},
    "explore": {"lambda1": 1, "lambda2": 1},
    "half": {"ratio": "1/1", "s": 1, "rho": 0},
    "map": {"lambda1": 1, "lambda2": 0, "h1": (1, 2), "h2": (1, 2), "step": 1},
    "number": {"value": 1},
    "proposition": {"max": 2},
    "recheck": {"document": kd.proposition(max=2)},
    "simplest": {"value": 0.5},
    "simulate": {"system": CHAIN, "periods": 1},
    "tongues": {"ratio": "5/3", "rho": "1/25"},
    "verdicts": {"lambda1": 1, "lambda2": 0, "h1": 1, "h2": 1},
    "word": {"word": "K(1/2) D(1) K(1/2)"},
}


class Unlike:
    """What belongs nowhere."""


JUNK: list[Any] = [
    Unlike(), None, [], {}, b"x", "", "x", "\ud800", -1, 2, float("nan"), 1j, True, [Unlike()], {"x": Unlike()},
    (1, 2, 3), np.array([[1.0]]), np.ma.masked_array([1.0], [True]), Unlike, len,
]  # fmt: skip


@pytest.mark.parametrize("name", ASKED)
def test_every_argument_of_every_function_refuses_what_does_not_belong_there_as_ours(name: str) -> None:
    if name == "explore":
        pytest.importorskip("anywidget")
    function = getattr(kd, name)
    other = []
    for parameter in inspect.signature(function).parameters.values():
        if parameter.kind is inspect.Parameter.VAR_KEYWORD:
            continue
        for junk in JUNK:
            # What is called may raise what it likes; a default belongs there, and may take long.
            if (parameter.name == "progress" and callable(junk)) or junk is parameter.default:
                continue
            try:
                function(**ASKED[name] | {parameter.name: junk})
            except kd.KickdriftError:
                continue
            except Exception as error:
                other.append(f"{parameter.name}={junk!r}: {type(error).__name__}: {error}")
    assert not other, "\n".join(other)


def test_no_method_of_a_system_takes_what_is_none() -> None:
    other = []
    for ask in (
        lambda junk: kd.System.read(junk),
        lambda junk: kd.System(junk),
        lambda junk: kd.System(junk).decide(),
        lambda junk: kd.System({"masses": junk}).decide(),
        lambda junk: kd.System({"masses": [1]}, junk).decide(),
        lambda junk: kd.System.from_hessians(junk, {"k": (1, [[1.0]])}).decide(),
        lambda junk: kd.System.from_hessians([1.0], junk).decide(),
        lambda junk: kd.System.from_hessians([1.0], {"k": junk}).decide(),
        lambda junk: kd.System.from_hessians([1.0], {"k": (junk, [[1.0]])}).decide(),
        lambda junk: kd.System.from_hessians([1.0], {"k": (1, junk)}).decide(),
        lambda junk: kd.System.along_orbit([1.0], {"k": junk}).decide(),
    ):
        for junk in JUNK:
            try:
                ask(junk)
            except kd.KickdriftError:
                continue
            except Exception as error:
                other.append(f"{inspect.getsource(ask).strip()} of {junk!r}: {type(error).__name__}: {error}")
    assert not other, "\n".join(other)


def test_a_file_without_an_end_is_no_input() -> None:
    for ask in (
        lambda: kd.System.read("/dev/zero"),
        lambda: kd.recheck("/dev/zero"),
        lambda: kd.advise(["10fs", "40fs"], engine="/dev/zero"),
    ):
        with pytest.raises(kd.KickdriftError, match="no text") as told:
            ask()
        assert told.value.field == "/dev/zero"
