"""One place for what is issued, what comes back, and what it was marked: a database, from one file on a disk to PostgreSQL."""
