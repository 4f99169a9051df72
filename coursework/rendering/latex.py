"""Sheets as LaTeX source, for those who edit them: standard packages, pdflatex, the figure beside it."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from functools import lru_cache
from pathlib import Path

from jinja2 import Environment
from markdown_it.tree import SyntaxTreeNode

from coursework.errors import BadStatement
from coursework.figures import Figure, Picture
from coursework.markup import markdown as markup
from coursework.markup.latex import latex_text, plain_latex, to_latex
from coursework.rendering import views
from coursework.rendering.environment import environment, render

#: In a LaTeX template braces and percent signs are LaTeX's own.
MARKS = {
    "variable_start_string": "<<",
    "variable_end_string": ">>",
    "block_start_string": "<%",
    "block_end_string": "%>",
    "comment_start_string": "<#",
    "comment_end_string": "#>",
}
BABEL = {"fr": "french", "en": "english"}


def source(
    folders: Sequence[Path], sheet: views.Sheet, paper: str, figures: Sequence[str], polygons: Sequence[str]
) -> str:
    """Return the LaTeX source of one sheet; beside it are the PDF of its figure and that of its polygons."""
    lang = views.handout_of(sheet).lang
    names = {
        "paper": paper,
        "figure_file": figures[0],
        "polygons_file": polygons[0],
        "babel": BABEL.get(lang, lang),
    }
    env = environment_of(tuple(folders), lang)
    text = render(env, views.TEMPLATES[type(sheet)] + ".tex.j2", views.context(sheet) | names)
    return without_gaps(text)


def without_gaps(text: str) -> str:
    """One empty line at most between two others."""
    return re.sub(r"\n{3,}", "\n\n", text)


@lru_cache(maxsize=32)
def environment_of(folders: tuple[Path, ...], lang: str) -> Environment:
    filters: dict[str, Callable[..., str]] = {
        "markup": lambda text: to_latex_markup(text, lang),
        "inline": lambda text: re.sub(r"\n\n+", r" \\newline ", to_latex_markup(text, lang)),
        "math": lambda tex: f"${to_latex(tex, lang)}$",
        "display": lambda tex: f"\\[\n{to_latex(tex, lang)}\n\\]",
        "comment": lambda text: re.sub(r"\s+", " ", str(text)),
        "width": _width,
    }
    return environment(folders, lang, latex_text, filters, MARKS)


def _width(figure: Figure | Picture, room: float, tall: float) -> str:
    """Return the width of a figure in mm: its own, for which it is laid out, or less where the room does not
    do."""
    wide, high = figure.size_mm
    return f"{wide * min(1.0, room / wide, tall / high):.1f}"


def to_latex_markup(markdown: str, lang: str) -> str:
    """Markdown as LaTeX."""
    return _latex(markup.tree(markdown), lang).strip()


def _latex(node: SyntaxTreeNode, lang: str) -> str:
    def inside() -> str:
        return "".join(_latex(child, lang) for child in node.children)

    def items(environment: str) -> str:
        lines = "".join(f"\\item {_latex(item, lang).strip()}\n" for item in node.children)
        return f"\\begin{{{environment}}}\n{lines}\\end{{{environment}}}\n\n"

    match node.type:
        case "root" | "inline" | "list_item":
            return inside()
        case "paragraph":
            return inside() + "\n\n"
        case "text":
            return latex_text(node.content, lang)
        case "softbreak":
            return "\n"
        case "hardbreak":
            return "\\newline\n"
        case "em" | "strong":
            return rf"\{'emph' if node.type == 'em' else 'textbf'}{{{inside()}}}"
        case "code_inline":
            return rf"\texttt{{{plain_latex(node.content)}}}"
        case "fence" | "code_block":
            lines = (plain_latex(line).replace(" ", "~") for line in node.content.rstrip().split("\n"))
            return "\\begin{flushleft}\\ttfamily\n" + " \\newline\n".join(lines) + "\n\\end{flushleft}\n\n"
        case "math_inline":
            return f"${to_latex(node.content.strip(), lang)}$"
        case "math_inline_double" | "math_block" | "math_block_label":
            return f"\\[\n{to_latex(node.content.strip(), lang)}\n\\]\n"
        case "bullet_list":
            return items("itemize")
        case "ordered_list":
            return items("enumerate")
        case "blockquote":
            return f"\\begin{{quote}}\n{inside().strip()}\n\\end{{quote}}\n\n"
        case "heading":
            return f"\\subsubsection*{{{inside()}}}\n\n"
        case "hr":
            return "\\noindent\\rule{\\linewidth}{0.4pt}\n\n"
        case "link":
            return inside()
        case "image":
            raise markup.no_image(str(node.attrs.get("src", "")))
        case "table":
            return _table(node, lang)
    raise BadStatement(f"the text holds a {node.type}, which a sheet cannot print")


def _table(node: SyntaxTreeNode, lang: str) -> str:
    rows = [row.children for part in node.children for row in part.children]
    sides = "".join(str(c.attrs.get("style", "")).removeprefix("text-align:")[:1] or "l" for c in rows[0])
    cells = [["".join(_latex(c, lang) for c in cell.children) for cell in row] for row in rows]
    head, *body = (" & ".join(row) + r" \\" for row in cells)
    lines = "\n".join(["\\toprule", head, "\\midrule", *body, "\\bottomrule"])
    return f"\\begin{{center}}\n\\begin{{tabular}}{{{sides}}}\n{lines}\n\\end{{tabular}}\n\\end{{center}}\n\n"
