"""Preview of an exercise while its author edits it."""
