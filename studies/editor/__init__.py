"""The speed of the editor and the tracer."""
