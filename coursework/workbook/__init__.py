"""The workbook: lessons read and run, and a whole course as one book, as pages and as notebooks."""
