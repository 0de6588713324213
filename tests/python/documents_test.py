# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The Python code of README.md, of the pages about Python and of the notebook works."""

import inspect
import json
import os
import re

import pytest
from conftest import ROOT
from waiting import MAX_WAIT_S

import glidar


def blocks(name):
    text = (ROOT / name).read_text(encoding="utf-8")
    return re.findall(r"```python\n(.*?)```", text, re.DOTALL)


@pytest.fixture
def folder(tmp_path, monkeypatch):
    for shown in ("models", "examples"):
        (tmp_path / shown).symlink_to(ROOT / shown)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "Agg")
    return tmp_path


@pytest.mark.parametrize("name", ["README.md", "docs/python.md", "docs/python/reference.md"])
def test_python_code_of_a_page_runs(name, folder):
    found = blocks(name)
    assert found
    names = {}
    for block in found:
        exec(compile(block, name, "exec"), names)


def test_every_public_name_has_a_docstring_and_is_documented():
    text = (ROOT / "docs/python/reference.md").read_text(encoding="utf-8")
    for name in glidar.__all__:
        assert getattr(glidar, name).__doc__, name
        assert re.search(rf"\b{name}\b", text), name


def calls(text):
    """Names and arguments of the calls in the first columns of the tables."""
    for row in re.findall(r"^\| (`.*?) \| ", text, re.MULTILINE):
        yield from re.findall(r"`(\w[\w.]*)\((.*?)\)`", row)


def named(name):
    """What a name of the table is: scene.bounds is that of the class Scene."""
    owner, _, method = name.rpartition(".")
    return getattr(getattr(glidar, owner[0].upper() + owner[1:]), method) if owner else getattr(glidar, name)


def test_the_reference_tables_list_the_arguments_of_the_functions():
    found = list(calls((ROOT / "docs/python/reference.md").read_text(encoding="utf-8")))
    assert len(found) > 20
    for name, text in found:
        parameters = {key: one for key, one in inspect.signature(named(name)).parameters.items() if key != "self"}
        kinds = {one.kind for one in parameters.values()}
        words = [] if "{" in text else [word for word in re.split(r", | or ", text) if word]
        positional = words.index("*") if "*" in words else len(words)
        listed = [word.partition("=") for word in words if word not in ("*", "...")]
        for place, (word, _, default) in enumerate(listed):
            if word not in parameters:
                assert inspect.Parameter.VAR_KEYWORD in kinds, f"{name} has no {word}"
                continue
            if default and default != "...":
                assert repr(parameters[word].default) == default, f"{name}, {word}"
            if place >= positional:
                assert parameters[word].kind is inspect.Parameter.KEYWORD_ONLY, f"{name}, {word}"
        if words and "..." not in text and inspect.Parameter.VAR_KEYWORD not in kinds:
            assert {word for word, _, _ in listed} == set(parameters), name


NOTEBOOK = ROOT / "examples/notebooks/first_steps.ipynb"


def test_the_notebook_is_stored_without_outputs():
    nbformat = pytest.importorskip("nbformat")
    for cell in nbformat.read(NOTEBOOK, as_version=4).cells:
        if cell.cell_type == "code":
            assert cell.outputs == []
            assert cell.execution_count is None


def test_the_notebook_reports_where_to_start_it(tmp_path, monkeypatch):
    cells = json.loads(NOTEBOOK.read_text(encoding="utf-8"))["cells"]
    first = next(cell for cell in cells if cell["cell_type"] == "code")
    monkeypatch.chdir(tmp_path)
    with pytest.raises(FileNotFoundError, match="no models/satellite/.* start the notebook in a clone of GLIDAR"):
        exec("".join(first["source"]), {})


@pytest.mark.parametrize("started_from", [NOTEBOOK.parent, ROOT], ids=["its own folder", "the clone"])
def test_the_notebook_runs_from_folder(started_from):
    nbclient = pytest.importorskip("nbclient")
    nbformat = pytest.importorskip("nbformat")
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    before = sorted(os.listdir(started_from))
    nbclient.NotebookClient(notebook, timeout=MAX_WAIT_S, resources={"metadata": {"path": str(started_from)}}).execute()
    shown = [out for cell in notebook.cells if cell.cell_type == "code" for out in cell.outputs]
    assert any("image/png" in out.get("data", {}) for out in shown)
    assert sorted(os.listdir(started_from)) == before
