"""Database of issued variants, submissions and marks: SQLite in one file, or PostgreSQL."""
