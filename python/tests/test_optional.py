"""What is not installed is asked for by its name."""

from __future__ import annotations

import importlib
import subprocess
import sys
from collections.abc import Callable
from typing import Any

import pytest

import kickdrift as kd
from kickdrift import _scipy

GRID: dict[str, Any] = {"lambda1": 1, "lambda2": 1, "step": "1/4", "h1": ("1/4", 1), "h2": ("1/4", 1)}


@pytest.mark.parametrize(
    ("package", "missing", "use"),
    [
        ("pandas", "pandas", lambda: kd.tongues("5/3", rho=1).to_pandas()),
        ("pandas", "pandas", lambda: kd.verdicts(lambda1=1, lambda2=1, h1=1, h2=[1]).to_pandas()),
        ("pandas", "pandas", lambda: kd.map(**GRID).to_pandas()),
        ("xarray", "xarray", lambda: kd.map(**GRID).to_xarray()),
        ("matplotlib.pyplot", "matplotlib", lambda: kd.map(**GRID).plot()),
        ("anywidget", "anywidget", lambda: kd.explore(lambda1=1, lambda2=1)),
        ("openmm", "openmm", lambda: importlib.import_module("kickdrift.openmm")),
        ("scipy.sparse", "scipy", lambda: _scipy.sparse.identity(3)),
        ("ase", "ase", lambda: importlib.import_module("kickdrift.ase")),
        ("zarr", "dask and xarray and zarr", lambda: importlib.import_module("kickdrift.dask")),
    ],
)
def test_what_is_not_installed_is_named(
    package: str, missing: str, use: Callable[[], Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    for module in ("openmm", "_openmm", "ase", "dask"):
        monkeypatch.delitem(sys.modules, f"kickdrift.{module}", raising=False)
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(kd.KickdriftError, match=f"not installed: install {missing} beside kickdrift"):
        use()


def test_openmm_is_read_without_scipy() -> None:
    code = "import sys; sys.modules.update({'scipy': None, 'scipy.sparse': None}); import kickdrift.openmm"
    assert subprocess.run([sys.executable, "-P", "-c", code]).returncode == 0
