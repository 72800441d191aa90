"""What the documentation promises of all that is public: an example that doctest runs, a word on every parameter."""

import importlib
import inspect
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import kickdrift as kd

MODULES = ("kickdrift.openmm", "kickdrift.ase", "kickdrift.lammps", "kickdrift.dask")


def public() -> Iterator[tuple[str, Any]]:
    """All functions, classes and methods by name; properties are part of their class."""
    named = [(name, getattr(kd, name)) for name in kd.__all__]
    for path in MODULES:
        module = importlib.import_module(path)
        named += [(f"{path}.{name}", getattr(module, name)) for name in module.__all__]
    for name, value in named:
        if inspect.isfunction(value):
            yield name, value
        elif inspect.isclass(value) and value.__module__.startswith("kickdrift."):
            yield name, value
            for kind in inspect.getmro(value):
                for method, found in vars(kind).items() if kind.__module__.startswith("kickdrift") else ():
                    found = getattr(found, "__func__", found)
                    if inspect.isfunction(found) and not method.startswith("_"):
                        yield f"{name}.{method}", found


PUBLIC = dict(public())
README = (Path(__file__).parents[2] / "README.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```python\n(.*?)^```$", README, re.MULTILINE | re.DOTALL)


def test_the_list_is_that_of_the_package() -> None:
    assert {"decide", "System.decide", "System.read", "Tongues.plot", "kickdrift.openmm.system"} <= PUBLIC.keys()


@pytest.mark.parametrize("name", PUBLIC)
def test_all_that_is_public_has_an_example(name: str) -> None:
    assert ">>> " in (inspect.getdoc(PUBLIC[name]) or "")


@pytest.mark.parametrize("name", [name for name, value in PUBLIC.items() if inspect.isfunction(value)])
def test_every_parameter_is_explained(name: str) -> None:
    words = inspect.getdoc(PUBLIC[name]) or ""
    told = re.search(r"^Parameters\n-+\n(.*?)(?=^\w[^\n]*\n-+\n|\Z)", words, re.MULTILINE | re.DOTALL)
    parameters = [given for given in inspect.signature(PUBLIC[name]).parameters if given not in ("self", "cls")]
    lines = re.findall(r"^\S.*", told[1], re.MULTILINE) if told else []
    explained = {word for line in lines for word in re.findall(r"\w+", line.split(":")[0])}
    assert not [given for given in parameters if given not in explained]


@pytest.mark.parametrize("block", BLOCKS, ids=lambda block: block.splitlines()[0])
def test_what_the_code_of_the_readme_prints_is_what_its_comments_say(
    block: str, capsys: pytest.CaptureFixture[str]
) -> None:
    exec(block, {})
    said = re.findall(r"^print\(.*\) +# (.*)$", block, re.MULTILINE)
    assert said and capsys.readouterr().out.splitlines() == said
