"""Scenes over a cycle or in time, and animations."""
