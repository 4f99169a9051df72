"""Common layers of all pages: middleware, permissions, forms, cookies, limits, and caches."""
