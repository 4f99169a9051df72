"""Support for nbgrader: the tree of an assignment, and the marker that runs no cell of a student."""
