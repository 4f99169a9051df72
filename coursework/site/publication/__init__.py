"""Assignments as the staff hands them out: dealt, published, extended."""
