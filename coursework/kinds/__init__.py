"""Kinds of parts, a file each: how an answer is read, how far it is, what is right, how it is printed and
written."""
