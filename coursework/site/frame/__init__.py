"""What all pages go through: the door, who comes, forms, cookies, limits, and what is kept at hand."""
