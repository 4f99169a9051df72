"""Pieces of arrays, processes, tables, and files that appear whole or not at all."""
