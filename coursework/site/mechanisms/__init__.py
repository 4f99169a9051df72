"""Mechanisms' files, written and drawn on the site."""
