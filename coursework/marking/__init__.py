"""From a reading to a mark."""
