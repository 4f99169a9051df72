"""The formats that a build writes."""

FORMATS = ("pdf", "ipynb", "html", "tex", "nbgrader")
