"""The code that drew the samples: one module a picture, each with `draw() -> RGBA (h, w, 4)`."""
