"""Assignments as students see them: their own papers, handing in, receipts, feedback."""
