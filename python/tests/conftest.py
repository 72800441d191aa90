"""What all tests share."""

from __future__ import annotations

import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import matplotlib as mpl
import pytest

mpl.use("Agg")

REPOSITORY = Path(__file__).parents[2]


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--heavy", action="store_true", help="run what takes minutes, too: runs of engines")


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    if not config.getoption("--heavy"):
        for item in items:
            if item.get_closest_marker("heavy"):
                item.add_marker(pytest.mark.skip(reason="takes minutes: give --heavy"))


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
