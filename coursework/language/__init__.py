"""Words and numbers in the languages that are spoken."""
