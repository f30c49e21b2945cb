"""Published results computed again: each paper in a room of its own."""
