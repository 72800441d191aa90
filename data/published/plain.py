#!/usr/bin/env python3
"""What the plain loop gets wrong: plain.py PROGRAM; JSON. Needs NumPy and a C compiler; half a minute.

The plain loop multiplies all kicks and drifts of a period in doubles (plain.c) and calls a pair unstable when |Tr Q| > 2, or when an
eigenvalue of Q, as LAPACK computes it, has a modulus above 1 + tolerance. Each pair of each grid is held against the program's
verdict, which is certified or exact. "tongues" counts those with p + q <= 60 that reach into the window of the paper, and those of
them that hold a pair of the finest grid. "near_edges" takes the loop to random places at relative distances of 10^-k to 10^-(k+1) in s
from random edges, on either side, of the tongues of one ratio: there the verdict is known from the certified edges.
"""

import csv
import ctypes
import io
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

SOURCE = Path(__file__).with_suffix(".c")
TOLERANCES = [0.0, 1e-12, 1e-9, 1e-6]
WINDOW = ("pi^2", "pi^2/25", "2/pi", "7/2")
ROUND = ("1", "1/25", "2", "11")
RATIOS = [(7, 3), (67, 33), (667, 333), (6667, 3333)]
PLACES = 1000
GRIDS = [(WINDOW, 100), (WINDOW, 200), (WINDOW, 500), (WINDOW, 1000), (ROUND, 20), (ROUND, 100), (ROUND, 200)]


def number(text):
    return eval(text.replace("^", "**"), {"pi": math.pi})


def certified(program, scene, n, folder):
    """The verdicts of the grid, kinds in the order of the archive's names, columns h1, rows h2."""
    file = folder / "map.npz"
    lambda1, lambda2, h1, h2 = scene
    subprocess.run([program, "map", "--lambda1", lambda1, "--lambda2", lambda2, "--step", f"1/{n}", "--h1-range", f"1/{n}..{h1}",
                    "--h2-range", f"1/{n}..{h2}", "--quiet", "--output", str(file)], check=True)
    with np.load(file) as archive:
        names = [name.decode().rstrip("+-") for name in archive["verdict_names"]]
        return names, archive["verdict"]


def products(library, scene, n, shape):
    """The propagators over the full period in doubles."""
    found = np.empty((*shape, 2, 2))
    library.full_periods(ctypes.c_double(number(scene[0])), ctypes.c_double(number(scene[1])), ctypes.c_long(n), ctypes.c_long(shape[0]),
                         ctypes.c_long(shape[1]), found.ctypes.data_as(ctypes.c_void_p))
    return found


def compared(program, library, scene, n, folder):
    names, verdict = certified(program, scene, n, folder)
    unstable = np.array([name in ("hyperbolic", "parabolic") for name in names])[verdict]
    on_edge = np.array([name in ("parabolic", "coexistence") for name in names])[verdict]
    q = products(library, scene, n, verdict.shape)
    trace = q[..., 0, 0] + q[..., 1, 1]
    finite = np.isfinite(q).all(axis=(-2, -1))
    radius = np.full(verdict.shape, np.inf)
    radius[finite] = np.abs(np.linalg.eigvals(q[finite])).max(axis=-1)

    def wrong(claimed):
        return {"stable_called_unstable": int((claimed & ~unstable).sum()), "unstable_called_stable": int((~claimed & unstable).sum()),
                "wrong": int((claimed != unstable).sum())}

    return {"lambda1": scene[0], "lambda2": scene[1], "h1_up_to": scene[2], "h2_up_to": scene[3], "step": f"1/{n}", "pairs": verdict.size,
            "unstable": int(unstable.sum()), "on_an_edge": int(on_edge.sum()), "overflow": int((~finite).sum()),
            "trace": {**wrong(~(np.abs(trace) <= 2)), "wrong_on_an_edge": int(((~(np.abs(trace) <= 2)) != unstable)[on_edge].sum())},
            "spectral_radius": [{"tolerance": tolerance, **wrong(radius > 1 + tolerance)} for tolerance in TOLERANCES]}


def seen(program, n):
    """Of the tongues with p + q <= 60 in the window, those that hold a pair of multiples of 1/n."""
    command = [program, "tongues", "--max-sum", "60", "--lambda1", "pi^2", "--lambda2", "pi^2/25", "--columns", "edges", "--quiet",
               "--h1-range", "0..2/pi", "--h2-range", "0..7/2", "--format", "csv"]
    rows = list(csv.DictReader(io.StringIO(subprocess.run(command, check=True, capture_output=True, text=True).stdout)))
    held = 0
    for row in rows:
        p, q = int(row["p"]), int(row["q"])
        last = min(2 / math.pi, 3.5 * q / p)
        upper = min(float(row["upper_h1_hi"]) if row["upper_h1_hi"] else math.inf, last)
        # The pairs of this ratio are the multiples of q/n in h1.
        held += math.floor(upper * n / q) >= math.ceil(float(row["lower_h1_lo"]) * n / q)
    return {"max_sum": 60, "step": f"1/{n}", "tongues": len(rows), "held": held}


def near_edges(program, library, p, q):
    """The share of wrong verdicts by distance."""
    rng = np.random.default_rng(1)
    command = [program, "tongues", "--ratio", f"{p}/{q}", "--rho", "1/25", "--columns", "edges", "--m", f"1..{p - 1}",
               "--format", "csv", "--quiet"]
    rows = csv.DictReader(io.StringIO(subprocess.run(command, check=True, capture_output=True, text=True).stdout))
    ends = [(float(row[f"{end}_lo"]), float(row[f"{end}_hi"]), side) for row in rows for end, side in (("lower", 1), ("upper", -1))]
    # Edges whose neighbours on both sides are farther than the places looked at.
    edges = [edge for before, edge, after in zip(ends, ends[1:], ends[2:], strict=False)
             if min(edge[0] - before[1], after[0] - edge[1]) > 2e-8 * edge[0]]
    library.trace.restype = ctypes.c_double
    found = []
    for k in range(8, 16):
        wrong = 0
        for _ in range(PLACES):
            lo, hi, inwards = edges[rng.integers(len(edges))]
            inside = bool(rng.integers(2))
            away = 10.0 ** -(k + rng.random()) * lo
            s = hi + away if (inwards == 1) == inside else lo - away
            if lo <= s <= hi:
                continue
            claimed = not abs(library.trace(ctypes.c_double(s), ctypes.c_double(1 / 25), ctypes.c_long(p), ctypes.c_long(q))) <= 2
            wrong += claimed != inside
        found.append({"distance": f"1e-{k}", "wrong": wrong})
    return {"p": p, "q": q, "edges": len(edges), "places": PLACES, "distances": found}


def main(program):
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        built = folder / "plain.so"
        subprocess.run(["cc", "-O2", "-ffp-contract=off", "-shared", "-fPIC", "-o", str(built), str(SOURCE)], check=True)
        library = ctypes.CDLL(str(built))
        grids = [compared(program, library, scene, n, folder) for scene, n in GRIDS]
        near = [near_edges(program, library, p, q) for p, q in RATIOS]
    print(json.dumps({"grids": grids, "tongues": seen(program, 1000), "near_edges": near}, indent=2))


if __name__ == "__main__":
    main(*sys.argv[1:])
