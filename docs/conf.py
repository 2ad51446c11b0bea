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
    "code_role",
    "command_help",
    "config_reference",
    "core_signatures",
    "module_pages",
    "navigation",
    "pydrake_system",
    "property_docstrings",
    "repository_links",
    "repository_pages",
    "system_pages",
    "template_systems",
    "wordy_cells",
]
exclude_patterns = ["_build", "**.ipynb_checkpoints"]

default_role = "code-or-link"
smartquotes_action = "qe"  # no dashes: --headless is an option in sentences too

autoclass_content = "both"  # constructors are documented where they are
autodoc_default_options = {"members": True}
autodoc_member_order = "bysource"
autodoc_use_type_comments = False  # there are none; it would parse every function
napoleon_google_docstring = True
napoleon_numpy_docstring = False
# What stands before a colon or in parentheses is a shape or a unit more often than a
# type; types are in the signatures.
napoleon_use_ivar = True
napoleon_use_param = False
napoleon_use_rtype = False
toc_object_entries = False  # the navigation would name every method, and take minutes
# What is of others is described on other hosts. Names of ours are all found.
nitpick_ignore_regex = [
    ("py:.*", r"(?!drake_haptics\.).*"),
    ("py:class", r"drake_haptics\..*\._.*"),  # private bases and type variables
    ("py:class", r"drake_haptics\.evaluation\.accuracy\.knob_values\.Number"),
]

nb_execution_mode = "off"  # the tests run the notebooks
myst_enable_extensions = ["tasklist"]  # no maths: MathJax is on another host
myst_heading_anchors = 4  # the anchors that a code host gives to headings

html_theme = "furo"
html_static_path = ["_static"]
html_favicon = "_static/favicon.svg"
html_css_files = ["reference.css"]
html_search_scorer = str(Path(__file__).parent / "_static" / "searchscorer.js")
html_domain_indices = False  # the page of modules is made by hand
html_show_copyright = False
html_show_sphinx = False
html_copy_source = False
