"""What an author of exercises needs: a working skeleton, and the proof that an exercise keeps its promises."""
