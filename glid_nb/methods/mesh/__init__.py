"""Methods on a triangle mesh."""
