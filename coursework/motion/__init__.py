"""What moves: scenes over a cycle or in time, and animations."""
