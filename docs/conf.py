"""How Sphinx builds the site; `make docs` calls it.

The source folder is the repository's root, so that the links from pages to code, notebooks and
ARCHITECTURE.md are the same here as on the page of the repository.
"""

from __future__ import annotations

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE / "extensions"), str(HERE.parent)]

import glid_nb  # noqa: E402

project = "glid_nb"
author = "The glid_nb authors"
copyright = f"2026, {author}"
version = release = glid_nb.__version__

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx_copybutton",
    # In docs/extensions.
    "attachments",
    "course",
    "front_page",
    "live_gecko",
    "mathml",
    "narrow_figures",
    "pictures",
    "printed",
    "proof_checker",
    "reference",
    "scrolled_figures",
    "source_pages",
]

root_doc = "docs/index"
include_patterns = ["docs/**", "notebooks/*.ipynb", "ARCHITECTURE.md", "CHANGELOG.md"]
exclude_patterns = [
    ".*",
    "**/.ipynb_checkpoints",
    "artefacts",
    "build",
    "dist",
    "glid_nb",
    "glid-nb-*",
    "node_modules",
    "site",
    "slides",
    "student",
    "docs/templates",
    "studies",
    "tests",
]
default_role = "py:obj"
pygments_style = "tango"

html_math_renderer = "mathml"
# Notebooks show what they were saved with.
nb_execution_mode = "off"
nb_merge_streams = True
# Cells with the tag hide-input: the set-up of a chapter, and checks.
nb_code_prompt_show = "Show the code"
nb_code_prompt_hide = "Hide the code"
# Saved outputs have no widgets; nothing is fetched for them.
nb_ipywidgets_js: dict[str, dict[str, str]] = {}
nb_mime_priority_overrides = [("html", "application/vnd.jupyter.widget-view+json", None)]
myst_enable_extensions = ["amsmath", "colon_fence", "deflist", "dollarmath", "attrs_inline"]
myst_heading_anchors = 4
myst_dmath_double_inline = True

autodoc_member_order = "bysource"
autodoc_preserve_defaults = True
autodoc_typehints = "none"
napoleon_google_docstring = False
napoleon_use_rtype = False
napoleon_attr_annotations = False
python_use_unqualified_type_names = True
python_maximum_signature_line_length = 110
toc_object_entries = False
add_module_names = False

copybutton_prompt_text = r">>> |\.\.\. |\$ "
copybutton_prompt_is_regexp = True

html_theme = "pydata_sphinx_theme"
html_title = "glid_nb"
templates_path = ["templates"]
html_static_path = ["static"]
html_css_files = ["site.css"]
# Read from disk, a page may not fetch others for the summaries of search results.
_NO_SUMMARY = "DOCUMENTATION_OPTIONS.SHOW_SEARCH_SUMMARY = false"
html_js_files = [(None, {"body": f"if (location.protocol === 'file:') {_NO_SUMMARY};"})]
html_favicon = "static/mark.svg"
html_show_sourcelink = False
html_copy_source = False
html_show_sphinx = False
html_last_updated_fmt = None
html_sidebars = {"docs/index": []}
html_context = {"default_mode": "auto"}
html_theme_options = {
    "logo": {
        "text": "glid_nb",
        "alt_text": "glid_nb, to the start page",
        "image_light": "_static/mark.svg",
        "image_dark": "_static/mark-dark.svg",
    },
    "header_links_before_dropdown": 6,
    "navbar_align": "left",
    "navigation_depth": 3,
    "show_toc_level": 2,
    "secondary_sidebar_items": ["download-notebook", "page-toc"],
    "show_prev_next": True,
    "footer_start": ["copyright"],
    "footer_end": [],
    "pygments_light_style": "tango",
    "pygments_dark_style": "github-dark",
}
