"""The modules of the package: which imports which."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from graphlib import TopologicalSorter
from pathlib import Path

import kickdrift

FOLDER = Path(kickdrift.__file__).parent
#: By name, but for the package itself, which is imported before any of its modules.
MODULES = {
    ".".join(("kickdrift", *path.relative_to(FOLDER).with_suffix("").parts)).removesuffix(".__init__"): path
    for path in FOLDER.rglob("*.py")
    if path != FOLDER / "__init__.py"
}


def imports(tree: ast.AST) -> Iterator[str]:
    """The modules of the package that are imported in a syntax tree, in functions and for types alone, too."""
    for node in ast.walk(tree):
        names = []
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            names = [f"{node.module}", *(f"{node.module}.{alias.name}" for alias in node.names)]
        yield from (name for name in names if name in MODULES)


def test_no_modules_import_each_other_in_a_circle() -> None:
    needed = {name: set(imports(ast.parse(path.read_text()))) for name, path in MODULES.items()}
    assert "kickdrift._document" in needed["kickdrift._verdict"]
    # It raises an error that names the circle.
    order = list(TopologicalSorter(needed).static_order())
    assert order.index("kickdrift._errors") < order.index("kickdrift.openmm")


def test_no_function_imports_a_module_of_the_package() -> None:
    for name, path in MODULES.items():
        functions = (node for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.FunctionDef))
        assert [found for function in functions for found in imports(function)] == [], name
