"""Quantities as a graph of functions: evaluated, rounded, replaced."""
