"""Site: practice for students and instructor's pages. It marks with the rules of the other packages alone."""
