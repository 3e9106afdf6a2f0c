"""The site: `make docs` builds it into build/docs, without a request to any other host."""

import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE / "_ext"))

from treadload import __version__  # noqa: E402

project = "treadload"
author = "The treadload developers"
copyright = author
version = release = __version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx_design",
    "sphinx_gallery.gen_gallery",
    "house_reference",
    "house_math",
    "house_offline",
    "executed_pages",
]
executed_pages = ["tutorials/*.md", "coming_from/*.md"]
exclude_patterns = [
    "_ext",
    "gallery",
    "validation_gallery",
    "auto_*/*.ipynb",
    "auto_*/*.py",
    "**/sg_execution_times.rst",
]
root_doc = "index"

myst_enable_extensions = ["dollarmath", "deflist", "colon_fence"]
myst_heading_anchors = 4

# House docstrings speak of `names`: links where one is known, code where not.
default_role = "py:obj"
autodoc_typehints = "signature"
autodoc_typehints_format = "short"
autodoc_preserve_defaults = True
autodoc_member_order = "bysource"
autodoc_class_signature = "mixed"
python_maximum_signature_line_length = 72
python_use_unqualified_type_names = True
toc_object_entries = False

sphinx_gallery_conf = {
    "examples_dirs": ["gallery", "validation_gallery"],
    "gallery_dirs": ["auto_gallery", "auto_validation"],
    "filename_pattern": r"/plot_",
    "download_all_examples": False,
    "show_signature": False,
    "show_memory": False,
    "write_computation_times": False,
    "remove_config_comments": True,
    "copyfile_regex": r"",
    "min_reported_time": 1e9,
    "image_scrapers": "house_gallery.figures",
    "capture_repr": (),
    "within_subsection_order": "FileNameSortKey",
}

html_theme = "pydata_sphinx_theme"
html_title = "treadload"
html_static_path = ["_static"]
html_css_files = ["house.css"]
html_js_files = ["filter_table.js", "gallery_links.js"]
html_favicon = "_static/mark.svg"
html_show_sourcelink = False
html_copy_source = False
html_math_renderer = "mathtext"
html_context = {"default_mode": "auto"}
html_theme_options = {
    "logo": {"text": "treadload", "image_light": "_static/mark.svg", "image_dark": "_static/mark.svg"},
    "navbar_align": "left",
    "navbar_end": ["theme-switcher"],
    "navigation_with_keys": False,
    "show_prev_next": True,
    "secondary_sidebar_items": ["page-toc"],
    "footer_start": ["copyright"],
    "footer_end": [],
    "header_links_before_dropdown": 7,
    "pygments_light_style": "a11y-high-contrast-light",
    "pygments_dark_style": "a11y-high-contrast-dark",
}
html_sidebars = {"index": [], "changes": [], "auto_gallery/index": []}
