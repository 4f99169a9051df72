"""People of the site: accounts, invitations, and personal data."""
