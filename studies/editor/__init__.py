"""How fast the editor and the tracer are."""
