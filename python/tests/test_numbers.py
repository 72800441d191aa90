"""Exact numbers come in and go out as they are."""

from __future__ import annotations

import math
import pickle
import random
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest
import sympy

import kickdrift as kd


def test_a_tenth_is_what_its_type_says() -> None:
    tenth = Fraction(1, 10)
    assert kd.number("0.1").fraction == kd.number(Decimal("0.1")).fraction == kd.number(tenth).fraction == tenth
    for kind in (float, np.float64, np.float32, np.float16, np.longdouble):
        assert kd.number(kind("0.1")).fraction == tenth
    assert kd.number(np.array(0.1)).fraction == tenth and kd.number(1e22).fraction == 10**22
    assert kd.number(5e-324).fraction == Fraction(5, 10**324) and kd.number(-0.0).fraction == 0


def test_a_double_to_its_last_bit_is_asked_for() -> None:
    assert kd.exact(0.1).fraction == Fraction(0.1) != Fraction(1, 10)
    assert kd.exact(np.float32(0.1)).fraction == Fraction(float(np.float32(0.1)))
    for value in (math.nan, math.inf, "0.1"):
        with pytest.raises(kd.KickdriftError):
            kd.exact(value)  # type: ignore[arg-type]


def test_a_step_as_a_float_makes_the_grid_of_its_decimal() -> None:
    question = {"lambda1": 1, "lambda2": 1, "h1": (0.02, 0.56), "h2": ("1/50", "1/25")}
    floats, texts = kd.map(step=0.02, **question), kd.map(step="1/50", **question)
    assert floats.verdict.shape == texts.verdict.shape == (28, 2)
    assert floats.to_json() == texts.to_json()
    steps = np.array([0.02, 0.3, 0.7])
    for kind in (np.float64, np.float32):
        found = kd.verdicts(lambda1=10, lambda2=1, h1=steps.astype(kind), h2=2, budget=10_000)
        assert (found.code == kd.verdicts(lambda1=10, lambda2=1, h1=["1/50", "3/10", "7/10"], h2=2).code).all()


def random_numbers(kind: str) -> list[object]:
    rng = random.Random(kind)
    whole = [rng.randint(-(10 ** rng.randint(1, 40)), 10 ** rng.randint(1, 40)) for _ in range(1000)]
    double = [rng.choice([-1, 1]) * math.ldexp(rng.random(), rng.randint(-300, 300)) for _ in range(1000)]
    fraction = [Fraction(n, rng.randint(1, 10**20)) for n in whole]
    kinds: dict[str, list[object]] = {
        "int": list(whole),
        "Fraction": list(fraction),
        "float": list(double),
        "Decimal": [Decimal(n).scaleb(-rng.randint(0, 60)) for n in whole],
        "str": [f"{x.numerator}/{x.denominator}" for x in fraction],
        "numpy": [
            rng.choice([np.float64(x), np.float32(x % 1e30), np.int64(n % 2**62)])
            for x, n in zip(double, whole, strict=True)
        ],
        "longdouble": [np.longdouble(x) / 3 for x in double],
        "sympy": [sympy.Rational(x.numerator, x.denominator) for x in fraction],
    }
    return kinds[kind]


@pytest.mark.parametrize("kind", ["int", "Fraction", "float", "Decimal", "str", "numpy", "longdouble", "sympy"])
def test_a_thousand_random_values_of_each_kind_round_trip(kind: str) -> None:
    for value in random_numbers(kind):
        number = kd.number(value)
        exact = Fraction(str(value))
        assert number.fraction == exact
        assert kd.number(str(number)) == number == kd.number(number.fraction) == pickle.loads(pickle.dumps(number))
        if kind == "float":
            assert float(number) == value
        assert hash(number) == hash(exact)


def test_sums_of_powers_of_pi_round_trip_through_sympy() -> None:
    rng = random.Random(0)
    for _ in range(1000):
        value = sum(
            (
                sympy.Rational(rng.randint(-999, 999), rng.randint(1, 99)) * sympy.pi ** rng.randint(-3, 4)
                for _ in range(rng.randint(1, 3))
            ),
            sympy.Integer(0),
        )
        number = kd.number(value)
        assert sympy.simplify(number.to_sympy() - value) == 0
        assert math.isclose(float(number), float(value.evalf(30)), rel_tol=1e-14, abs_tol=1e-300)


def test_numbers_are_ordered_and_hashed_by_value() -> None:
    assert kd.number("22/7") > kd.number("pi") >= kd.number("pi") > 3
    assert kd.number("1/2") == Fraction(1, 2) == kd.number(0.5)
    assert kd.number("pi") != "pi" and kd.number(1) != "1"
    assert len({kd.number("1/2"), Fraction(1, 2), kd.number(0.5)}) == 1
    assert hash(kd.number("pi")) == hash(kd.number("2*pi/2"))
    assert bool(kd.number("pi")) and not bool(kd.number(0)) and not kd.number("pi").is_rational
    assert repr(kd.number("pi**2/25")) == "Number('pi^2/25')"
    with pytest.raises(TypeError):
        _ = kd.number(1) < object()


@pytest.mark.parametrize(
    "value",
    [
        math.nan,
        math.inf,
        -math.inf,
        Decimal("NaN"),
        np.float64("inf"),
        np.longdouble("nan"),
        True,
        None,
        object(),
        [1],
        "",
        "0,3",
        "sqrt(2)",
        sympy.sqrt(2),
        sympy.Float(0.1),
        0.5 * sympy.pi,
        sympy.Symbol("x"),
        1j,
        "1/0",
        "9" * 100_000,
    ],
)
def test_what_is_no_number_is_refused_by_name(value: object) -> None:
    with pytest.raises(kd.KickdriftError) as caught:
        kd.decide(lambda1=1, lambda2=1, h1=value, h2=1)
    assert caught.value.field == "h1"
    assert caught.value.remedy


def test_an_irrational_number_has_no_fraction() -> None:
    with pytest.raises(kd.KickdriftError, match="irrational"):
        _ = kd.number("pi").fraction


def test_errors_carry_their_parts_through_pickle() -> None:
    with pytest.raises(kd.KickdriftError) as caught:
        kd.decide(lambda1=1, lambda2=1, h1="x" * 100, h2=1)
    again = pickle.loads(pickle.dumps(caught.value))
    assert (again.field, again.value, again.remedy) == ("h1", "x" * 100, caught.value.remedy)
    assert str(again) == str(caught.value) and len(str(again)) < 300
    with pytest.raises(kd.BudgetError) as budget:
        kd.decide(lambda1=1, lambda2=1, h1=1, h2="1000001/1000003", exact=True, budget=10)
    again = pickle.loads(pickle.dumps(budget.value))
    assert again.needed == budget.value.needed > 10 and f"budget={again.needed}" in str(again)


def test_an_integer_beyond_all_measure_is_refused() -> None:
    with pytest.raises(kd.KickdriftError, match="bits"):
        kd.number(10**100_000)
