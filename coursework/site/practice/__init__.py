"""Practice: the course in its order, a variant of one's own, progress."""
