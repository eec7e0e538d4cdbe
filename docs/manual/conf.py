"""The manual: Sphinx with MyST over the pages that stage.py lays out."""

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "crates/python/python"))

project = "gyrocal"
author = "the authors of gyrocal"
root_doc = "docs/index"
language = "en"

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
# Slugs of headings down to this level are targets of links, as a forge makes them.
myst_heading_anchors = 4
myst_enable_extensions = ["attrs_inline"]

# The package is described from its sources: what is compiled or large is not imported.
autodoc_mock_imports = ["gyrocal._gyrocal", "numpy", "pyarrow"]
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
napoleon_numpy_docstring = False

html_theme = "furo"
html_title = "gyrocal"
html_show_copyright = False
html_copy_source = False
html_show_sourcelink = False
