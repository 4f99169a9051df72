"""Self-study in a notebook: predictions, instant feedback, hints in steps, plots, fresh variants."""
