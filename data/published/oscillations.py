#!/usr/bin/env python3
"""The table of python/examples/runs.py as JSON: growth of small oscillations of four flexible waters in OpenMM beside its prediction. Needs
kickdrift with its OpenMM extra, and pandas."""

import json
import runpy
from importlib.metadata import version
from pathlib import Path

example = Path(__file__).parents[2] / "python" / "examples" / "runs.py"
table = runpy.run_path(str(example))["table"]
table["inner steps"] = table["inner steps"].astype(int)
columns = {"inner steps": "inner", "minimum (1/ps)": "minimum", "orbit (1/ps)": "orbit", "OpenMM's run (1/ps)": "run"}
rows = [{"outer": outer, **row} for outer, row in table.rename(columns=columns).to_dict("index").items()]
print(json.dumps({"openmm": version("openmm"), "unit": "1/ps", "rows": rows}, indent=2))
