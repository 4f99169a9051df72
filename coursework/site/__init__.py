"""The site: practice for students, a desk for instructors. It adds no judgement of its own."""
