"""Practice: the course in order of study, personal variants, and progress."""
