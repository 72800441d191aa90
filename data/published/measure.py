#!/usr/bin/env python3
"""The share of Figure 1's window that is unstable, from certified tongues along rays: measure.py PROGRAM MAX_SUM; JSON.

On the ray h2 = h1 p/q the unstable set is the tongues, certified; in polar coordinates it covers the sum of
(r_upper^2 - r_lower^2)/2 an angle, cut to the window. Each ray p + q <= MAX_SUM stands for the angles nearer to it than to its
neighbours. The tongues of each ray are certified, and so are their lengths; that a ray speaks for its neighbourhood is an assumption.
"rays" is the plain sum over the rays, proven: the length of all tongues in the window over the length of all rays in it.
"""

import csv
import io
import json
import math
import subprocess
import sys

H1, H2 = 2 / math.pi, 3.5


def main(program, max_sum):
    command = [program, "tongues", "--max-sum", max_sum, "--lambda1", "pi^2", "--lambda2", "pi^2/25", "--columns", "edges", "--quiet",
               "--h1-range", "0..2/pi", "--h2-range", "0..7/2", "--format", "csv"]
    text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    tongues = {}
    for row in csv.DictReader(io.StringIO(text)):
        # Inwards: what is counted is inside the certified edges. The last tongue has no end.
        end = float(row["upper_h1_lo"]) if row["upper_h1_lo"] else math.inf
        tongues.setdefault((int(row["p"]), int(row["q"])), []).append((float(row["lower_h1_hi"]), end))
    n = int(max_sum)
    rays = sorted((math.atan2(p, q), p, q) for p in range(1, n) for q in range(1, n - p + 1) if math.gcd(p, q) == 1)
    angles = [0.0, *(angle for angle, _, _ in rays), math.pi / 2]
    unstable = window = length = proven = 0.0
    for i, (_, p, q) in enumerate(rays, 1):
        share = (angles[i + 1] - angles[i - 1]) / 2
        if i == 1:
            share += angles[1] / 2
        if i == len(rays):
            share += (math.pi / 2 - angles[-2]) / 2
        last = min(H1, H2 * q / p)
        square = 1 + (p / q) ** 2
        window += share * square * last**2 / 2
        length += math.sqrt(square) * last
        for lower, upper in tongues.get((p, q), []):
            upper = min(upper, last)
            proven += math.sqrt(square) * max(0.0, upper - lower)
            unstable += share * square * max(0.0, upper**2 - lower**2) / 2
    print(json.dumps({"max_sum": n, "ratios": len(rays), "share": unstable / window, "window": window / (H1 * H2),
                      "rays": {"unstable": proven, "length": length, "share": proven / length}}, indent=2))


if __name__ == "__main__":
    main(*sys.argv[1:])
