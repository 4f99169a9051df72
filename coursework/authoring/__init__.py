"""Tools for authors of exercises: a working skeleton, and the proof that an exercise keeps its promises."""
