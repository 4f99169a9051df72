"""A service by which learning platforms open exercises and take back their points, by LTI 1.3."""
