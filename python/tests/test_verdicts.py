"""Verdicts: one pair, many pairs."""

from __future__ import annotations

import itertools
import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from fractions import Fraction

import numpy as np
import pytest

import kickdrift as kd

PAIRS = [
    ("pi^2", "pi^2/25", "1/100", "0.98"),
    ("11/4", "57/10", "1", "5/3"),
    ("10", "2/5", "0.631", "3.499"),
    ("4", "0", "1", "1"),
    ("1", "-1/9", "1/2", "3/2"),
]


@pytest.mark.parametrize("pair", PAIRS)
@pytest.mark.parametrize("exact", [False, True])
def test_documents_are_those_of_the_program(program: Callable[..., str], pair: tuple[str, ...], exact: bool) -> None:
    lambda1, lambda2, h1, h2 = pair
    verdict = kd.decide(lambda1=lambda1, lambda2=lambda2, h1=h1, h2=h2, exact=exact)
    flags = [f"--{name}={value}" for name, value in zip(("lambda1", "lambda2", "h1", "h2"), pair, strict=True)]
    flags += ["--exact"] if exact else []
    assert verdict.to_json() == program("verdict", *flags, "--format", "json")
    assert verdict.to_csv() == program("verdict", *flags, "--format", "csv")
    assert verdict.to_latex() == program("verdict", *flags, "--format", "latex")
    assert f"{verdict}\n" == program("verdict", *flags, "--format", "text")


def test_a_verdict_tells_all_that_its_document_does() -> None:
    verdict = kd.decide(lambda1="pi^2", lambda2="pi^2/25", h1="1/100", h2="0.98")
    assert (verdict.stable, verdict.kind, verdict.side, verdict.decided_by) == (False, "hyperbolic", -1, "filter")
    assert verdict.ratio == (98, 1) and verdict.period == Fraction(49, 50) and verdict.m == 1
    assert verdict.family == (0, 1) and verdict.lambda1 == kd.number("pi^2") and verdict.h2 == Fraction(49, 50)
    assert verdict.h1 == Fraction(1, 100)
    lo, hi = verdict.trace
    assert lo <= hi < -2 and 0 < verdict.growth_bounds.lo <= verdict.growth_rate <= verdict.growth_bounds.hi
    assert "unstable" in repr(verdict) and "Tr Q < -2" in verdict._repr_html_() and not verdict
    same = kd.decide(lambda1="pi^2", lambda2="pi^2/25", h1="1/100", h2="49/50")
    assert same == verdict and hash(same) == hash(verdict) and verdict != 1
    with pytest.raises(AttributeError):
        verdict.stable = True  # type: ignore[misc]
    calm = kd.decide(lambda1=1, lambda2=0, h1=1, h2="1/2")
    assert calm.m is None and calm.family is None and calm.growth_bounds == (0.0, 0.0) and calm.lambda2 == 0
    assert bool(calm) and "stable" in repr(calm)


def test_many_verdicts_are_those_of_one_at_a_time() -> None:
    rng = random.Random(7)
    h1 = [Fraction(rng.randint(1, 300), 100) for _ in range(60)]
    h2 = [Fraction(rng.randint(1, 300), 100) for _ in range(60)]
    lambdas = ["pi^2", "11/4"]
    found = kd.verdicts(lambda1=[[stiffness] for stiffness in lambdas], lambda2="1/25", h1=h1, h2=h2)
    assert found.code.shape == (2, 60) == found.stable.shape and len(found) == 2
    for (row, lambda1), (column, steps) in itertools.product(enumerate(lambdas), enumerate(zip(h1, h2, strict=True))):
        one = kd.decide(lambda1=lambda1, lambda2="1/25", h1=steps[0], h2=steps[1])
        assert found.stable[row, column] == one.stable and found.kind[row, column] == one.kind
        sign = {1: "+", 0: "", -1: "-"}[one.side]
        assert found.names[found.code[row, column]] == one.kind + sign
    frame = found.to_pandas()
    assert len(frame) == 120 and frame.stable.sum() == np.count_nonzero(found.stable)
    assert "120 pairs of shape (2, 60)" in repr(found)


def test_arrays_of_doubles_mean_what_they_print() -> None:
    steps = np.array([0.5, 0.2, 0.1])
    found = kd.verdicts(lambda1=np.float64(10.0), lambda2=np.int64(1), h1=steps, h2=steps[::-1] * 4)
    for code, one, other in zip(found.code, steps, steps[::-1] * 4, strict=True):
        alone = kd.decide(lambda1=10, lambda2=1, h1=str(one), h2=str(other))
        assert found.names[code].startswith(alone.kind)
    assert kd.verdicts(lambda1=1, lambda2=1, h1=1, h2=1).code.shape == ()
    assert kd.verdicts(lambda1=1, lambda2=1, h1=[], h2=1).code.shape == (0,)


def test_many_verdicts_say_how_far_they_are() -> None:
    rng = np.random.default_rng(5)
    h1, h2 = rng.uniform(0.01, 0.6, 20_000), rng.uniform(0.5, 3.4, 20_000)
    heard: list[tuple[int, int]] = []
    found = kd.verdicts(
        lambda1="pi^2", lambda2="pi^2/25", h1=h1, h2=h2, progress=lambda done, total: heard.append((done, total))
    )
    assert len(found) == 20_000 and heard[-1] == (20_000, 20_000)
    assert heard == sorted(heard) and all(total == 20_000 for _, total in heard)

    def enough(done: int, total: int) -> None:
        raise RuntimeError(f"{done} of {total}")

    with pytest.raises(RuntimeError, match="of 20000"):
        kd.verdicts(lambda1="pi^2", lambda2="pi^2/25", h1=h1, h2=h2, progress=enough)


def test_a_map_beyond_the_budget_is_refused_before_its_arrays_are_made() -> None:
    with pytest.raises(kd.BudgetError, match="days of one core"):
        kd.map(lambda1="pi^2", lambda2="pi^2/25", step="1/400000", h1=("1/400000", "2/pi"), h2=("1/400000", "7/2"))


def test_what_does_not_fit_is_refused_by_name() -> None:
    with pytest.raises(kd.KickdriftError, match="broadcast"):
        kd.verdicts(lambda1=[1, 2], lambda2=1, h1=[1, 2, 3], h2=1)
    with pytest.raises(kd.KickdriftError) as caught:
        kd.verdicts(lambda1=1, lambda2=1, h1=["1", "x"], h2=1)
    assert (caught.value.field, caught.value.value) == ("h1[1]", "x")
    with pytest.raises(kd.KickdriftError) as caught:
        kd.verdicts(lambda1=1, lambda2=1, h1=["1", "-1"], h2=1)
    assert caught.value.field == "h1[1]"
    with pytest.raises(kd.KickdriftError):
        kd.verdicts(lambda1=1, lambda2=1, h1=[[1], [1, 2]], h2=1)


LONG = {
    "decide": "kd.decide(lambda1=1, lambda2=1, h1='1/1000003', h2='1/999983', exact=True, budget=10**18)",
    "map": "kd.map(lambda1='pi^2', lambda2='pi^2/25', step='1/9000', h1=('1/9000', '2/pi'), h2=('1/9000', '7/2'))",
    "tongues": "kd.tongues(max_sum=400, rho='1/25')",
    "closings": "kd.closings(max_sum=60)",
    "compare": "kd.compare(max_sum=900, rho='1/25', samples=900, budget=10**12)",
    "verdicts": "kd.verdicts(lambda1=1, lambda2='1/25', h1='1/1000003', h2=[f'{n}/1000033' for n in range(1, 60000)])",
}


@pytest.mark.skipif(os.name != "posix", reason="SIGINT is sent as POSIX has it")
@pytest.mark.parametrize("call", LONG)
def test_ctrl_c_is_heard_before_the_work_ends(call: str) -> None:
    # A shell's background job hands on that interrupts are ignored.
    code = (
        "import signal, time, kickdrift as kd\n"
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "print('ready', flush=True)\n"
        f"try:\n    {LONG[call]}\n    print('done', flush=True)\n"
        "except KeyboardInterrupt:\n    print('heard', flush=True)\n"
        "time.sleep(2.0); spent = time.process_time(); time.sleep(1.0)\n"
        "print(time.process_time() - spent, flush=True)\n"
        "import os; os._exit(0)\n"
    )
    with subprocess.Popen([sys.executable, "-P", "-c", code], stdout=subprocess.PIPE, text=True) as child:
        assert child.stdout is not None and child.stdout.readline() == "ready\n"
        time.sleep(1.0)
        child.send_signal(signal.SIGINT)
        assert child.stdout.readline() == "heard\n"
        # The work itself has ended too, but for that of a single verdict.
        if call != "decide":
            assert float(child.stdout.readline()) < 0.1


def test_any_two_doubles_have_a_verdict() -> None:
    rng = np.random.default_rng(7)
    h1, h2 = rng.uniform(0.01, 0.63, 300), rng.uniform(0.01, 3.5, 300)
    # Far apart, and subnormal.
    h1[:20] *= 2.0**-200
    h1[20], h2[20] = 5e-324, 0.75
    found = kd.verdicts(lambda1="pi^2", lambda2="pi^2/25", h1=kd.exact(h1), h2=kd.exact(h2))
    assert found.code.shape == (300,)
    assert set(found.kind) == {"elliptic", "hyperbolic"}
    # Where the fast step is next to nothing, the fast force is an exact rotation: the impulse method's windows.
    phase = np.pi * h2[:21]
    kappa = np.pi / 25 * h2[:21]
    unstable = np.abs(2 * np.cos(phase) - kappa * np.sin(phase)) > 2
    assert found.stable[:21].tolist() == (~unstable).tolist()


def test_a_period_beyond_every_machine_is_decided_alone_as_among_others() -> None:
    rng = np.random.default_rng(3)
    h1, h2 = kd.exact(rng.uniform(0.01, 0.02, 40) / 64), kd.exact(rng.uniform(0.9, 1.0, 40))
    together = kd.verdicts(lambda1="pi^2", lambda2="pi^2/25", h1=h1, h2=h2)
    found = [kd.decide(lambda1="pi^2", lambda2="pi^2/25", h1=a, h2=b) for a, b in zip(h1, h2, strict=True)]
    assert [one.stable for one in found] == together.stable.tolist()
    longest = max(found, key=lambda one: max(one.ratio))
    assert max(longest.ratio) > 2**63 and longest.document.data["p"] == str(longest.ratio[0])
    assert {one.stable for one in found} == {True, False}
    for one in found:
        assert one.stable == (one.growth_bounds == (0.0, 0.0))
    with pytest.raises(kd.BudgetError, match="18 digits"):
        kd.decide(lambda1="pi^2", lambda2="pi^2/25", h1=longest.h1, h2=longest.h2, exact=True)


def test_a_pair_of_doubles_that_nothing_decides_is_named_by_its_place() -> None:
    strong = kd.exact(np.array([[0.5, 0.25], [2.5456041358732118, 0.125]]))
    with pytest.raises(kd.BudgetError, match=r"^pair \[1, 0\]: 256 bits do not decide the verdict.*: move a step"):
        kd.verdicts(lambda1=10, lambda2=1, h1=strong, h2=kd.exact(1.8315760255619316))


def test_the_verdict_of_doubles_has_its_growth_and_label() -> None:
    # 3 - 2.8e-16.
    stable = kd.decide(lambda1="pi^2", lambda2="pi^2/25", h1=kd.exact(0.1), h2=kd.exact(0.3))
    assert stable.stable and stable.ratio[0] > 10**16
    # Beside 98 the slow kicks slide past the fast ones: growth is the mean over their offset x, not that of 98 itself.
    beside = kd.decide(lambda1="pi^2", lambda2="pi^2/25", h1=kd.exact(0.01), h2=kd.exact(0.98))
    s, k = np.pi**2 * 1e-4, np.pi**2 / 25 * 0.0098
    fast = np.linalg.matrix_power(np.array([[1.0, 1.0], [-s, 1.0 - s]]), 98)
    x = (np.arange(1000) + 0.5) / 1000
    slow = np.moveaxis(np.array([[1 + k * x, k * x**2], [-k + 0 * x, 1 - k * x]]), -1, 0)
    rate = np.arccosh(np.abs(np.trace(slow @ fast, axis1=1, axis2=2)) / 2).mean() / 0.98
    assert not beside.stable and beside.growth_rate == pytest.approx(rate, rel=1e-6)
