"""What Python costs: a million verdicts beside the same work in Rust, and the memory of a map of a million pairs.

Run, from python/, with a release build installed:  python tests/bench/performance.py
"""

from __future__ import annotations

import resource
import subprocess
import time
from fractions import Fraction
from pathlib import Path

import numpy as np

import kickdrift as kd

SIDE = 1000


def main() -> None:
    """Print the ratio of times and the peak of memory."""
    steps = [Fraction(k, SIDE) for k in range(1, SIDE + 1)]
    column = np.array(steps, dtype=object)[:, None]
    kd.verdicts(lambda1=10, lambda2="2/5", h1=column[:10], h2=steps)
    ours, theirs = [], []
    command = ["cargo", "run", "--quiet", "--release", "--example", "million"]
    for _ in range(3):
        start = time.perf_counter()
        found = kd.verdicts(lambda1=10, lambda2="2/5", h1=column, h2=steps)
        ours.append(time.perf_counter() - start)
        done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=Path(__file__).parents[2])
        seconds, unstable = done.stdout.split()
        theirs.append(float(seconds))
        assert int(unstable) == found.code.size - np.count_nonzero(found.stable)
    print(f"{found.code.size} verdicts: {min(ours):.3f} s, in Rust {min(theirs):.3f} s, {min(ours) / min(theirs):.3f}")

    distinct = [Fraction(k, 10**6) for k in range(1, 10**6 + 1)]
    start = time.perf_counter()
    kd.verdicts(lambda1=10, lambda2="2/5", h1=1, h2=[1, 2])
    kd.verdicts(lambda1=distinct, lambda2="2/5", h1="1/10", h2="3/10")
    print(f"a million different Fractions: {time.perf_counter() - start:.3f} s")

    for growth in (False, True):
        before = peak()
        start = time.perf_counter()
        found = kd.map(lambda1="pi^2", lambda2="pi^2/25", step="1/1400", h1=("1/1400", "2/pi"), h2=("1/1400", "7/2"),
                       growth=growth, label=growth)  # fmt: skip
        seconds, held = time.perf_counter() - start, sum(array.nbytes for array in found.arrays.values())
        grown = peak() - before
        print(f"{found.verdict.size} pairs, growth={growth}: {seconds:.2f} s, arrays {held / 1e6:.1f} MB, "
              f"peak grown by {grown / 1e6:.1f} MB")  # fmt: skip


def peak() -> int:
    """The most memory that this process has held, in bytes."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


if __name__ == "__main__":
    main()
