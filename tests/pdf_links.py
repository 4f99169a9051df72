"""Links of a PDF: what is printed of the page that each leads to."""

from __future__ import annotations

import ctypes
import re

import pypdfium2
import pypdfium2.raw as raw


def wrong_references(pdf: bytes) -> tuple[list[tuple[int, str, int]], int]:
    """The links whose printed page number is not that of the page they lead to, and how many print one.

    Returns
    -------
    wrong
        For each its page, what is printed, and the page that it leads to, counted from 1.
    count
        How many links print a number.
    """
    document = pypdfium2.PdfDocument(pdf)
    wrong, count = [], 0
    for number, page in enumerate(document, 1):
        text, place, link = page.get_textpage(), ctypes.c_int(0), raw.FPDF_LINK()
        while raw.FPDFLink_Enumerate(page.raw, place, link):
            box = raw.FS_RECTF()
            raw.FPDFLink_GetAnnotRect(link, box)
            said = text.get_text_bounded(box.left, box.bottom, box.right, box.top)
            leads_to = 1 + raw.FPDFDest_GetDestPageIndex(
                document.raw, raw.FPDFLink_GetDest(document.raw, link)
            )
            # A link of two lines has a box round both, in which others may stand.
            told = re.findall(r"p\.\s(\d+)", said) or re.findall(r"^\s*(\d+)\s*$", said)
            count += bool(told)
            if told and str(leads_to) not in told:
                wrong.append((number, said, leads_to))
    return wrong, count
