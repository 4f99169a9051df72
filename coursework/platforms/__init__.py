"""Into the platforms: what an instructor imports into Moodle and its like, and what is lost on the way."""
