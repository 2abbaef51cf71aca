# SPDX-License-Identifier: Apache-2.0
"""Sphinx's settings of the documentation site; assemble.py makes the pages that it reads."""

import os
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
_ROOT = pathlib.Path(__file__).resolve().parents[2]

project = "Polhode"
author = "the Polhode authors"
project_copyright = author
version = release = os.environ.get("POLHODE_DOCS_VERSION") or re.search(r"project\(polhode VERSION (\d+\.\d+\.\d+)", (_ROOT / "CMakeLists.txt").read_text())[1]
language = "en"

extensions = ["myst_parser", "mathml", "tables"]
source_suffix = {".md": "markdown"}
myst_enable_extensions = ["dollarmath", "colon_fence"]
myst_dmath_double_inline = True
myst_heading_anchors = 4
myst_links_external_new_tab = False
# Tables of keys start at the second level in some pages on purpose.
suppress_warnings = ["myst.header"]

html_theme = "furo"
html_title = f"Polhode {version}"
html_static_path = ["static"]
templates_path = ["templates"]
exclude_patterns = ["extra", "static"]
html_css_files = ["site.css"]
# Other versions lie beside this one: scripts/docs.sh --version.
html_js_files = ["gallery.js", *(["versions_menu.js"] if os.environ.get("POLHODE_DOCS_VERSION") else [])]
html_math_renderer = "mathml"
html_copy_source = False
html_show_sphinx = False
html_permalinks_icon = "#"
html_theme_options = {
    "sidebar_hide_name": False,
    "light_css_variables": {"color-brand-primary": "#1f5fa8", "color-brand-content": "#1f5fa8"},
    "dark_css_variables": {"color-brand-primary": "#7fb2ea", "color-brand-content": "#7fb2ea"},
}
pygments_style = "a11y-high-contrast-light"
pygments_dark_style = "a11y-high-contrast-dark"
