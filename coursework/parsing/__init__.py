"""From a text to a value: spelling, units, expressions, equations, choices."""
