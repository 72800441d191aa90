#!/usr/bin/env python3
"""The time of a verdict over the length of its period: periods.py; JSON. Needs the Python package and a C compiler; one minute.

Random pairs in the window of the paper, steps multiples of 2^-m: p + q is about 2^m, up to what two doubles have. Each group is
decided on one thread, the fastest of seven runs, beside the plain loop over the full period (plain.c) where that ends within
seconds. Processor times, of one machine.
"""

import ctypes
import json
import math
import subprocess
import tempfile
import time
from fractions import Fraction
from pathlib import Path

import numpy as np

import kickdrift as kd

SOURCE = Path(__file__).with_name("plain.c")
PAIRS = 400


def main():
    rng, rows = np.random.default_rng(1), []
    with tempfile.TemporaryDirectory() as folder:
        built = Path(folder) / "plain.so"
        subprocess.run(["cc", "-O2", "-ffp-contract=off", "-shared", "-fPIC", "-o", str(built), str(SOURCE)], check=True)
        library = ctypes.CDLL(str(built))
        library.trace.restype = ctypes.c_double
        for m in range(8, 54, 3):
            h1, h2 = (np.floor(rng.uniform(lo, hi, PAIRS) * 2.0**m) / 2.0**m for lo, hi in ((0.1, 0.6), (0.7, 3.4)))
            ratios = [Fraction(slow) / Fraction(fast) for fast, slow in zip(h1, h2, strict=True)]
            kicks = sorted(ratio.numerator + ratio.denominator for ratio in ratios)
            exact = {"lambda1": "pi^2", "lambda2": "pi^2/25", "h1": kd.exact(h1), "h2": kd.exact(h2)}
            seconds = []
            for _ in range(7):
                start = time.process_time()
                found = kd.verdicts(**exact, threads=1)
                seconds.append(time.process_time() - start)
            row = {"m": m, "pairs": PAIRS, "kicks": kicks[PAIRS // 2], "unstable": int((~found.stable).sum()),
                   "microseconds": 1e6 * min(seconds) / PAIRS}
            if m <= 20:
                few = range(0, PAIRS, 1 if m <= 14 else 20)
                seconds = []
                for _ in range(3):
                    start = time.process_time()
                    for n in few:
                        library.trace(ctypes.c_double((h1[n] * math.pi) ** 2), ctypes.c_double(1 / 25), ctypes.c_long(ratios[n].numerator),
                                      ctypes.c_long(ratios[n].denominator))
                    seconds.append(time.process_time() - start)
                row["plain_microseconds"] = 1e6 * min(seconds) / len(few)
            rows.append(row)
    print(json.dumps({"program": kd.__version__, "rows": rows}, indent=2))


if __name__ == "__main__":
    main()
