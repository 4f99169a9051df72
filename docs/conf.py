"""How the documentation is built: Markdown pages, the reference from docstrings, nothing fetched from
elsewhere."""

import re

from docutils import nodes

from coursework import __version__
from coursework.markup.mathml import to_mathml

project = "coursework"
author = "the authors of coursework"
version = release = __version__
html_title = "coursework"

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
myst_enable_extensions = ["attrs_inline", "dollarmath"]
myst_heading_anchors = 3
exclude_patterns = ["gallery.py", "import_graph.py"]

html_theme = "furo"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_extra_path = ["gallery/whole"]
html_copy_source = False
html_show_sphinx = False
html_show_copyright = False
html_math_renderer = "mathml"

autodoc_member_order = "bysource"
autodoc_typehints = "signature"
maximum_signature_line_length = 88
napoleon_google_docstring = False
napoleon_use_rtype = False
napoleon_custom_sections = ["Source", "Gives"]

add_module_names = False

#: Text between double backquotes, or a bar: |x| is a size in the docstrings, a substitution to docutils.
_LITERAL_OR_BAR = re.compile(r"(``.+?``)|\|")
#: A section of returned values whose lines are not indented: sentences, where a list of names is expected.
_RETURNS = re.compile(r"^Returns\n-+\n((?:\S.*\n?)+)(?=\n|\Z)", re.MULTILINE)
_plain: dict[str, list[str]] = {}


def _as_written(app, what, name, obj, options, lines):
    text = "\n".join(_LITERAL_OR_BAR.sub(lambda m: m[1] or r"\|", line) for line in lines)
    lines[:] = _RETURNS.sub(r"Gives\n-----\n\1", text).splitlines()
    _plain[name] = list(lines)


def _colons_are_colons(app, what, name, obj, options, lines):
    """A colon in the sentence of an attribute does not end a type."""
    if what in ("attribute", "property") and any(line.startswith(":type:") for line in lines):
        lines[:] = _plain[name]


def _mathml(translator, node):
    """Formulas are MathML, as on the sheets: no script, nothing fetched."""
    translator.body.append(to_mathml(node.astext(), "en", display=node.tagname == "math_block"))
    raise nodes.SkipNode


_PARAMETERS = re.compile(r"<dl>((?:\s*<dd>.*?</dd>)+\s*)</dl>", re.DOTALL)


def _for_everybody(app, pagename, templatename, context, doctree):
    """What scrolls sideways is reached by keyboard; the parameters of a signature are not a list of
    definitions."""
    if pagename.endswith(".fr"):
        context["language"] = "fr"
    body = context.get("body", "")
    body = body.replace("<pre>", '<pre tabindex="0">')
    body = body.replace('<div class="table-wrapper', '<div tabindex="0" class="table-wrapper')
    context["body"] = _PARAMETERS.sub(
        lambda m: (
            '<span class="parameters">'
            + m[1].replace("<dd>", "<span>").replace("</dd>", "</span>")
            + "</span>"
        ),
        body,
    )


#: What stands in French before its marks and within its quotation marks: a space that does not break. Code
#: stays.
_FRENCH = re.compile(
    r"(^(`{3,}).*?^\2$|`[^`\n]*`)|(?<=\S) (?=[;:!?»](?:\s|$))|(?<=«) ", re.MULTILINE | re.DOTALL
)


def _french(app, docname, source):
    if docname.endswith(".fr"):
        source[0] = _FRENCH.sub(lambda m: m[1] or "\N{NARROW NO-BREAK SPACE}", source[0])


def setup(app):
    app.connect("source-read", _french)
    app.add_html_math_renderer("mathml", (_mathml, None), (_mathml, None))
    app.connect("html-page-context", _for_everybody)
    app.connect("autodoc-process-docstring", _as_written, priority=400)
    app.connect("autodoc-process-docstring", _colons_are_colons, priority=600)
