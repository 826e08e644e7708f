# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The documentation as a site: `./walk docs`."""

project = "Walkthrough planner"
author = "The walkthrough planner's authors"
copyright = author
extensions = ["myst_parser"]
source_suffix = {".md": "markdown"}
myst_heading_anchors = 3
html_theme = "furo"
html_title = project
html_static_path = ["_static"]
html_css_files = ["style.css"]
html_copy_source = False
html_show_sphinx = False
html_last_updated_fmt = None
exclude_patterns = ["conf.py", "make_pictures.py"]
# Links out of this folder are for readers of the repository; the blocks of design.md are signatures, not programs.
suppress_warnings = ["myst.xref_missing", "misc.highlighting_failure"]
