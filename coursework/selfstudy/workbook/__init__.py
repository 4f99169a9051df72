"""Workbook: lessons with executed cells, and a whole course as one book, as pages and as notebooks."""
