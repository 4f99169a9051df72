"""How the documentation is built: Markdown pages, the reference from docstrings, nothing fetched from elsewhere."""

import re

from docutils import nodes

from coursework import __version__
from coursework.rendering.formulas import to_mathml

project = "coursework"
author = "the authors of coursework"
version = release = __version__
html_title = "coursework"

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
myst_enable_extensions = ["attrs_inline", "colon_fence"]
myst_heading_anchors = 3
exclude_patterns = ["gallery.py"]

html_theme = "furo"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_copy_source = False
html_show_sphinx = False
html_show_copyright = False
html_math_renderer = "mathml"

autodoc_member_order = "bysource"
autodoc_typehints = "description"
autodoc_typehints_description_target = "documented"
autodoc_class_signature = "separated"
napoleon_google_docstring = False
napoleon_use_rtype = False

add_module_names = False

#: Text between double backquotes, or a bar: |x| is a size in the docstrings, a substitution to docutils.
_LITERAL_OR_BAR = re.compile(r"(``.+?``)|\|")


def _bars_are_sizes(app, what, name, obj, options, lines):
    lines[:] = [_LITERAL_OR_BAR.sub(lambda m: m[1] or r"\|", line) for line in lines]


def _mathml(translator, node):
    """Formulas are MathML, as on the sheets: no script, nothing fetched."""
    translator.body.append(to_mathml(node.astext(), "en", display=node.tagname == "math_block"))
    raise nodes.SkipNode


def setup(app):
    app.add_html_math_renderer("mathml", (_mathml, None), (_mathml, None))
    app.connect("autodoc-process-docstring", _bars_are_sizes)
