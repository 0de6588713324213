# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Modules of the package import only lower modules: no circular imports, also not in functions or for type checks."""

import ast
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[2] / "python" / "glidar"


def module_name(path, root):
    """Dotted name of a module of the package, relative to the package: '' for its __init__.py."""
    parts = path.relative_to(root).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def imported_names(tree, package):
    """Dotted names, relative to the root package, of everything that a module of `package` imports from the root."""
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.level:
            base = package[: len(package) - node.level + 1]
            source = [*base, *(node.module.split(".") if node.module else [])]
            yield from (".".join([*source, alias.name]) for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module and node.module.split(".")[0] == "glidar":
            source = node.module.split(".")[1:]
            yield from (".".join([*source, alias.name]) for alias in node.names)
        elif isinstance(node, ast.Import):
            yield from (alias.name.partition(".")[2] for alias in node.names if alias.name.split(".")[0] == "glidar")


def imports_of(root):
    """The modules of a package that each of its modules imports."""
    paths = {module_name(path, root): path for path in root.rglob("*.py")}
    graph = {}
    for name, path in paths.items():
        package = name.split(".") if path.name == "__init__.py" and name else name.split(".")[:-1]
        found = set()
        for imported in imported_names(ast.parse(path.read_text(encoding="utf-8")), package):
            while imported and imported not in {*paths, "_core"}:  # a name in a module; _core is the extension
                imported = imported.rpartition(".")[0]
            found.add(imported)
        graph[name] = found - {"_core"}
    return graph


def find_cycle(graph):
    """Modules that import each other in a circle, in order; empty when there is none."""
    done, path = set(), []

    def visit(name):
        if name in path:
            return [*path[path.index(name) :], name]
        if name in done:
            return []
        path.append(name)
        cycle = next((found for found in map(visit, sorted(graph[name])) if found), [])
        path.pop()
        done.add(name)
        return cycle

    return next((found for found in map(visit, sorted(graph)) if found), [])


def test_modules_have_no_circular_imports():
    graph = imports_of(PACKAGE)
    assert {"_scene", "_frame"} <= graph["_simulate"]
    assert " -> ".join(find_cycle(graph)) == ""


@pytest.mark.parametrize(
    "statement",
    [
        "from .low import x",
        "from . import low",
        "import glidar.low",
        "from glidar.low import x",
        "def f():\n    from .low import x",
        "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from .low import x",
    ],
)
def test_circles_by_every_kind_of_import_are_found(tmp_path, statement):
    (tmp_path / "__init__.py").write_text("from .high import x\n")
    (tmp_path / "high.py").write_text(statement + "\n")
    (tmp_path / "low.py").write_text("from .high import y\n")
    assert find_cycle(imports_of(tmp_path)) == ["high", "low", "high"]
