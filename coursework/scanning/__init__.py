"""Paper that is read back: pictures of answer pages, their codes, what is ticked and written in their
boxes."""
