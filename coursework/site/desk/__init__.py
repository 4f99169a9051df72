"""Instructor's pages: queue, class, questions, students, files, and regrading."""
