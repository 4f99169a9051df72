"""The instructors' desk: the queue, the class, questions, students, files, marking again."""
