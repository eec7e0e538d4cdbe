"""The types of the package, as a type checker sees them in the wheel."""

import subprocess
import sys

import pytest
from conftest import ROOT

PACKAGE = ROOT / "crates" / "python"


@pytest.mark.parametrize("source", ["tests/typed_use.py", "python/gyrocal"])
def test_a_type_checker_accepts_what_is_right_and_refuses_what_is_wrong(tmp_path, source):
    file = PACKAGE / source
    if file.is_file():
        # Outside of the tree, so that the package is the installed one.
        file = tmp_path / file.name
        file.write_text((PACKAGE / source).read_text())
    call = [sys.executable, "-m", "mypy", "--strict", "--cache-dir", str(tmp_path / "cache")]
    # Arrow has no types of its own.
    call += ["--allow-untyped-calls", "--disable-error-code", "import-untyped", str(file)]
    checked = subprocess.run(call, cwd=tmp_path, capture_output=True, text=True)
    assert checked.returncode == 0, checked.stdout + checked.stderr
