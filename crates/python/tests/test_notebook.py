"""The notebooks run from start to end."""

import jupytext
import nbclient
import pytest

from conftest import ROOT

NOTEBOOKS = sorted((ROOT / "crates" / "python" / "notebooks").glob("*.py"))


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebook(path):
    notebook = jupytext.read(path)
    nbclient.NotebookClient(notebook, timeout=120, kernel_name="python3").execute()
    shown = [
        output["data"]["text/html"]
        for cell in notebook.cells
        for output in cell.get("outputs", [])
        if "text/html" in output.get("data", {})
    ]
    # Results show their sentences and tables.
    assert any("gyro_y.g_z" in html for html in shown)
