"""Links of learning platforms that lead to the site."""
