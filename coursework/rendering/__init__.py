"""Handouts, worked solutions, feedback and reports as PDF, web page, notebook and text."""
