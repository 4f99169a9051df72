"""Tree of formulas and texts, and its printers: Typst, MathML, LaTeX, spoken, plain."""
