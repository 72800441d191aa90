"""kickdrift beside what else one could use: the same work in one run, answers compared, a Markdown table of ratios.

Setup, once, outside the repository:  python3 -m venv V && V/bin/pip install -r requirements.txt
Run, from the repository:             V/bin/python tests/bench/peers/peers.py

Every program times itself inside its own process, so neither starting it nor compiling it (numba) nor making its input
(matrices for SciPy) counts. Times are minima over at least three repetitions, one for what takes more than ten seconds.
kickdrift, numba and the loop in C use all cores, the others are written for one. A ratio above 1 says that kickdrift
is so many times faster. kickdrift certifies all its answers, the peers none but the exact ones and Arb.
"""

import datetime
import math
import os
import platform
import subprocess
import tempfile
import time
from fractions import Fraction
from pathlib import Path

import flint
import mpmath
import numba
import numpy as np

import tongue

HERE = Path(__file__).parent
ROWS = []


def timed(work):
    """The work's least time and its answer."""
    least, total, rounds = math.inf, 0.0, 0
    while rounds < 3 or total < 1:
        start = time.perf_counter()
        answer = work()
        took = time.perf_counter() - start
        least, total, rounds = min(least, took), total + took, rounds + 1
        if total > 10:
            break
    return least, answer


def row(work, peer, seconds, ours, answers):
    print(f"{work} | {peer}: {seconds:.3g} s, kickdrift {ours:.3g} s", flush=True)
    ROWS.append(f"| {work} | {peer} | {short(seconds)} | {short(ours)} | {seconds / ours:.3g} | {answers} |")


def short(seconds):
    for unit, size in [("s", 1), ("ms", 1e-3), ("µs", 1e-6)]:
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds * 1e9:.3g} ns"


def ours(folder):
    command = ["cargo", "bench", "--quiet", "--bench", "peers", "--", str(folder)]
    lines = subprocess.run(command, cwd=HERE.parents[2], check=True, capture_output=True, text=True).stdout.split("\n")
    return {name: float(seconds) for name, seconds in (line.split() for line in lines if line)}


# Figure 1: h1 = i/n <= 2/pi, h2 = j/n <= 7/2, stiffnesses pi^2 and pi^2/25.


def sizes(n):
    return math.floor(2 / math.pi * n), 7 * n // 2


def kicks(p, q):
    """The ticks (of h1/q = h2/p) before each kick time in a period, and which clocks strike there."""
    times = sorted({k * q for k in range(p)} | {k * p for k in range(q)} | {p * q})
    for now, after in zip(times, times[1:]):
        yield now % q == 0, now % p == 0, after - now


def numpy_unstable(i, j, n):
    g = math.gcd(i, j)
    p, q, h1, h2 = j // g, i // g, i / n, j / n
    matrix = np.eye(2)
    for fast, slow, ticks in kicks(p, q):
        k = h1 * math.pi**2 * fast + h2 * math.pi**2 / 25 * slow
        matrix = np.array([[1, ticks * h1 / q], [0, 1]]) @ np.array([[1, 0], [-k, 1]]) @ matrix
    # Rounding alone puts eigenvalues of a stable product off the circle by 1e-15 a kick or so.
    return np.abs(np.linalg.eigvals(matrix)).max() > 1 + 1e-9


def numpy_figure(n):
    columns, rows = sizes(n)
    return "".join("01"[int(numpy_unstable(i, j, n))] for i in range(1, columns + 1) for j in range(1, rows + 1))


@numba.njit(parallel=True)
def numba_figure(n, columns, rows):
    verdicts = np.zeros((columns, rows), np.uint8)
    for a in numba.prange(columns):
        for b in range(rows):
            i, j = a + 1, b + 1
            x, y = i, j
            while y:
                x, y = y, x % y
            p, q, h1, h2 = j // x, i // x, i / n, j / n
            k1, k2, tick = h1 * math.pi**2, h2 * math.pi**2 / 25, h1 / q
            m00, m01, m10, m11 = 1.0, 0.0, 0.0, 1.0
            now, fast, slow = 0, 0, 0
            while now < p * q:
                k = 0.0
                if fast == now:
                    k += k1
                    fast += q
                if slow == now:
                    k += k2
                    slow += p
                after = min(fast, slow)
                m10 -= k * m00
                m11 -= k * m01
                m00 += (after - now) * tick * m10
                m01 += (after - now) * tick * m11
                now = after
            verdicts[a, b] = not abs(m00 + m11) <= 2
    return verdicts


def c_figure(program, n, file):
    found = subprocess.run([program, str(n), file], check=True, capture_output=True, text=True).stdout
    return float(found.split()[2])


def arb_trace(i, j, n, bits):
    """The trace as a ball: the full product."""
    flint.ctx.prec = bits
    g = math.gcd(i, j)
    p, q = j // g, i // g
    pi2 = flint.arb.pi() ** 2
    k1, k2 = pi2 * i / n, pi2 * j / n / 25
    tick = flint.arb(i) / n / q
    a, b, c, d = flint.arb(1), flint.arb(0), flint.arb(0), flint.arb(1)
    for fast, slow, ticks in kicks(p, q):
        k = (k1 if fast else 0) + (k2 if slow else 0)
        c, d = c - k * a, d - k * b
        a, b = a + tick * ticks * c, b + tick * ticks * d
    return a + d


def disagreements(n, mine, theirs):
    """How many answers differ, and who is right, by balls of so many bits that they tell."""
    rows = sizes(n)[1]
    differ = [k for k, (x, y) in enumerate(zip(mine, theirs)) if x != y]
    right = on_edge = 0
    for k in differ:
        for bits in [256, 1024, 4096]:
            size = abs(arb_trace(k // rows + 1, k % rows + 1, n, bits))
            if size > 2 or size < 2:
                right += (size > 2) == (mine[k] == "1")
                break
        else:
            on_edge += 1
    assert right + on_edge == len(differ), f"kickdrift is wrong on {len(differ) - right - on_edge} pairs"
    if not differ:
        return f"{len(mine)} equal"
    return f"{len(differ)} of {len(mine)} wrong by rounding near an edge" + (f", {on_edge} on it" if on_edge else "")


def figures(folder, times):
    read = lambda n: (folder / f"figure_{n}").read_text()
    name = lambda n: f"verdicts of Figure 1, d = 1/{n}, {len(read(n)):,} pairs"
    seconds, found = timed(lambda: numpy_figure(40))
    row(name(40), "NumPy, full product and `eigvals`", seconds, times["figure_40"], disagreements(40, read(40), found))
    numba_figure(10, *sizes(10))  # compiles
    text = lambda verdicts: (verdicts.ravel() + ord("0")).tobytes().decode()
    for n in [200, 1000]:
        seconds, found = timed(lambda: numba_figure(n, *sizes(n)))
        row(name(n), "numba, full-period loop", seconds, times[f"figure_{n}"], disagreements(n, read(n), text(found)))
    program, file = str(folder / "full_period"), str(folder / "full_period.txt")
    source = str(HERE / "full_period.c")
    subprocess.run(["gcc", "-O3", "-march=native", "-fopenmp", source, "-o", program, "-lm"], check=True)
    seconds = min(c_figure(program, 1000, file) for _ in range(3))
    found = Path(file).read_text()
    row(name(1000), "C, full-period loop", seconds, times["figure_1000"], disagreements(1000, read(1000), found))


# One long period: h2/h1 = 1751/317, s = h1^2 L1 with h1 = 0.317 and L1 = 10, rho = 1/25; unit of time h1.

P, Q, S, RHO = 1751, 317, Fraction(317**2, 100_000), Fraction(1, 25)


def factors(number, one, zero):
    """The kicks and drifts as (strength, length) in the given arithmetic, the first one first."""
    fast, slow, tick = number(S), number(S * RHO * Fraction(P, Q)), number(Fraction(1, Q))
    for strikes, strikes_slow, ticks in kicks(P, Q):
        yield (fast if strikes else zero) + (slow if strikes_slow else zero), tick * ticks


def rational_trace():
    number = lambda x: flint.fmpq(x.numerator, x.denominator)
    steps = [flint.fmpq_mat([[1 - k * t, t], [-k, 1]]) for k, t in factors(number, flint.fmpq(1), flint.fmpq(0))]
    while len(steps) > 1:
        pairs = [b * a for a, b in zip(steps[::2], steps[1::2])]
        steps = pairs + steps[len(steps) // 2 * 2 :]
    trace = steps[0][0, 0] + steps[0][1, 1]
    return f"{trace.p}/{trace.q}"


def product_trace(number, one, zero):
    a, b, c, d = one, zero, zero, one
    for k, t in factors(number, one, zero):
        c, d = c - k * a, d - k * b
        a, b = a + t * c, b + t * d
    return a + d


def arb_verdict():
    """Bits are doubled until the ball tells the sign of |Tr| - 2."""
    bits = 64
    while True:
        flint.ctx.prec = bits
        number = lambda x: flint.arb(flint.fmpq(x.numerator, x.denominator))
        trace = product_trace(number, flint.arb(1), flint.arb(0))
        if abs(trace) < 2 or abs(trace) > 2:
            return side(trace), bits
        bits *= 2


def side(trace):
    return 1 if trace > 2 else -1 if trace < -2 else 0


def mpmath_verdict():
    mpmath.mp.dps = 50
    number = lambda x: mpmath.mpf(x.numerator) / x.denominator
    return side(product_trace(number, mpmath.mpf(1), mpmath.mpf(0)))


def long_period(folder, times):
    work = f"exact trace, h2/h1 = {P}/{Q}, rational data"
    seconds, trace = timed(rational_trace)
    equal = "equal" if trace == (folder / "exact_trace").read_text() else "DIFFERENT"
    row(work, "python-flint rationals, product tree", seconds, times["exact_trace"], equal)
    work, verdict = f"verdict, h2/h1 = {P}/{Q}", int((folder / "verdict").read_text())
    tell = lambda found: "equal" if found == verdict else "DIFFERENT"
    seconds, (found, bits) = timed(arb_verdict)
    row(work, f"Arb balls, full product, 64 bits doubled up to {bits}", seconds, times["verdict"], tell(found))
    seconds, found = timed(mpmath_verdict)
    row(work, "mpmath, full product, 50 digits", seconds, times["verdict"], tell(found))


# Tongues.


def ulps(low, high, theirs):
    """How far numbers lie outside the enclosures, in units in the last place."""
    outside = np.maximum(np.maximum(low - theirs, theirs - high), 0)
    return outside / np.spacing(high)


def edges(folder, times):
    for largest in [30, 100]:
        problems = list(tongue.problems(largest))
        seconds, solved = timed(lambda: tongue.solve(problems))
        low, high = np.loadtxt(folder / f"edges_{largest}").T
        off = ulps(low, high, tongue.positive(solved))
        answers = f"off by up to {off.max():,.0f} ulp, {(off > 4).mean():.0%} by more than 4"
        work = f"all {len(low):,} edges of p + q ≤ {largest}"
        row(work + ", one core each", "SciPy `eigh_tridiagonal`", seconds, times[f"edges_{largest}_one_thread"], answers)
        row(work + ", all cores", "SciPy `eigh_tridiagonal`", seconds, times[f"edges_{largest}"], answers)


def mpmath_edges():
    mpmath.mp.dps = 40
    found = []
    # The matrices in exact square roots: masses and lengths of 13/7 are rational.
    mass, length = tongue.half_period(13, 7, Fraction(1, 25), Fraction)
    for ends in [(True, False), (False, False), (True, True), (False, True)]:
        d, e = tongue.entries(mass, length, *ends)
        number = lambda x: mpmath.mpf(x.numerator) / x.denominator
        matrix = mpmath.zeros(len(d))
        for k, x in enumerate(d):
            matrix[k, k] = number(x)
        for k, x in enumerate(e):
            matrix[k, k + 1] = matrix[k + 1, k] = -mpmath.sqrt(number(x))
        values = list(mpmath.eigsy(matrix, eigvals_only=True))
        found += values[1:] if ends == (True, True) else values
    return found


def many_digits(folder, times):
    seconds, found = timed(mpmath_edges)
    mine = [mpmath.mpf(int(line)) / mpmath.mpf(10) ** 40 for line in (folder / "edges_30_digits").read_text().split()]
    worst = max(abs(x / y - 1) for x, y in zip(mine, found))
    assert len(mine) == len(found)
    answers = f"equal to {-int(mpmath.ceil(mpmath.log10(worst)))} digits"
    row(f"{len(found)} edges of 13/7, 30 digits", "mpmath `eigsy`, 40 digits", seconds, times["edges_30_digits"], answers)


# Two dense levels.


def dense_unstable(fast, slow, step, inner=4):
    n, h = len(fast), step / inner
    one, none = np.eye(n), np.zeros((n, n))
    kick = lambda k, time: np.block([[one, none], [-time * k, one]])
    drift = np.block([[one, h * one], [none, one]])
    steps = np.linalg.matrix_power(kick(fast, h / 2) @ drift @ kick(fast, h / 2), inner)
    values = np.linalg.eigvals(kick(slow, step / 2) @ steps @ kick(slow, step / 2))
    # Multipliers near 1 and -1 are good to the root of rounding.
    return np.abs(values).max() > 1 + 1e-6


def dense_levels(folder, times):
    fast, slow = np.loadtxt(folder / "fast"), np.loadtxt(folder / "slow")
    one, *ten = (folder / "levels_288").read_text().split("\n")
    peer = "NumPy, `eigvals` of the 2n x 2n period"
    for steps, mine, works in [
        (
            [1.0],
            [one],
            [
                ("verdict on two dense levels, n = 288", "levels_288"),
                ("the same by way of the eigenbasis", "levels_288_basis"),
            ],
        ),
        (
            [0.3 * k for k in range(1, 11)],
            ten,
            [("verdicts at ten outer steps, n = 288", "levels_288_ten")],
        ),
    ]:
        seconds, found = timed(lambda: [dense_unstable(fast, slow, step) for step in steps])
        equal = sum(["stable", "unstable"][int(theirs)] == ours for theirs, ours in zip(found, mine))
        for work, name in works:
            row(work, peer, seconds, times[name], f"{equal} of {len(mine)} equal")


def processor():
    lines = Path("/proc/cpuinfo").read_text().split("\n") if Path("/proc/cpuinfo").exists() else []
    names = [line.split(":")[1].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor()


def main():
    print("load before:", os.getloadavg())
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        times = ours(folder)
        figures(folder, times)
        long_period(folder, times)
        edges(folder, times)
        many_digits(folder, times)
        dense_levels(folder, times)
    print("load after:", os.getloadavg())
    print(f"\n{datetime.date.today()}, {processor()}, {os.cpu_count()} cores, {platform.system()}\n")
    print("| work | peer | its time | ours | ratio | peer's answers |\n|---|---|---|---|---|---|")
    print("\n".join(ROWS))


main()
