"""Making a build: who gets what, and every file of it."""
