"""Lessons: their content, rendered in steps, and the sections that help with an exercise."""
