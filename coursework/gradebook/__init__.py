"""Marking a class: submissions read, placed, marked, regraded and written as tables and feedback."""
