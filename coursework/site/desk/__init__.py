"""Instructor's pages: the queue, the class, questions, students, files, marking again."""
