"""The formats that a build writes, and what is added to them or left out."""

FORMATS = ("pdf", "ipynb", "html", "tex", "nbgrader")
ADDITIONS = {
    "booklet": "all papers in one PDF",
    "attendance": "attendance lists by room to sign, and a list of rooms and seats for the door",
    "scan": "answer pages in the PDFs, which coursework scan reads; print "
    "them at 100 %, not fitted to the page",
    "practice": "notebooks for self-study, which check answers",
    "letter": "US Letter in place of A4",
    "decimal-comma": "tables for a spreadsheet with decimal commas",
    "no-solutions": "no worked solutions for the staff; the key remains",
    "no-polygons": "worked solutions without drawn velocity and acceleration "
    "polygons, in a third to half of the time",
}
