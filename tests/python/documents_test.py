# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""The Python code of README.md, of the pages about Python and of the notebook works."""

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


@pytest.mark.parametrize("name", ["README.md", "docs/python.md"])
def test_python_code_of_a_page_runs(name, folder):
    found = blocks(name)
    assert found
    names = {}
    for block in found:
        exec(compile(block, name, "exec"), names)


def test_every_public_name_has_a_docstring_and_is_documented():
    text = (ROOT / "docs/python.md").read_text(encoding="utf-8")
    for name in glidar.__all__:
        assert getattr(glidar, name).__doc__, name
        assert re.search(rf"\b{name}\b", text), name


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
