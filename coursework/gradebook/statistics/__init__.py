"""Statistics of a class from its marks, and their report."""
