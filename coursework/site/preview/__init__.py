"""An exercise under work, its page anew at each save."""
