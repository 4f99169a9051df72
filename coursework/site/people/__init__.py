"""Who comes in: accounts, invitations, the people of a site, and what is kept of them."""
