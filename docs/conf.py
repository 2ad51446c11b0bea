"""How the pages are made: Sphinx reads Markdown, docstrings and the code itself.

`make docs` builds them. Nothing here asks another host for anything.
"""

import sys
from importlib.metadata import version as installed_version
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "_ext"))

project = "drake_haptics"
release = installed_version("drake_haptics")
version = release
html_title = f"drake_haptics {release}"

extensions = [
    "myst_nb",  # Markdown and notebooks; notebooks are shown as they were saved
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "navigation",
    "readme_page",
    "repository_links",
    "repository_pages",
]
exclude_patterns = ["_build", "**.ipynb_checkpoints"]

nb_execution_mode = "off"  # the tests run the notebooks
myst_enable_extensions = ["colon_fence", "dollarmath"]
myst_heading_anchors = 4  # the anchors that a code host gives to headings

html_theme = "furo"
html_static_path = ["_static"]
html_show_sphinx = False
html_copy_source = False
