"""How a class did: measured from its marks, and told on a page."""
