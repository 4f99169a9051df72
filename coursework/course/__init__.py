"""A course as numbers: its folder, exercises, variants, records, texts and answer keys."""
